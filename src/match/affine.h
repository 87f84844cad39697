/* SPDX-License-Identifier: BSD-2-Clause */
/* Affine frames of L-junctions and the maps between them. */
#ifndef ASJ_SRC_AFFINE_H
#define ASJ_SRC_AFFINE_H

#include <asj/junction.h>

/* A point and two vectors: an L-junction whose branches reach from (x, y) to (x + ax, y + ay) and (x + bx, y + by). */
typedef struct asj_affine_frame {
    double x, y;
    double ax, ay;
    double bx, by;
} asj_affine_frame;

/* A linear map and its inverse. to: [t0 t1; t2 t3], from: its inverse in the same order. */
typedef struct asj_linear {
    double to[4];
    double from[4];
} asj_linear;

/* Twice the signed area of the frame's triangle, px^2. */
double asj_affine_area(const asj_affine_frame *frame);

/* The linear part of the map that takes frame 1 to frame 2, and its inverse: a1 -> a2, b1 -> b2. Returns 0, and writes nothing,
 * when one of the frames is degenerate (area below 1 px^2 or not finite) or the pair mirrors. */
int32_t asj_affine_between(const asj_affine_frame *frame1, const asj_affine_frame *frame2, asj_linear *map);

/* The inverse of a 2x2 matrix; returns 0 when it is singular (|determinant| < 1e-12). */
int32_t asj_affine_invert(const double matrix[4], double inverse[4]);

#endif
