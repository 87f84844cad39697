/* SPDX-License-Identifier: BSD-2-Clause */
/* Sums over the pixels of a strip: names as in the reference, strip.c. */
#ifndef ASJ_SRC_X86_STRIPS_H
#define ASJ_SRC_X86_STRIPS_H

#include "detect/strip.h"

#include <immintrin.h>

#include <string.h>

static inline double total_of_four(__m256d v)
{
    const __m128d two = _mm_add_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
    return _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
}

/* Four neighbours, `step` elements apart where `apart`: of each two are read, since planes have a margin. */
static inline __m256d four(const int16_t *p, const int apart, ptrdiff_t step)
{
    if (!apart)
        return _mm256_cvtepi32_pd(_mm_cvtepi16_epi32(_mm_loadl_epi64((const __m128i *)(const void *)p)));
    __m128i two[4];
    for (int i = 0; i < 4; i++) {
        int32_t pair;
        memcpy(&pair, p + i * step, sizeof pair);
        two[i] = _mm_cvtsi32_si128(pair);
    }
    const __m128i words = _mm_unpacklo_epi32(_mm_unpacklo_epi16(two[0], two[1]), _mm_unpacklo_epi16(two[2], two[3]));
    return _mm256_cvtepi32_pd(_mm_cvtepi16_epi32(words));
}

static inline __m256d masked_sum(__m256d sum, __m256d mask, __m256d v)
{
    return _mm256_add_pd(sum, _mm256_and_pd(mask, v));
}

/* Steps along a strip: the pixels across that may be inside, and what the step has of t and of s. */
#define STRIP_STEPS 64 /* at once */
typedef struct strip_steps {
    int32_t first[STRIP_STEPS], last[STRIP_STEPS];
    double start[STRIP_STEPS], end[STRIP_STEPS]; /* first and last */
    double t[STRIP_STEPS], s[STRIP_STEPS];
} strip_steps;

/* asj_strip_step() of four steps at a time from step `from` on, before any pixel is read: what follows from a step are some hundred
 * cycles, and processors have more of them under way so. */
static inline void find_steps(const asj_frame *frame, const asj_strip_walk *walk, const int along_x, int32_t from,
                              strip_steps *steps)
{
    const __m256d major = _mm256_set1_pd(along_x ? walk->x : walk->y), minor = _mm256_set1_pd(along_x ? walk->y : walk->x);
    const __m256d u_t = _mm256_set1_pd(along_x ? walk->ux : walk->uy), u_s = _mm256_set1_pd(along_x ? walk->uy : walk->ux);
    const __m256d slope = _mm256_set1_pd(walk->slope), spread = _mm256_set1_pd(walk->spread), large = _mm256_set1_pd(131072);
    const __m128i lane = _mm_setr_epi32(0, 1, 2, 3), floor_one = _mm_set1_epi32(131072 - 1), floor_none = _mm_set1_epi32(131072);
    const __m128i most = _mm_set1_epi32((along_x ? frame->height : frame->width) - 1);
    for (int32_t i = 0; i < STRIP_STEPS && from + i <= walk->last; i += 4) {
        const __m256d step = _mm256_cvtepi32_pd(_mm_add_epi32(_mm_set1_epi32(from + i), lane)), at = _mm256_sub_pd(step, major);
        const __m256d middle = _mm256_add_pd(minor, _mm256_mul_pd(at, slope));
        const __m256d low = _mm256_add_pd(_mm256_sub_pd(middle, spread), large);
        const __m256d high = _mm256_add_pd(_mm256_add_pd(middle, spread), large);
        const __m128i first = _mm_max_epi32(_mm_sub_epi32(_mm256_cvttpd_epi32(low), floor_one), _mm_setzero_si128());
        const __m128i last = _mm_min_epi32(_mm_sub_epi32(_mm256_cvttpd_epi32(high), floor_none), most);
        _mm_storeu_si128((__m128i *)(void *)(steps->first + i), first);
        _mm_storeu_si128((__m128i *)(void *)(steps->last + i), last);
        _mm256_storeu_pd(steps->start + i, _mm256_cvtepi32_pd(first));
        _mm256_storeu_pd(steps->end + i, _mm256_cvtepi32_pd(last));
        _mm256_storeu_pd(steps->t + i, _mm256_mul_pd(at, u_t));
        _mm256_storeu_pd(steps->s + i, _mm256_mul_pd(at, u_s));
    }
}

typedef struct strip_lanes {
    __m256d gamma, uu, un, nn, near_gamma;
    int32_t pixels, near_pixels; /* of all lanes */
} strip_lanes;

