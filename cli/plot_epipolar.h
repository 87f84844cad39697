/* SPDX-License-Identifier: BSD-2-Clause */
/* Epipolar lines of matches. */
#ifndef ASJ_CLI_PLOT_EPIPOLAR_H
#define ASJ_CLI_PLOT_EPIPOLAR_H

#include <asj/geometry.h>

/* The epipolar line in image `v` (0 or 1) of a point (x, y) of the other image, cut off at the edges of an image of this size;
 * pixel centres are at integers. ends: x y x y. 0 when the line does not meet the image. */
int cli_epipolar_line(const asj_geometry *geometry, int v, double x, double y, double width, double height, double ends[4]);

#endif
