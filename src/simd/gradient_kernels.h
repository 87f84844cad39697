/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 1 in vectors. Part of kernels.h. Numbers of 32 bits come in pairs of vectors: the lower and the higher lanes of each 128
 * bits, as v_interleave_ leaves them; v_pack_ puts them back into one vector of 16 bits. */
#ifndef ASJ_SRC_SIMD_GRADIENT_KERNELS_H
#define ASJ_SRC_SIMD_GRADIENT_KERNELS_H

#include "detect/gradient.h"

/* Floor of the square root, for 0 <= s < 2^31 - 2^22: the sum in single precision is above the true root by less than 1/64. */
static inline vec root32(vec s)
{
    const vec root = v_root(s, 1.0f / 128);
    return v_add32(root, v_negative32(v_sub32(s, v_low32(root, root)))); /* less 1 where too large */
}

/* floor(a / b) for whole numbers that floats hold, a quotient below 2^23, and a + b < 2^31. Rounding never takes a quotient below
 * a whole number, so it is the floor or 1 more. */
static inline vec quotient32(float a, vec whole_a, vec b)
{
    const vec q = v_quotient(a, b);
    return v_add32(q, v_negative32(v_sub32(whole_a, v_low32(q, b))));
}

static void gradient_slide(const asj_gradient_row *row, uint16_t *norms, uint16_t *low, uint16_t *high)
{
    const vec byte = v_set1(255);
    for (int32_t x = 0; x < row->width; x += V_LANES) {
        const vec dx = v_sub(v_load(row->gray + x + 1), v_load(row->gray + x - 1));
        const vec dy = v_sub(v_load(row->below + x), v_load(row->above + x));
        const vec a = v_interleave_low(dx, dy), b = v_interleave_high(dx, dy);
        const vec come = v_pack_low(root32(v_pairs(a, a)), root32(v_pairs(b, b))), leave = v_load(norms + x);
        v_store(norms + x, come);
        v_store(low + x, v_add(v_load(low + x), v_sub(v_and(come, byte), v_and(leave, byte))));
        v_store(high + x, v_add(v_load(high + x), v_sub(v_shift_right_8(come), v_shift_right_8(leave))));
    }
    low[row->width] = low[row->width + 1] = high[row->width] = high[row->width + 1] = 0;
}

/* (d scale + 32768) >> 16 of 16-bit numbers d; scale in two halves. The lower one is multiplied as a signed number. */
static inline vec scaled(vec d, vec scale_low, vec scale_high)
{
    const vec whole = v_add(v_low(d, scale_high), v_and(d, v_greater(v_zero(), scale_low)));
    return v_add(v_add(whole, v_high(d, scale_low)), v_shift_right_15(v_low(d, scale_low)));
}

/* The sum of five neighbours. */
static inline vec sum5(const uint16_t *p)
{
    return v_add(v_add(v_add(v_load(p - 2), v_load(p - 1)), v_add(v_load(p + 1), v_load(p + 2))), v_load(p));
}

static void gradient_normalise(const asj_gradient_row *row, const uint16_t *norms, const uint16_t *low, const uint16_t *high,
                               int16_t *gx, int16_t *gy)
{
    const asj_gradient_factors factors = asj_gradient_set_factors(5, row->window_rows, row->epsilon);
    const vec bytes = v_interleave_low(v_set1(1), v_set1(256)), limit = v_set1((int16_t)factors.limit);
    const vec epsilon = v_set1_32((int32_t)factors.epsilon), numerator = v_set1_32((int32_t)factors.numerator);
    const float number = (float)factors.numerator;
    const int32_t width = row->width;
    for (int32_t x = 0; x < width; x += V_LANES) {
        const vec dx = v_sub(v_load(row->gray + x + 1), v_load(row->gray + x - 1));
        const vec dy = v_sub(v_load(row->below + x), v_load(row->above + x));
        const vec sum_low = sum5(low + x), sum_high = sum5(high + x), norm = v_load(norms + x);
        const vec least_low = v_low(norm, limit), least_high = v_high_unsigned(norm, limit);
        const vec a = v_max32(v_add32(v_pairs(v_interleave_low(sum_low, sum_high), bytes), epsilon),
                              v_shift_right32_8(v_join_low(least_low, least_high)));
        const vec b = v_max32(v_add32(v_pairs(v_interleave_high(sum_low, sum_high), bytes), epsilon),
                              v_shift_right32_8(v_join_high(least_low, least_high)));
        const vec scale_a = quotient32(number, numerator, a), scale_b = quotient32(number, numerator, b);
        const vec scale_low = v_pack_low(scale_a, scale_b), scale_high = v_pack_high(scale_a, scale_b);
        v_store(gx + x, scaled(dx, scale_low, scale_high));
        v_store(gy + x, scaled(dy, scale_low, scale_high));
    }
    for (int32_t x = width; x % V_LANES; x++)
        gx[x] = gy[x] = 0;
    for (int32_t x = 0; x < width; x += x == 1 && width > 4 ? width - 3 : 1) /* windows that the border cuts */
        asj_gradient_pixel(row, x, norms, low, high, gx, gy);
}

#endif
