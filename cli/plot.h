/* SPDX-License-Identifier: BSD-2-Clause */
/* Plots of junctions: dots, with their branches drawn to their true ends, over the photograph or on white. */
#ifndef ASJ_CLI_PLOT_H
#define ASJ_CLI_PLOT_H

#include "plot_format.h"

#include <asj/detect.h>
#include <asj/segments.h>

enum { CLI_PLOT_COLOR_NFA = 0, CLI_PLOT_COLOR_BRANCH = 1, CLI_PLOT_COLOR_EDGE = 2 };

typedef struct cli_plot_style {
    int32_t color;
    int32_t background;
    double scale; /* plot pixels for one image pixel; 0 = automatic */
} cli_plot_style;

/* Writes a plot, of straight edges in place of branches where `segments` is not NULL; the file appears whole or not at all. On
 * failure `message` receives a line that names the cause. */
asj_status cli_plot_write(const char *path, int32_t format, const asj_image *image, const asj_detection *detection,
                          const asj_segment_list *segments, const cli_plot_style *style, char *message, size_t message_size);

#endif
