/* SPDX-License-Identifier: BSD-2-Clause */
/* Lines on standard error, with the name of the program. */
#include "message.h"
#include "platform.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* File names may hold newlines and terminal controls: a message stays one line, and harmless. Controls are single bytes, and in
 * UTF-8 the pairs C2 80 to C2 9F. */
static char harmless(char before, char c, char after)
{
    const unsigned char b = (unsigned char)before, here = (unsigned char)c, a = (unsigned char)after;
    const int pair = (here == 0xc2 && a >= 0x80 && a <= 0x9f) || (b == 0xc2 && here >= 0x80 && here <= 0x9f);
    return here < 0x20 || here == 0x7f || pair ? '?' : c;
}

void cli_make_harmless(char *text)
{
    for (char before = 0, here; *text; text++, before = here) {
        here = *text;
        *text = harmless(before, here, text[1]);
    }
}

/* However long it is: the cause stands at its end. */
static void print_line(const char *prefix, const char *format, va_list arguments)
{
    char room[1024], *line = room;
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(room, sizeof room, format, arguments);
    if (length >= (int)sizeof room && (line = malloc((size_t)length + 1)) != NULL)
        vsnprintf(line, (size_t)length + 1, format, again);
    va_end(again);
    if (!line)
        line = room; /* its beginning */
    cli_make_harmless(line);
    fprintf(stderr, "%s%s\n", prefix, line);
    if (line != room)
        free(line);
}

void cli_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("asj-cli: ", format, arguments);
    va_end(arguments);
}

/* A path as messages have it: an empty one could not be seen. */
static const char *shown(const char *path)
{
    return *path ? path : "''";
}

/* Whether the message begins with the path, which the library has made harmless perhaps, and shortened where it is long. */
static int tells(const char *message, const char *path)
{
    enum { LONG = 80 };
    size_t i = 0;
    while (path[i] && (message[i] == path[i] || message[i] == harmless(i ? path[i - 1] : 0, path[i], path[i + 1])))
        i++;
    return path[i] == 0 || (i >= LONG && strncmp(message + i, "...", 3) == 0);
}

void cli_file_message(const char *path, const char *message, char *text, size_t text_size)
{
    const int told = tells(message, shown(path));
    snprintf(text, text_size, "%s%s%s", told ? "" : shown(path), told ? "" : ": ", message);
}

void cli_file_error(const char *path, const char *message)
{
    if (tells(message, shown(path)))
        cli_error("%s", message);
    else
        cli_error("%s: %s", shown(path), message);
}

void cli_note(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("", format, arguments);
    va_end(arguments);
}

int cli_usage_error(const char *command, const char *format, ...)
{
    char prefix[64];
    va_list arguments;
    snprintf(prefix, sizeof prefix, command ? "asj-cli %s: " : "asj-cli: ", command);
    va_start(arguments, format);
    print_line(prefix, format, arguments);
    va_end(arguments);
    fprintf(stderr, command ? "Try 'asj-cli %s --help'.\n" : "Try 'asj-cli --help'.\n", command);
    return CLI_USAGE;
}

int cli_close_output(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return CLI_SUCCESS;
    const int error = errno;
    if (!cli_output_is_closed())
        cli_error("standard output: %s", error ? strerror(error) : "write error");
    return CLI_FAILED;
}
