/* SPDX-License-Identifier: BSD-2-Clause */
/* Bounds of products in vectors (product_bound.c). Part of kernels.h. */
#ifndef ASJ_SRC_SIMD_PRODUCT_BOUND_KERNELS_H
#define ASJ_SRC_SIMD_PRODUCT_BOUND_KERNELS_H

#include "match/product_bound.h"

#include <string.h>

enum { BOUND_VECTORS = 2 * ASJ_BOUND_LANES / V_LANES }; /* for the bounds of a block */

/* Bit 2 n for lane n of a block: whether its bound is above the smaller of both thresholds. */
static inline uint32_t bound_block(const int16_t *left, const int16_t *right, const int32_t *least, vec most)
{
    vec bound[BOUND_VECTORS];
    uint32_t bits = 0;
    for (int32_t v = 0; v < BOUND_VECTORS; v++)
        bound[v] = v_zero();
    for (int32_t k = 0; k < ASJ_BOUND_LENGTH; k += 2, right += 2 * ASJ_BOUND_LANES) {
        int32_t two;
        memcpy(&two, left + k, sizeof two);
        const vec pair = v_set1_32(two);
        for (int32_t v = 0; v < BOUND_VECTORS; v++)
            bound[v] = v_add32(bound[v], v_pairs(pair, v_load(right + v * V_LANES)));
    }
    for (int32_t v = 0; v < BOUND_VECTORS; v++) {
        const vec above = v_max32(v_sub32(bound[v], v_load(least + v * V_LANES / 2)), v_sub32(bound[v], most));
        bits |= v_bits(v_negative32(v_sub32(v_zero(), above))) << v * V_LANES;
    }
    return bits & 0x55555555;
}

static int32_t bound_above(const int16_t *left, const int16_t *right, const int32_t *least, int32_t most, int32_t first,
                           int32_t end, const uint32_t *among, int32_t *which)
{
    const vec limit = v_set1_32(most);
    int32_t count = 0;
    for (int32_t start = first - first % ASJ_BOUND_LANES, b = 0; start < end; start += ASJ_BOUND_LANES, b++) {
        uint32_t bits = among ? among[b] : 0xffffffff;
        bits &= start < first ? 0xffffffff << 2 * (first - start) : 0xffffffff;
        bits &= end - start < ASJ_BOUND_LANES ? ((uint32_t)1 << 2 * (end - start)) - 1 : 0xffffffff;
        if (bits)
            bits &= bound_block(left, right + (ptrdiff_t)start * ASJ_BOUND_LENGTH, least + start, limit);
        for (; bits; bits &= bits - 1)
            which[count++] = start + __builtin_ctz(bits) / 2;
    }
    return count;
}

#endif
