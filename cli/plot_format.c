/* SPDX-License-Identifier: BSD-2-Clause */
/* Formats of plots by name. */
#include "plot_format.h"
#include "message.h"
#include "parse.h"
#include "platform.h"

#include <string.h>

int cli_plot_available(void)
{
#ifdef CLI_HAVE_CAIRO
    return 1;
#else
    return 0;
#endif
}

int32_t cli_plot_format_of_word(const char *word)
{
    static const char *const formats[] = {"png", "svg", "pdf", NULL}; /* in the order of CLI_PLOT_... */
    char lower[8] = "";
    for (size_t i = 0; i + 1 < sizeof lower && word[i]; i++)
        lower[i] = (char)(word[i] >= 'A' && word[i] <= 'Z' ? word[i] - 'A' + 'a' : word[i]);
    return cli_find_word(formats, lower);
}

int cli_plot_format_of_name(const char *command, const char *name, int32_t *format)
{
    if (!cli_plot_available())
        return cli_usage_error(command, "--plot: this build cannot plot (it was made without cairo)");
    const char *dot = strrchr(name, '.');
    *format = dot && dot != name && !cli_is_separator(dot[-1]) ? cli_plot_format_of_word(dot + 1) : -1;
    if (*format < 0)
        return cli_usage_error(command, "--plot: the name '%s' does not end in .png, .svg or .pdf", name);
    return CLI_SUCCESS;
}

int cli_plot_take_background(const char *command, const char *text, int32_t *background)
{
    static const char *const backgrounds[] = {"photo", "color", "white", NULL}; /* in the order of CLI_PLOT_PHOTO, .. */
    int word = cli_find_word(backgrounds, text);
    if (word < 0)
        return cli_usage_error(command, "--plot-background: '%s' is not photo, color or white", text);
    *background = word;
    return CLI_SUCCESS;
}

int cli_plot_take_scale(const char *command, const char *text, double *scale)
{
    if (!cli_parse_number(text, CLI_PLOT_MIN_SCALE, CLI_PLOT_MAX_SCALE, scale))
        return cli_usage_error(command, "--plot-scale: '%s' is not a number in %g .. %d", text, CLI_PLOT_MIN_SCALE,
                               CLI_PLOT_MAX_SCALE);
    return CLI_SUCCESS;
}

int cli_plot_check_without(const char *command, const char *option)
{
    return option ? cli_usage_error(command, "--%s changes nothing without --plot", option) : CLI_SUCCESS;
}