/* along_x is a constant where this is called. */
static inline void add_steps(const asj_frame *frame, const asj_strip_walk *walk, const int along_x, int32_t from,
                             const strip_steps *steps, strip_lanes *to)
{
    const __m256d ux = _mm256_set1_pd(walk->ux), uy = _mm256_set1_pd(walk->uy), sign = _mm256_set1_pd(-0.0);
    const __m256d lane = _mm256_setr_pd(0, 1, 2, 3), zero = _mm256_setzero_pd();
    const __m256d u_t = along_x ? uy : ux, u_s = along_x ? ux : uy, minor = _mm256_set1_pd(along_x ? walk->y : walk->x);
    const __m256d reach = _mm256_set1_pd(walk->reach), near_reach = _mm256_set1_pd(walk->near);
    const ptrdiff_t step = along_x ? frame->stride : 1, stride = along_x ? 1 : frame->stride;
    const int32_t count = walk->last - from < STRIP_STEPS ? walk->last - from + 1 : STRIP_STEPS;
    strip_lanes sums = *to;
    for (int32_t i = 0; i < count; i++) {
        __m256d across_at = _mm256_add_pd(_mm256_set1_pd(steps->start[i]), lane);
        for (int32_t j = steps->first[i]; j <= steps->last[i]; j += ASJ_STRIP_LANES) {
            const __m256d at_minor = _mm256_sub_pd(across_at, minor);
            const __m256d of_t = _mm256_set1_pd(steps->t[i]), of_s = _mm256_set1_pd(steps->s[i]);
            const __m256d t = _mm256_add_pd(of_t, _mm256_mul_pd(at_minor, u_t)), beside = _mm256_mul_pd(at_minor, u_s);
            const __m256d s = _mm256_sub_pd(beside, of_s); /* or its negative: it has no sign here */
            __m256d in = _mm256_cmp_pd(across_at, _mm256_set1_pd(steps->end[i]), _CMP_LE_OQ);
            in = _mm256_and_pd(in, _mm256_cmp_pd(t, _mm256_set1_pd(0.5), _CMP_GT_OQ));
            in = _mm256_and_pd(in, _mm256_cmp_pd(t, reach, _CMP_LE_OQ));
            in = _mm256_and_pd(in, _mm256_cmp_pd(_mm256_andnot_pd(sign, s), _mm256_set1_pd(walk->half_width), _CMP_LE_OQ));
            const __m256d near = _mm256_and_pd(in, _mm256_cmp_pd(t, near_reach, _CMP_LE_OQ));
            const ptrdiff_t at = (from + i) * stride + j * step;
            const __m256d gx = four(frame->gradient_x + at, along_x, step), gy = four(frame->gradient_y + at, along_x, step);
            const __m256d along = _mm256_add_pd(_mm256_mul_pd(gx, ux), _mm256_mul_pd(gy, uy));
            const __m256d across = _mm256_sub_pd(_mm256_mul_pd(gy, ux), _mm256_mul_pd(gx, uy));
            const __m256d gamma = _mm256_max_pd(_mm256_sub_pd(_mm256_andnot_pd(sign, across), _mm256_andnot_pd(sign, along)), zero);
            sums.gamma = masked_sum(sums.gamma, in, gamma);
            sums.uu = masked_sum(sums.uu, in, _mm256_mul_pd(along, along));
            sums.un = masked_sum(sums.un, in, _mm256_mul_pd(along, across));
            sums.nn = masked_sum(sums.nn, in, _mm256_mul_pd(across, across));
            sums.near_gamma = masked_sum(sums.near_gamma, near, gamma);
            sums.pixels += __builtin_popcount((unsigned)_mm256_movemask_pd(in));
            sums.near_pixels += __builtin_popcount((unsigned)_mm256_movemask_pd(near));
            across_at = _mm256_add_pd(across_at, _mm256_set1_pd(ASJ_STRIP_LANES));
        }
    }
    *to = sums;
}

static inline void add_strip(const asj_frame *frame, const asj_strip_walk *walk, const int along_x, asj_strip_sums *sums)
{
    const __m256d zero = _mm256_setzero_pd();
    strip_lanes list = {zero, zero, zero, zero, zero, 0, 0};
    strip_steps steps;
    for (int32_t from = walk->first; from <= walk->last; from += STRIP_STEPS) {
        find_steps(frame, walk, along_x, from, &steps);
        add_steps(frame, walk, along_x, from, &steps, &list);
    }
    *sums = (asj_strip_sums){total_of_four(list.gamma), total_of_four(list.uu), total_of_four(list.un), total_of_four(list.nn),
                             total_of_four(list.near_gamma), list.pixels, list.near_pixels};
}

static void strip_sums_avx2(const asj_frame *frame, const asj_strip_walk *walk, asj_strip_sums *sums)
{
    if (walk->along_x)
        add_strip(frame, walk, 1, sums);
    else
        add_strip(frame, walk, 0, sums);
}

#endif
