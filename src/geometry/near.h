/* SPDX-License-Identifier: BSD-2-Clause */
/* Which candidates are near enough a geometry to speak for it. */
#ifndef ASJ_SRC_GEOMETRY_NEAR_H
#define ASJ_SRC_GEOMETRY_NEAR_H

#include "core/memory.h"
#include "candidates.h"

/* Fills set->at from the list; 0 without memory. Freed with asj_release(). */
int32_t asj_near_prepare(asj_memory *memory, asj_pairs *set);

/* Indices, rising, of those of the first `count` candidates that are within sqrt(limit) px of their epipolar lines (both images) or
 * of where the homography puts them, and where the geometry has no planes of others that may be; `near` has room for count + 1.
 * Returns how many. */
int32_t asj_near(const asj_pairs *set, int32_t count, const asj_two_view *view, double limit, uint32_t *near);

#endif
