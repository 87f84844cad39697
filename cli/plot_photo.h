/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_PLOT_PHOTO_H
#define ASJ_CLI_PLOT_PHOTO_H

#include <asj/image.h>

#include <cairo.h>

/* The photograph in pale grey, as a surface of its own; every pixel is the mean of `reduction` x `reduction` pixels of the image
 * (fewer at the right and lower border). The caller destroys it; its cairo status says whether it could be made. */
cairo_surface_t *cli_plot_photo(const asj_image *image, int32_t reduction);

#endif
