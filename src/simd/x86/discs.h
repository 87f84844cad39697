/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_disc_compare() (align.c) in lanes of ASJ_LANE: the same sums in the same order, those that do not wait for each other in one
 * pass. */
#ifndef ASJ_SRC_X86_DISCS_H
#define ASJ_SRC_X86_DISCS_H

#include "match/disc.h"
#include "patches.h"

#include <immintrin.h>

#include <math.h>

static inline float fold_lanes(__m256 sum)
{
    float lane[ASJ_LANE];
    _mm256_storeu_ps(lane, sum);
    return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

/* start + a x + b y */
static inline __m256 along(float start, float a, __m256 x, float b, __m256 y)
{
    return _mm256_add_ps(_mm256_add_ps(_mm256_set1_ps(start), _mm256_mul_ps(_mm256_set1_ps(a), x)),
                         _mm256_mul_ps(_mm256_set1_ps(b), y));
}

/* Grey levels, 0 in the filling; returns their sum. */
static inline float sample_disc(const asj_disc *disc, const asj_pyramid *pyramid, const asj_disc_map *map, float *value,
                                int32_t *inside)
{
    const sampler_avx2 sampler = sampler_of(pyramid, map->level);
    const float *l = map->linear;
    __m256 sum = _mm256_setzero_ps();
    *inside = 0;
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        const __m256 x = _mm256_loadu_ps(disc->x + i), y = _mm256_loadu_ps(disc->y + i), mask = _mm256_loadu_ps(disc->mask + i);
        unsigned in;
        const __m256i grey = sample_positions(&sampler, along(map->x, l[0], x, l[1], y), along(map->y, l[2], x, l[3], y), &in);
        const __m256 v = _mm256_mul_ps(_mm256_cvtepi32_ps(grey), mask);
        *inside += __builtin_popcount(in & (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(mask, _mm256_setzero_ps(), _CMP_GT_OQ)));
        sum = _mm256_add_ps(sum, v);
        _mm256_storeu_ps(value + i, v);
    }
    return fold_lanes(sum);
}

/* Zero mean; what has to be multiplied for unit norm, with the floor, is returned. */
static inline float centre_disc(const asj_disc *disc, float total, float *value)
{
    const __m256 mean = _mm256_set1_ps(total / (float)disc->count);
    __m256 squares = _mm256_setzero_ps();
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        const __m256 v = _mm256_mul_ps(_mm256_sub_ps(_mm256_loadu_ps(value + i), mean), _mm256_loadu_ps(disc->mask + i));
        squares = _mm256_add_ps(squares, _mm256_mul_ps(v, v));
        _mm256_storeu_ps(value + i, v);
    }
    return 1 / (sqrtf(fold_lanes(squares)) + ASJ_GRAY_ONE * sqrtf((float)disc->count));
}

static void disc_compare_avx2(const asj_disc *disc, const asj_template *t, const asj_pyramid *pyramid, const asj_disc_map *map,
                              asj_disc_sums *sums)
{
    float value[ASJ_DISC_SAMPLES];
    const float total = sample_disc(disc, pyramid, map, value, &sums->inside);
    const __m256 scale = _mm256_set1_ps(centre_disc(disc, total, value));
    __m256 similarity = _mm256_setzero_ps(), descent[6];
    for (int32_t k = 0; k < 6; k++)
        descent[k] = _mm256_setzero_ps();
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        const __m256 v = _mm256_mul_ps(_mm256_loadu_ps(value + i), scale), expected = _mm256_loadu_ps(t->value + i);
        const __m256 error = _mm256_sub_ps(v, expected);
        similarity = _mm256_add_ps(similarity, _mm256_mul_ps(v, expected));
        for (int32_t k = 0; k < 6; k++)
            descent[k] = _mm256_add_ps(descent[k], _mm256_mul_ps(_mm256_loadu_ps(t->descent[k] + i), error));
    }
    sums->similarity = fold_lanes(similarity);
    for (int32_t k = 0; k < 6; k++)
        sums->descent[k] = fold_lanes(descent[k]);
}

#endif
