/* SPDX-License-Identifier: BSD-2-Clause */
/* Plots of matches: both photographs, and what matches joined by lines. */
#ifndef ASJ_CLI_PLOT_MATCH_H
#define ASJ_CLI_PLOT_MATCH_H

#include "plot_format.h"

#include <asj/image.h>
#include <asj/match.h>

enum { CLI_LAYOUT_AUTO = 0, CLI_LAYOUT_BESIDE = 1, CLI_LAYOUT_BELOW = 2 };

typedef struct cli_plot_match_style {
    int32_t background; /* CLI_PLOT_PHOTO, .. */
    int32_t without_lines;
    int32_t epipolar;   /* epipolar lines, where there are any */
    int32_t layout;
    double scale;       /* plot pixels for one image pixel; 0 = automatic */
} cli_plot_match_style;

typedef struct cli_plot_match_content {
    const asj_image *images[2];
    const asj_match_result *result;
    const asj_segment_match *segments; /* drawn instead of the junctions when not NULL */
    size_t segment_count;
} cli_plot_match_content;

/* Writes a plot; the file appears whole or not at all. On failure `message` receives a line that names the cause. */
asj_status cli_plot_match(const char *path, int32_t format, const cli_plot_match_content *content,
                          const cli_plot_match_style *style, char *message, size_t message_size);

#endif
