/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_PLOT_DRAW_H
#define ASJ_CLI_PLOT_DRAW_H

#include "plot.h"

#include <cairo.h>

/* Sizes in units of the plot: pixels of a PNG, points of a PDF. The image is above, a strip with the legend below. */
typedef struct cli_plot_layout {
    double scale;         /* units for one pixel of the image */
    int32_t width;
    int32_t image_height;
    int32_t legend_height; /* 0 = too narrow for a legend */
    double line;          /* width of a branch */
    double font;          /* size of the text */
} cli_plot_layout;

void cli_plot_lay_out(const asj_image *image, double scale, cli_plot_layout *layout);

/* Draws everything. */
void cli_plot_draw(cairo_t *cairo, const cli_plot_layout *layout, const asj_image *image, const asj_detection *detection,
                   const cli_plot_style *style);

#endif
