/* SPDX-License-Identifier: BSD-2-Clause */
/* In place of plot.c and plot_match.c where there is no cairo. */
#include "plot.h"
#include "plot_match.h"

#include <stdio.h>

static asj_status refuse(char *message, size_t message_size)
{
    snprintf(message, message_size, "this build cannot plot (it was made without cairo)");
    return ASJ_ERROR_UNSUPPORTED;
}

asj_status cli_plot_write(const char *path, int32_t format, const cli_plot_scene *scene, const cli_plot_style *style,
                          char *message, size_t message_size)
{
    (void)path;
    (void)format;
    (void)scene;
    (void)style;
    return refuse(message, message_size);
}

asj_status cli_plot_match(const char *path, int32_t format, const cli_plot_match_content *content,
                          const cli_plot_match_style *style, char *message, size_t message_size)
{
    (void)path;
    (void)format;
    (void)content;
    (void)style;
    return refuse(message, message_size);
}
