/* SPDX-License-Identifier: BSD-2-Clause */
#include "image_list.h"
#include "message.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cli_image_list_free(cli_image_list *list)
{
    free(list->names);
    free(list->text);
    memset(list, 0, sizeof *list);
}

static int out_of_memory(void)
{
    cli_error("out of memory");
    return CLI_FAILED;
}

/* What never ends is no list: a name is shorter than PART bytes, and millions of names are shorter than LONGEST. */
enum { PART = 65536, LONGEST = 1 << 30 };

static int is_end(char c)
{
    return c == '\0' || c == '\n';
}

/* Does a name end here? */
static int ends_name(const char *text, size_t size)
{
    for (size_t i = 1; i < size; i++)
        if (is_end(text[i]) && !is_end(text[i - 1]))
            return 1;
    return 0;
}

/* The whole stream with a zero after it. */
static int read_all(FILE *stream, const char *name, char **text, size_t *size)
{
    size_t room = 0;
    *size = 0;
    do {
        if (room - *size <= PART) {
            char *more = realloc(*text, room = room ? 2 * room : 2 * (size_t)PART);
            if (!more)
                return out_of_memory();
            *text = more;
        }
        const size_t count = fread(*text + *size, 1, PART, stream);
        if (count == PART && !ends_name(*text + *size, count)) {
            cli_error("%s: not a list of names: %d bytes without one", name, PART);
            return CLI_FAILED;
        }
        *size += count;
        if (*size > LONGEST) {
            cli_error("%s: a list of more than %d MiB", name, LONGEST >> 20);
            return CLI_FAILED;
        }
    } while (!feof(stream) && !ferror(stream));
    (*text)[*size] = '\0';
    if (!ferror(stream))
        return CLI_SUCCESS;
    cli_error("%s: %s", name, strerror(errno));
    return CLI_FAILED;
}

static int read_file(const char *file, char **text, size_t *size)
{
    if (strcmp(file, "-") == 0)
        return read_all(stdin, "standard input", text, size);
    FILE *stream = fopen(file, "rb");
    if (!stream) {
        cli_file_error(file, strerror(errno));
        return CLI_FAILED;
    }
    const int result = read_all(stream, file, text, size);
    fclose(stream);
    return result;
}

/* Ends each name with a zero, and returns how many there are. */
static size_t cut(char *text, size_t size)
{
    const int zeros = memchr(text, '\0', size) != NULL;
    size_t names = 0;
    for (size_t i = 0; i < size && !zeros; i++)
        if (text[i] == '\n') {
            text[i] = '\0';
            if (i > 0 && text[i - 1] == '\r')
                text[i - 1] = '\0';
        }
    for (size_t i = 0; i < size; i++)
        names += text[i] != '\0' && text[i + 1] == '\0';
    return names;
}

/* Where the first name begins: behind the byte order mark that editors on Windows put before text. */
static size_t find_first(const char *text, size_t size)
{
    static const char mark[] = "\xef\xbb\xbf";
    return size >= sizeof mark - 1 && memcmp(text, mark, sizeof mark - 1) == 0 ? sizeof mark - 1 : 0;
}

int cli_image_list_make(char **given, size_t given_count, const char *file, cli_image_list *list)
{
    size_t size = 0, most = given_count + 1;
    memset(list, 0, sizeof *list);
    if (file) {
        const int result = read_file(file, &list->text, &size);
        if (result != CLI_SUCCESS)
            return result;
        most += cut(list->text, size);
    }
    list->names = calloc(most, sizeof *list->names);
    if (!list->names)
        return out_of_memory();
    for (; list->count < given_count; list->count++)
        list->names[list->count] = given[list->count];
    for (size_t i = find_first(list->text, size); i < size; i += strlen(list->text + i) + 1)
        if (list->text[i] != '\0')
            list->names[list->count++] = list->text + i;
    return CLI_SUCCESS;
}
