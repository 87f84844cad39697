/* SPDX-License-Identifier: BSD-2-Clause */
/* Epipolar lines of matches. */
#ifndef ASJ_CLI_PLOT_EPIPOLAR_H
#define ASJ_CLI_PLOT_EPIPOLAR_H

#include <asj/geometry.h>

#include <stddef.h>

/* The epipolar line in image `v` (0 or 1) of a point (x, y) of the other image, cut off at the edges of an image of this size;
 * pixel centres are at integers. ends: x y x y. 0 when the line does not meet the image. */
int cli_epipolar_line(const asj_geometry *geometry, int v, double x, double y, double width, double height, double ends[4]);

/* The lines of a match in both images, as ends. */
typedef struct cli_epipolar_pair {
    double ends[2][4];
    double distance; /* from the nearest one that is chosen; negative when it is chosen itself */
    size_t match;    /* the caller's */
} cli_epipolar_pair;

/* Chooses `most` pairs that lie far from each other, or all when there are no more: the first one, and then always the one that is
 * farthest from those chosen, of equally far ones the first. */
void cli_epipolar_spread(cli_epipolar_pair *pairs, size_t count, size_t most);

#endif
