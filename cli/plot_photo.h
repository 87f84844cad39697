/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_PLOT_PHOTO_H
#define ASJ_CLI_PLOT_PHOTO_H

#include <asj/image.h>

#include <cairo.h>

/* The largest side of a picture in units of the plot, and in pixels of a photograph in it: cairo draws up to 32767. */
#define CLI_PLOT_LARGEST_SIDE 32000

/* How many units of the plot one pixel of an image gets when nothing else is asked for: small images are enlarged, by a whole
 * number so that pixels stay square, and images too large for a plot reduced. */
double cli_plot_natural_scale(int32_t width, int32_t height);

/* Draws the pale photograph, in grey or in its colours (background: CLI_PLOT_PHOTO, CLI_PLOT_PHOTO_COLOR), into the rectangle from
 * (0, 0) to (width, height), `scale` units for a pixel. */
void cli_plot_photo(cairo_t *cairo, const asj_image *image, int32_t background, double scale, int32_t width, int32_t height);

#endif
