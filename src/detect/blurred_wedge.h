/* SPDX-License-Identifier: BSD-2-Clause */
/* The gradient of a blurred wedge beside that of the pixels: sums for a fit. */
#ifndef ASJ_SRC_BLURRED_WEDGE_H
#define ASJ_SRC_BLURRED_WEDGE_H

#include "core/image.h"

/* Corner, directions of both edges (rad), standard deviation of the blur (px), height of the step. */
enum { ASJ_WEDGE_X, ASJ_WEDGE_Y, ASJ_WEDGE_FIRST, ASJ_WEDGE_SECOND, ASJ_WEDGE_BLUR, ASJ_WEDGE_STEP, ASJ_WEDGE_PARAMETERS };

typedef struct asj_wedge {
    double p[ASJ_WEDGE_PARAMETERS];
} asj_wedge;

/* The pixels that count: a disc around the corner, and along each edge, (ux, uy), a band up to `last` px. */
typedef struct asj_wedge_window {
    double x, y, reach, across;
    double ux[2], uy[2], last[2];
} asj_wedge_window;

/* Over the pixels, each with its weight: products of what the parameters change in the gradient of a step of 1 (lower triangle; of
 * the step it is that gradient itself), products of these and the gradient that is seen, squares of that, and the weights. */
typedef struct asj_wedge_sums {
    double products[ASJ_WEDGE_PARAMETERS][ASJ_WEDGE_PARAMETERS], seen[ASJ_WEDGE_PARAMETERS];
    double total, weight;
} asj_wedge_sums;

/* Operations (core/ops.h). */
typedef struct asj_wedge_ops {
    /* The window is around the corner. */
    void (*add_up)(const asj_frame *frame, const asj_wedge *wedge, const asj_wedge_window *window, asj_wedge_sums *sums);
} asj_wedge_ops;
extern const asj_wedge_ops asj_wedge_reference;

#endif
