/* SPDX-License-Identifier: BSD-2-Clause */
/* Products of patches in vectors (match/patch.c). Part of kernels.h. */
#ifndef ASJ_SRC_SIMD_PRODUCT_KERNELS_H
#define ASJ_SRC_SIMD_PRODUCT_KERNELS_H

#include "match/patch.h"

#include <string.h>

/* The first 16 numbers; zeros where a vector has more lanes. */
static inline vec load_16(const int16_t *from)
{
    int16_t lanes[V_LANES > 16 ? V_LANES : 16] = {0};
    memcpy(lanes, from, 16 * sizeof *from);
    return v_load(lanes);
}

/* Four patches on the right at once; lengths are multiples of 16. Sums of whole numbers that fit: any order gives the same. */
static void patch_products(const int16_t *left, const int16_t *rights, int32_t length, const int32_t *which, int32_t count,
                           int32_t *products)
{
    const int32_t whole = length / V_LANES * V_LANES;
    for (int32_t k = 0; k < count; k += 4) {
        const int32_t last = count - k < 4 ? count - k - 1 : 3;
        const int16_t *r[4];
        vec sum[4] = {v_zero(), v_zero(), v_zero(), v_zero()};
        for (int32_t n = 0; n < 4; n++)
            r[n] = rights + (ptrdiff_t)which[k + (n < last ? n : last)] * length;
        for (int32_t i = 0; i < whole; i += V_LANES) {
            const vec l = v_load(left + i);
            for (int32_t n = 0; n < 4; n++)
                sum[n] = v_add32(sum[n], v_pairs(l, v_load(r[n] + i)));
        }
        for (int32_t n = 0; n < 4 && whole < length; n++)
            sum[n] = v_add32(sum[n], v_pairs(load_16(left + whole), load_16(r[n] + whole)));
        for (int32_t n = 0; n <= last; n++)
            products[k + n] = v_sum32(sum[n]);
    }
}

#endif
