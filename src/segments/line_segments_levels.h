/* SPDX-License-Identifier: BSD-2-Clause */
/* Level lines: what line segments grow on. */
#ifndef ASJ_SRC_LINE_SEGMENTS_LEVELS_H
#define ASJ_SRC_LINE_SEGMENTS_LEVELS_H

#include "core/image.h"

/* Working pixels to one of the image along an axis (von Gioi et al., section 2.1). */
#define ASJ_LEVELS_SCALE 0.8

/* A direction as a unit vector. */
typedef struct asj_unit_vector {
    float x, y;
} asj_unit_vector;

/* The level-line field of the reduced image; sample (x, y) at [y * width + x], between the working pixels x, x + 1 and y, y + 1.
 * All arrays belong to it. */
typedef struct asj_levels {
    int32_t width, height;
    asj_unit_vector *direction; /* of the level line, the dark side on its right */
    float *norm;              /* of the gradient, grey levels per working pixel; 0 where the level line is not defined */
    int32_t *order;           /* samples whose level line is defined, steepest first */
    int32_t order_count;
} asj_levels;

/* Fills *levels from frame->gray; an image too small for a gradient gives a field without samples. stage:
 * what the caller is told that it is a part of. On failure nothing is held. */
asj_status asj_levels_create(asj_context *context, const asj_frame *frame, int32_t stage, asj_levels *levels);
void asj_levels_free(asj_memory *memory, asj_levels *levels);

/* The place in the image of sample coordinate `value` along an axis: px, pixel centres at whole numbers. */
double asj_levels_place(double value);

#endif
