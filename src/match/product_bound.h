/* SPDX-License-Identifier: BSD-2-Clause */
/* Upper bounds of the products of patches, from a short vector for each: they tell which pairs are worth comparing. */
#ifndef ASJ_SRC_PRODUCT_BOUND_H
#define ASJ_SRC_PRODUCT_BOUND_H

#include "features.h"

#define ASJ_BOUND_LENGTH 32 /* numbers in a bound vector: 30 coefficients, the norm of the rest, the slack */
#define ASJ_BOUND_LANES 16  /* vectors on the right lie together: number 2 k and 2 k + 1 of all of them, then the next two */

/* Of all frames of an image: normalised raw patches only. Vectors on the left follow each other; on the right there are
 * asj_bound_blocks() blocks, the last one filled up with zeros. Release them. */
asj_status asj_bound_left(asj_context *context, const asj_match_options *options, const asj_image_features *features,
                          int16_t **vectors);
asj_status asj_bound_right(asj_context *context, const asj_match_options *options, const asj_image_features *features,
                           int16_t **vectors);
int32_t asj_bound_blocks(uint32_t frames);

/* No bound is below it; thresholds lie within it and as much above zero. */
#define ASJ_BOUND_LEAST (-0x40000000)

/* Those of `right` from first to end - 1 whose patch's product with that of `left` may be above the smaller of most and of its
 * number in `least`: writes which, in order, and returns how many. `least` has a number for each vector of whole blocks. `among`:
 * only those that asj_bound_add() has put there, with the same first one; a number for each block, from that of first on. NULL =
 * all. */
int32_t asj_bound_above(const int16_t *left, const int16_t *right, const int32_t *least, int32_t most, int32_t first, int32_t end,
                        const uint32_t *among, int32_t *which);

/* Vectors from .. end - 1. Each has two bits in the number of its block, of which the lower one counts. */
static inline void asj_bound_add(uint32_t *among, int32_t first, int32_t from, int32_t end)
{
    for (int32_t stop; from < end; from = stop) {
        const int32_t block = from / ASJ_BOUND_LANES, next = (block + 1) * ASJ_BOUND_LANES;
        stop = end < next ? end : next;
        among[block - first / ASJ_BOUND_LANES] |= (uint32_t)0x55555555 >> 2 * (ASJ_BOUND_LANES - (stop - from))
                                                                      << from % ASJ_BOUND_LANES * 2;
    }
}

static inline int asj_bound_is_among(const uint32_t *among, int32_t first, int32_t which)
{
    return among[which / ASJ_BOUND_LANES - first / ASJ_BOUND_LANES] >> which % ASJ_BOUND_LANES * 2 & 1;
}

/* Operations (core/ops.h). */
typedef struct asj_bound_ops {
    /* asj_bound_above() */
    int32_t (*above)(const int16_t *left, const int16_t *right, const int32_t *least, int32_t most, int32_t first, int32_t end,
                     const uint32_t *among, int32_t *which);
} asj_bound_ops;
extern const asj_bound_ops asj_bound_reference;

#endif
