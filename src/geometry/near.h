/* SPDX-License-Identifier: BSD-2-Clause */
/* Which candidates are near enough a geometry to speak for it. */
#ifndef ASJ_SRC_GEOMETRY_NEAR_H
#define ASJ_SRC_GEOMETRY_NEAR_H

#include "core/memory.h"
#include "candidates.h"

/* A geometry for coordinates from the images' middles: near is what has e^2 <= factor n^2 + extra (near.c). */
typedef struct asj_near_plan {
    float m[9];
    float factor, extra;
} asj_near_plan;

/* Operations (core/ops.h): indices, rising, of those of `count` candidates that may be near their epipolar lines, or where a
 * homography puts them; how many. at: x1, y1, x2 and y2 of all, which can be read ASJ_NEAR_PADDING numbers beyond the last one. */
#define ASJ_NEAR_PADDING 16
typedef struct asj_near_ops {
    int32_t (*lines)(const asj_near_plan *plan, const float *const at[4], int32_t count, uint32_t *near);
    int32_t (*places)(const asj_near_plan *plan, const float *const at[4], int32_t count, uint32_t *near);
} asj_near_ops;
extern const asj_near_ops asj_near_reference;

/* Fills set->at from the list; 0 without memory. Freed with asj_release(). */
int32_t asj_near_prepare(asj_memory *memory, const asj_near_ops *ops, asj_pairs *set);

/* Indices, rising, of those of the first `count` candidates that are within sqrt(limit) px of their epipolar lines (both images) or
 * of where the homography puts them, and where the geometry has no planes of others that may be; `near` has room for count + 1.
 * Returns how many. */
int32_t asj_near(const asj_pairs *set, int32_t count, const asj_two_view *view, double limit, uint32_t *near);

#endif
