/* SPDX-License-Identifier: BSD-2-Clause */
/* What a plot shows, pixel by pixel. */
#ifndef ASJ_TEST_PLOT_PIXELS_H
#define ASJ_TEST_PLOT_PIXELS_H

#include <asj/io.h>

/* A plot, which must be RGB; to be freed. */
asj_image_file *read_plot(const char *path);

/* Red, green and blue at x, y, which must lie in the plot. */
const unsigned char *plot_pixel(const asj_image_file *plot, int x, int y);

int is_colored(const unsigned char *color);

#endif
