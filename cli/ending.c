/* SPDX-License-Identifier: BSD-2-Clause */
/* What the ending of a name promises, and what is written. */
#include "ending.h"
#include "message.h"
#include "parse.h"
#include "platform.h"

#include <stdio.h>
#include <string.h>

static void list_formats(const char *const *formats, char *text, size_t size)
{
    size_t used = 0;
    *text = '\0';
    for (size_t i = 0; formats[i] && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", i == 0 ? "" : formats[i + 1] ? ", " : " or ", formats[i]);
}

/* What follows the last dot of a name, in small letters; "" where nothing does. */
static void ending_of(const char *name, char *ending, size_t size)
{
    const char *base = name ? cli_base_name(name) : "";
    const char *dot = strrchr(base, '.');
    size_t i = 0;
    for (; dot && dot != base && i + 1 < size && dot[1 + i]; i++)
        ending[i] = (char)(dot[1 + i] >= 'A' && dot[1 + i] <= 'Z' ? dot[1 + i] - 'A' + 'a' : dot[1 + i]);
    ending[i] = '\0';
}

const char *cli_format_of_name(const char *name, const char *const *formats)
{
    char ending[8];
    ending_of(name, ending, sizeof ending);
    const int word = cli_find_word(formats, ending);
    return word >= 0 ? formats[word] : NULL;
}

int cli_check_ending(const char *command, const char *what, const char *name, const char *format, const char *const *formats)
{
    char ending[8], list[64];
    ending_of(name, ending, sizeof ending);
    if (format || !*ending || strcmp(name, "-") == 0 || cli_is_special(name))
        return CLI_SUCCESS;
    if (strcmp(ending, "txt") == 0 || cli_find_word(formats, ending) >= 0)
        return CLI_SUCCESS;
    list_formats(formats, list, sizeof list);
    return cli_usage_error(command, "--output: %s: %s are written as %s (a picture: --plot)", name, what, list);
}

void cli_warn_ending(const char *command, const char *name, const char *format, const char *written)
{
    static const char *const known[] = {"asj", "json", "jsonl", "csv", "asjf", "png", "svg", "pdf", "jpg", "jpeg", NULL};
    char ending[8];
    ending_of(name, ending, sizeof ending);
    if (!*ending || cli_is_special(name) || strcmp(ending, written) == 0)
        return;
    if (cli_find_word(known, ending) >= 0)
        cli_note("asj-cli %s: warning: %s is written as %s, whatever its name ends in", command, name, written);
    else if (!format && strcmp(ending, "txt") == 0)
        cli_note("asj-cli %s: warning: %s is written as %s: --format asks for others", command, name, written);
}
