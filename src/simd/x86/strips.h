/* SPDX-License-Identifier: BSD-2-Clause */
/* Sums over the pixels of a strip: names as in the reference, strip.c. */
#ifndef ASJ_SRC_X86_STRIPS_H
#define ASJ_SRC_X86_STRIPS_H

#include "detect/strip.h"

#include <immintrin.h>

static inline double total_of_four(__m256d v)
{
    const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
    return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}

/* Four neighbours, `step` elements apart where `apart`. */
static inline __m256d four(const int16_t *p, const int apart, ptrdiff_t step)
{
    if (!apart)
        return _mm256_cvtepi32_pd(_mm_cvtepi16_epi32(_mm_loadl_epi64((const __m128i *)(const void *)p)));
    return _mm256_cvtepi32_pd(_mm_setr_epi32(p[0], p[step], p[2 * step], p[3 * step]));
}

static inline __m256d masked_sum(__m256d sum, __m256d mask, __m256d v)
{
    return _mm256_add_pd(sum, _mm256_and_pd(mask, v));
}

/* along_x is a constant where this is called. */
static inline void add_strip(const asj_frame *frame, const asj_strip_walk *walk, const int along_x, asj_strip_sums *sums)
{
    const __m256d ux = _mm256_set1_pd(walk->ux), uy = _mm256_set1_pd(walk->uy), sign = _mm256_set1_pd(-0.0);
    const __m256d lane = _mm256_setr_pd(0, 1, 2, 3), zero = _mm256_setzero_pd();
    const ptrdiff_t step = along_x ? frame->stride : 1, stride = along_x ? 1 : frame->stride;
    __m256d gamma_sum = zero, uu = zero, un = zero, nn = zero, near_sum = zero;
    int32_t pixels = 0, near_pixels = 0;
    for (int32_t i = walk->first; i <= walk->last; i++) {
        int32_t first, last;
        asj_strip_step(frame, walk, i, &first, &last);
        for (int32_t j = first; j <= last; j += ASJ_STRIP_LANES) {
            const __m256d across_at = _mm256_add_pd(_mm256_set1_pd(j), lane);
            const __m256d dx = along_x ? _mm256_set1_pd(i - walk->x) : _mm256_sub_pd(across_at, _mm256_set1_pd(walk->x));
            const __m256d dy = along_x ? _mm256_sub_pd(across_at, _mm256_set1_pd(walk->y)) : _mm256_set1_pd(i - walk->y);
            const __m256d t = _mm256_add_pd(_mm256_mul_pd(dx, ux), _mm256_mul_pd(dy, uy));
            const __m256d s = _mm256_sub_pd(_mm256_mul_pd(dy, ux), _mm256_mul_pd(dx, uy));
            __m256d in = _mm256_cmp_pd(across_at, _mm256_set1_pd(last), _CMP_LE_OQ);
            in = _mm256_and_pd(in, _mm256_cmp_pd(t, _mm256_set1_pd(0.5), _CMP_GT_OQ));
            in = _mm256_and_pd(in, _mm256_cmp_pd(t, _mm256_set1_pd(walk->reach), _CMP_LE_OQ));
            in = _mm256_and_pd(in, _mm256_cmp_pd(_mm256_andnot_pd(sign, s), _mm256_set1_pd(walk->half_width), _CMP_LE_OQ));
            const __m256d near = _mm256_and_pd(in, _mm256_cmp_pd(t, _mm256_set1_pd(walk->near), _CMP_LE_OQ));
            const ptrdiff_t at = i * stride + j * step;
            const __m256d gx = four(frame->gradient_x + at, along_x, step), gy = four(frame->gradient_y + at, along_x, step);
            const __m256d along = _mm256_add_pd(_mm256_mul_pd(gx, ux), _mm256_mul_pd(gy, uy));
            const __m256d across = _mm256_sub_pd(_mm256_mul_pd(gy, ux), _mm256_mul_pd(gx, uy));
            const __m256d gamma = _mm256_max_pd(_mm256_sub_pd(_mm256_andnot_pd(sign, across), _mm256_andnot_pd(sign, along)), zero);
            gamma_sum = masked_sum(gamma_sum, in, gamma);
            uu = masked_sum(uu, in, _mm256_mul_pd(along, along));
            un = masked_sum(un, in, _mm256_mul_pd(along, across));
            nn = masked_sum(nn, in, _mm256_mul_pd(across, across));
            near_sum = masked_sum(near_sum, near, gamma);
            pixels += __builtin_popcount((unsigned)_mm256_movemask_pd(in));
            near_pixels += __builtin_popcount((unsigned)_mm256_movemask_pd(near));
        }
    }
    *sums = (asj_strip_sums){total_of_four(gamma_sum), total_of_four(uu), total_of_four(un), total_of_four(nn),
                             total_of_four(near_sum), pixels, near_pixels};
}

static void strip_sums_avx2(const asj_frame *frame, const asj_strip_walk *walk, asj_strip_sums *sums)
{
    if (walk->along_x)
        add_strip(frame, walk, 1, sums);
    else
        add_strip(frame, walk, 0, sums);
}

#endif
