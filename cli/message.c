/* SPDX-License-Identifier: BSD-2-Clause */
/* Lines on standard error, with the name of the program. */
#include "message.h"
#include "platform.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* File names may hold newlines and terminal controls: a message stays one line, and harmless. */
static char harmless(char c)
{
    return (unsigned char)c < 0x20 || c == 0x7f ? '?' : c;
}

static void print_line(const char *prefix, const char *format, va_list arguments)
{
    char line[4096];
    vsnprintf(line, sizeof line, format, arguments);
    for (char *c = line; *c; c++)
        *c = harmless(*c);
    fprintf(stderr, "%s%s\n", prefix, line);
}

void cli_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_line("asj-cli: ", format, arguments);
    va_end(arguments);
}

/* Whether the message begins with the path, which the library has made harmless perhaps. */
static int tells(const char *message, const char *path)
{
    for (; *path && (*message == *path || *message == harmless(*path)); path++)
        message++;
    return *path == 0;
}

void cli_file_error(const char *path, const char *message)
{
    if (tells(message, path))
        cli_error("%s", message);
    else
        cli_error("%s: %s", path, message);
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
