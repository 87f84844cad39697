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

int cli_check_ending(const char *command, const char *what, const char *name, const char *format, const char *const *formats)
{
    const char *base = name ? cli_base_name(name) : NULL;
    const char *dot = base ? strrchr(base, '.') : NULL;
    char ending[8] = "", list[64];
    if (format || !dot || dot == base || strcmp(name, "-") == 0 || cli_is_special(name))
        return CLI_SUCCESS;
    for (size_t i = 0; i + 1 < sizeof ending && dot[1 + i]; i++)
        ending[i] = (char)(dot[1 + i] >= 'A' && dot[1 + i] <= 'Z' ? dot[1 + i] - 'A' + 'a' : dot[1 + i]);
    if (strcmp(ending, "txt") == 0 || cli_find_word(formats, ending) >= 0)
        return CLI_SUCCESS;
    list_formats(formats, list, sizeof list);
    return cli_usage_error(command, "--output: %s: %s are written as %s (a picture: --plot)", name, what, list);
}
