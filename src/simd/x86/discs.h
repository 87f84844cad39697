/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_disc_compare() (align.c) in lanes of ASJ_LANE: the same sums in the same order, those that do not wait for each other in one
 * pass. */
#ifndef ASJ_SRC_X86_DISCS_H
#define ASJ_SRC_X86_DISCS_H

#include "match/disc.h"
#include "loads.h"
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

/* Where samples lie in their level: the number of a grey level, and the weights of what lies right of it and below. */
typedef struct disc_places {
    int32_t at[ASJ_DISC_SAMPLES], across[ASJ_DISC_SAMPLES], down[ASJ_DISC_SAMPLES];
} disc_places;

/* For positions in 1/256 px of the level. */
static inline void place_eight(const plane_avx2 *plane, __m256i ix, __m256i iy, disc_places *places, int32_t i)
{
    const __m256i fraction = _mm256_set1_epi32(255), wx = _mm256_and_si256(ix, fraction);
    const __m256i row = _mm256_mullo_epi32(_mm256_srai_epi32(iy, 8), plane->stride);
    v_store(places->at + i, _mm256_add_epi32(row, _mm256_srai_epi32(ix, 8)));
    v_store(places->across + i, _mm256_or_si256(_mm256_sub_epi32(_mm256_set1_epi32(256), wx), _mm256_slli_epi32(wx, 16)));
    v_store(places->down + i, _mm256_and_si256(iy, fraction));
}

/* Is the whole disc so far inside that neither rounding nor what a level leaves out at its border takes a sample out? */
static inline int is_inside(const asj_disc *disc, const asj_pyramid *pyramid, const asj_disc_map *map)
{
    const float *l = map->linear, margin = (float)(2 << map->level);
    const float x = disc->radius * (fabsf(l[0]) + fabsf(l[1])) + margin, y = disc->radius * (fabsf(l[2]) + fabsf(l[3])) + margin;
    return map->x >= x && map->y >= y && map->x <= (float)pyramid->width[0] - x && map->y <= (float)pyramid->height[0] - y;
}

/* Of a disc that is inside. */
static inline void place_inside(const asj_disc *disc, const sampler_avx2 *s, const asj_disc_map *map, disc_places *places)
{
    const float *l = map->linear;
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        const __m256 dx = _mm256_loadu_ps(disc->x + i), dy = _mm256_loadu_ps(disc->y + i);
        const __m256 x = along(map->x, l[0], dx, l[1], dy), y = along(map->y, l[2], dx, l[3], dy);
        place_eight(&s->plane, _mm256_cvttps_epi32(_mm256_add_ps(_mm256_mul_ps(x, s->scale), s->shift)),
                    _mm256_cvttps_epi32(_mm256_add_ps(_mm256_mul_ps(y, s->scale), s->shift)), places, i);
    }
}

/* Returns how many samples are inside. */
static inline int32_t place_disc(const asj_disc *disc, const sampler_avx2 *s, const asj_disc_map *map, disc_places *places)
{
    const float *l = map->linear;
    const __m256 zero = _mm256_setzero_ps();
    int32_t inside = 0;
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        const __m256 dx = _mm256_loadu_ps(disc->x + i), dy = _mm256_loadu_ps(disc->y + i);
        const __m256 counts = _mm256_cmp_ps(_mm256_loadu_ps(disc->mask + i), zero, _CMP_GT_OQ);
        __m256i ix, iy;
        const unsigned in = positions_of(s, along(map->x, l[0], dx, l[1], dy), along(map->y, l[2], dx, l[3], dy), &ix, &iy);
        inside += __builtin_popcount(in & (unsigned)_mm256_movemask_ps(counts));
        place_eight(&s->plane, ix, iy, places, i);
    }
    return inside;
}

/* Grey levels, as bilinear() has them: u (256 - w) + l w = 256 u + (l - u) w. */
static inline __m256 eight_levels(const uint16_t *levels, const uint16_t *below, const disc_places *places, int32_t i)
{
    const __m256i across = v_load(places->across + i), half = _mm256_set1_epi32(1 << 14);
    const __m256i upper = _mm256_srai_epi32(_mm256_madd_epi16(two_at_eight(levels, places->at + i), across), 1);
    const __m256i lower = _mm256_srai_epi32(_mm256_madd_epi16(two_at_eight(below, places->at + i), across), 1);
    const __m256i more = _mm256_mullo_epi32(_mm256_sub_epi32(lower, upper), v_load(places->down + i));
    return _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_add_epi32(_mm256_add_epi32(_mm256_slli_epi32(upper, 8), more), half), 15));
}

/* Grey levels, 0 in the filling; returns their sum. All places first: then loads do not wait for them. */
static inline float sample_disc(const asj_disc *disc, const asj_pyramid *pyramid, const asj_disc_map *map, float *value,
                                int32_t *inside)
{
    const sampler_avx2 s = sampler_of(pyramid, map->level);
    const uint16_t *levels = pyramid->plane[map->level], *below = levels + pyramid->width[map->level] + 1;
    disc_places places;
    __m256 sum = _mm256_setzero_ps();
    if (is_inside(disc, pyramid, map)) {
        place_inside(disc, &s, map, &places);
        *inside = disc->count;
    } else {
        *inside = place_disc(disc, &s, map, &places);
    }
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        const __m256 v = _mm256_mul_ps(eight_levels(levels, below, &places, i), _mm256_loadu_ps(disc->mask + i));
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
