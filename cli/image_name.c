/* SPDX-License-Identifier: BSD-2-Clause */
/* Looks at the first lines of asj-formats(5) JSON for the name; files that look otherwise do not tell. */
#include "image_name.h"
#include "platform.h"

#include <stdio.h>
#include <string.h>

enum { HEAD = 16384 /* bytes of the file, within which a name of a few thousand ends */ };

/* A JSON string up to its quote, where nothing but quotes and backslashes is escaped. */
static int unquote(const char *text, char *name, size_t size)
{
    size_t n = 0;
    for (; *text != '"' && n + 1 < size; text++) {
        const int escaped = *text == '\\';
        text += escaped;
        if (*text == '\0' || (escaped && *text != '"' && *text != '\\'))
            return 0;
        name[n++] = *text;
    }
    name[n] = '\0';
    return *text == '"';
}

int cli_image_name_read(const char *path, char *name, size_t size)
{
    static const char start[] = "\n\"image\": {\"name\": \"";
    char head[HEAD + 1] = "";
    FILE *file = cli_is_special(path) ? NULL : fopen(path, "rb");
    if (!file)
        return 0;
    head[fread(head, 1, HEAD, file)] = '\0';
    fclose(file);
    const char *found = strstr(head, start);
    return found && unquote(found + sizeof start - 1, name, size);
}

int cli_image_name_is_of(const char *name, const char *other, const char *own)
{
    const char *base = cli_base_name(name);
    cli_identity one, two;
    if (cli_identify(own, &one) && cli_identify(other, &two) && one.device == two.device && one.number == two.number)
        return 0;
    if (strcmp(name, own) == 0 || strcmp(name, other) == 0)
        return strcmp(name, own) != 0;
    return strcmp(base, cli_base_name(other)) == 0 && strcmp(base, cli_base_name(own)) != 0;
}
