/* SPDX-License-Identifier: BSD-2-Clause */
/* The normal form of patches in vectors of 128 bits: asj_patch_normalise() of patch.c. For instruction sets that multiply two pairs
 * of 32-bit numbers at once: without, plain C is faster. */
#ifndef ASJ_SRC_SIMD_NORMAL_KERNELS_H
#define ASJ_SRC_SIMD_NORMAL_KERNELS_H

#include "line_kernels.h"
#include "match/patch.h"

typedef uint64_t unsigned_longs __attribute__((vector_size(16)));

/* Four levels, as N g - s, times the scale: the high halves of numbers of 64 bits, rounded. BIAS is more than any level is below
 * zero; what it adds is in `rounded`. */
#define BIAS (1 << 26)
static inline ints high_halves(ints d, vec scale, unsigned_longs rounded)
{
    const unsigned_longs biased = (unsigned_longs)(d + BIAS);
    const unsigned_longs lower = (unsigned_longs)v_products32((vec)biased, scale) + rounded;
    const unsigned_longs higher = (unsigned_longs)v_products32((vec)(biased >> 32), scale) + rounded;
    return (ints)(lower >> 32 | (higher & ~(uint64_t)UINT32_MAX));
}

static void patch_normalise(const uint16_t *grey, int32_t size, int16_t *unit)
{
    const int32_t samples = size * size; /* below 2^15 */
    const vec zero = v_zero(), count = v_set1((int16_t)samples);
    unsigned_longs squares = {0, 0};
    vec sums = zero;
    for (int32_t i = 0; i < samples; i += 8) {
        const vec g = v_load(grey + i);
        const unsigned_longs square = (unsigned_longs)v_pairs(g, g); /* two of them, below 2^31 */
        sums = v_add32(sums, v_pairs(g, v_set1(1)));
        squares += (square >> 32) + (square & UINT32_MAX);
    }
    const int32_t sum = v_sum32(sums);
    const uint64_t scale = (uint64_t)asj_patch_unit_scale(sum, (int64_t)(squares[0] + squares[1]), size);
    const uint64_t added = ((uint64_t)1 << 31) - scale * BIAS;
    const unsigned_longs rounded = {added, added};
    const vec scales = (vec)(unsigned_longs){scale, scale};
    for (int32_t i = 0; i < samples; i += 8) {
        const vec g = v_load(grey + i);
        const ints low = (ints)v_pairs(v_interleave_low(g, zero), count) - sum;
        const ints high = (ints)v_pairs(v_interleave_high(g, zero), count) - sum;
        v_store(unit + i, v_pack_low((vec)high_halves(low, scales, rounded), (vec)high_halves(high, scales, rounded)));
    }
}

static void fill_normal(const asj_ops *ops)
{
    ops->patch->normalise = patch_normalise;
}

#endif
