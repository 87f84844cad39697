/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_FIVE_POINT_H
#define ASJ_SRC_FIVE_POINT_H

#include <stdint.h>

#define ASJ_FIVE_POINT_SOLUTIONS 10

/* A pair of points in normalised camera coordinates: (x, y, 1) is the ray. */
typedef struct asj_ray_pair {
    double x1, y1, x2, y2;
} asj_ray_pair;

/* The essential matrices with (x2, y2, 1) E (x1, y1, 1)' = 0 for five pairs: see five_point.c. Each has norm sqrt(2). Returns how
 * many; 0 when the points do not determine them. */
int32_t asj_five_point(const asj_ray_pair pairs[5], double essential[ASJ_FIVE_POINT_SOLUTIONS][9]);

#endif
