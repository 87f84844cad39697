/* SPDX-License-Identifier: BSD-2-Clause */
/* Plots of junctions: dots, with their branches drawn to their true ends, over the photograph or on white. */
#ifndef ASJ_CLI_PLOT_H
#define ASJ_CLI_PLOT_H

#include "plot_format.h"

#include <asj/detect.h>
#include <asj/segments.h>
#include <asj/vanishing.h>

enum { CLI_PLOT_COLOR_NFA = 0, CLI_PLOT_COLOR_BRANCH = 1, CLI_PLOT_COLOR_EDGE = 2, CLI_PLOT_COLOR_DIRECTION = 3 };

typedef struct cli_plot_style {
    int32_t color;
    int32_t background;
    double scale; /* plot pixels for one image pixel; 0 = automatic */
} cli_plot_style;

/* What it shows. */
typedef struct cli_plot_scene {
    const asj_image *image;
    const asj_detection *detection;
    const asj_segment_list *segments;        /* straight edges in place of branches; NULL = branches */
    const asj_vanishing_points *directions;  /* for CLI_PLOT_COLOR_DIRECTION */
} cli_plot_scene;

/* The file appears whole or not at all. On failure `message` receives a line that names the cause. */
asj_status cli_plot_write(const char *path, int32_t format, const cli_plot_scene *scene, const cli_plot_style *style,
                          char *message, size_t message_size);

#endif
