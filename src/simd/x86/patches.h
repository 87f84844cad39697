/* SPDX-License-Identifier: BSD-2-Clause */
/* The matcher's operations with 32-bit lanes and gathers: names as in the files that define them. */
#ifndef ASJ_SRC_X86_PATCHES_H
#define ASJ_SRC_X86_PATCHES_H

#include "match/patch.h"

#include <immintrin.h>

/* Pairs of levels that share a tap are interleaved: one multiplication weights and adds both. */
static void blur_row_avx2(const uint16_t *const *rows, const int32_t *taps, int32_t radius, int32_t width, uint16_t *to)
{
    const uint16_t *rest[ASJ_BLUR_ROWS];
    const int32_t whole = width & ~15;
    for (int32_t x = 0; x < whole; x += 16) {
        const __m256i middle = v_load(rows[0] + x), half = _mm256_set1_epi32(1 << 13), tap0 = v_set1((int16_t)taps[0]);
        __m256i low = _mm256_add_epi32(half, _mm256_madd_epi16(_mm256_unpacklo_epi16(middle, v_zero()), tap0));
        __m256i high = _mm256_add_epi32(half, _mm256_madd_epi16(_mm256_unpackhi_epi16(middle, v_zero()), tap0));
        for (int32_t i = 1; i <= radius; i++) {
            const __m256i before = v_load(rows[2 * i - 1] + x), after = v_load(rows[2 * i] + x), tap = v_set1((int16_t)taps[i]);
            low = _mm256_add_epi32(low, _mm256_madd_epi16(_mm256_unpacklo_epi16(before, after), tap));
            high = _mm256_add_epi32(high, _mm256_madd_epi16(_mm256_unpackhi_epi16(before, after), tap));
        }
        v_store(to + x, _mm256_packus_epi32(_mm256_srai_epi32(low, 14), _mm256_srai_epi32(high, 14)));
    }
    for (int32_t i = 0; i <= 2 * radius; i++)
        rest[i] = rows[i] + whole;
    asj_blur_row(rest, taps, radius, width - whole, to + whole);
}

/* What a level of a pyramid needs for bilinear samples: two neighbouring grey levels in one gather, weighted and added by one
 * multiplication. Levels stay below 2^15. */
typedef struct plane_avx2 {
    const int *levels;
    __m256i stride, right, bottom; /* limits in 1/256 px */
} plane_avx2;

static inline plane_avx2 plane_of(const asj_pyramid *pyramid, int32_t level)
{
    const int32_t width = pyramid->width[level], height = pyramid->height[level];
    return (plane_avx2){(const int *)(const void *)pyramid->plane[level], _mm256_set1_epi32(width + 1),
                        _mm256_set1_epi32((width - 1) << 8), _mm256_set1_epi32((height - 1) << 8)};
}

/* At whole numbers of 1/256 px within the limits. */
static inline __m256i bilinear(const plane_avx2 *plane, __m256i ix, __m256i iy)
{
    const __m256i fraction = _mm256_set1_epi32(255), one = _mm256_set1_epi32(256), half = _mm256_set1_epi32(1 << 14);
    const __m256i wx = _mm256_and_si256(ix, fraction), wy = _mm256_and_si256(iy, fraction);
    const __m256i weights = _mm256_or_si256(_mm256_sub_epi32(one, wx), _mm256_slli_epi32(wx, 16));
    const __m256i at = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_srai_epi32(iy, 8), plane->stride), _mm256_srai_epi32(ix, 8));
    __m256i upper = _mm256_madd_epi16(_mm256_i32gather_epi32(plane->levels, at, 2), weights);
    __m256i lower = _mm256_madd_epi16(_mm256_i32gather_epi32(plane->levels, _mm256_add_epi32(at, plane->stride), 2), weights);
    upper = _mm256_mullo_epi32(_mm256_srai_epi32(upper, 1), _mm256_sub_epi32(one, wy));
    lower = _mm256_mullo_epi32(_mm256_srai_epi32(lower, 1), wy);
    return _mm256_srai_epi32(_mm256_add_epi32(_mm256_add_epi32(upper, lower), half), 15);
}

/* .. and what for positions in px of level 0. */
typedef struct sampler_avx2 {
    plane_avx2 plane;
    __m256 scale, shift, right, bottom, last_x, last_y;
} sampler_avx2;

static inline sampler_avx2 sampler_of(const asj_pyramid *pyramid, int32_t level)
{
    const float scale = 256.0f / (float)(1 << level);
    return (sampler_avx2){plane_of(pyramid, level), _mm256_set1_ps(scale), _mm256_set1_ps(0.5f * scale - 128.0f),
                          _mm256_set1_ps((float)(pyramid->width[level] - 1) * 256.0f),
                          _mm256_set1_ps((float)(pyramid->height[level] - 1) * 256.0f),
                          _mm256_set1_ps((float)(pyramid->width[0] - 1)), _mm256_set1_ps((float)(pyramid->height[0] - 1))};
}

/* Where eight positions lie in their level, in whole 1/256 px, and a bit for each that is inside the image. */
static inline unsigned positions_of(const sampler_avx2 *s, __m256 x, __m256 y, __m256i *ix, __m256i *iy)
{
    const __m256 zero = _mm256_setzero_ps();
    const __m256 in_x = _mm256_and_ps(_mm256_cmp_ps(x, zero, _CMP_GE_OQ), _mm256_cmp_ps(x, s->last_x, _CMP_LE_OQ));
    const __m256 in_y = _mm256_and_ps(_mm256_cmp_ps(y, zero, _CMP_GE_OQ), _mm256_cmp_ps(y, s->last_y, _CMP_LE_OQ));
    const __m256 fx = _mm256_max_ps(_mm256_add_ps(_mm256_mul_ps(x, s->scale), s->shift), zero);
    const __m256 fy = _mm256_max_ps(_mm256_add_ps(_mm256_mul_ps(y, s->scale), s->shift), zero);
    *ix = _mm256_cvttps_epi32(_mm256_min_ps(fx, s->right));
    *iy = _mm256_cvttps_epi32(_mm256_min_ps(fy, s->bottom));
    return (unsigned)_mm256_movemask_ps(_mm256_and_ps(in_x, in_y));
}

/* Eight levels, and a bit for each position inside the image. */
static inline __m256i sample_positions(const sampler_avx2 *s, __m256 x, __m256 y, unsigned *inside)
{
    __m256i ix, iy;
    *inside = positions_of(s, x, y, &ix, &iy);
    return bilinear(&s->plane, ix, iy);
}

static int32_t pyramid_sample_avx2(const asj_pyramid *pyramid, int32_t level, const float *x, const float *y, int32_t count,
                                   uint16_t *grey)
{
    const sampler_avx2 sampler = sampler_of(pyramid, level);
    const int32_t whole = count & ~7;
    int32_t inside = 0;
    for (int32_t i = 0; i < whole; i += 8) {
        unsigned in;
        const __m256i sum = sample_positions(&sampler, _mm256_loadu_ps(x + i), _mm256_loadu_ps(y + i), &in);
        inside += __builtin_popcount(in);
        _mm_storeu_si128((__m128i *)(void *)(grey + i),
                         _mm_packus_epi32(_mm256_castsi256_si128(sum), _mm256_extracti128_si256(sum, 1)));
    }
    return inside + asj_pyramid_sample_reference(pyramid, level, x + whole, y + whole, count - whole, grey + whole);
}

/* From 2^-ASJ_GRID_BITS px of level 0 to 1/256 px of the level, within the limits. */
static inline __m256i to_level(__m256i x, __m128i level, __m256i last)
{
    const __m256i half = _mm256_set1_epi32(1 << (ASJ_GRID_BITS - 1));
    const __m256i there = _mm256_sub_epi32(_mm256_sra_epi32(_mm256_add_epi32(x, half), level), half);
    return _mm256_min_epi32(_mm256_max_epi32(_mm256_srai_epi32(there, ASJ_GRID_BITS - 8), v_zero()), last);
}

/* -1 where 0 <= x <= last: unsigned, negative positions are large. */
static inline __m256i within(__m256i x, __m256i last)
{
    return _mm256_cmpeq_epi32(_mm256_min_epu32(x, last), x);
}

/* Four columns of two rows at once. */
static int32_t patch_levels_avx2(const asj_pyramid *pyramid, const asj_patch_grid *grid, int32_t size, uint16_t *grey)
{
    const plane_avx2 plane = plane_of(pyramid, grid->level);
    const __m128i level = _mm_cvtsi32_si128(grid->level);
    const __m256i last_x = _mm256_set1_epi32((pyramid->width[0] - 1) << ASJ_GRID_BITS);
    const __m256i last_y = _mm256_set1_epi32((pyramid->height[0] - 1) << ASJ_GRID_BITS);
    const __m256i column = _mm256_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3), row = _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1);
    const __m256i offset_x = _mm256_add_epi32(_mm256_mullo_epi32(column, _mm256_set1_epi32(grid->ax)),
                                              _mm256_mullo_epi32(row, _mm256_set1_epi32(grid->bx)));
    const __m256i offset_y = _mm256_add_epi32(_mm256_mullo_epi32(column, _mm256_set1_epi32(grid->ay)),
                                              _mm256_mullo_epi32(row, _mm256_set1_epi32(grid->by)));
    __m256i inside = v_zero();
    for (int32_t j = 0; j < size; j += 2)
        for (int32_t i = 0; i < size; i += 4) {
            const __m256i x = _mm256_add_epi32(_mm256_set1_epi32(grid->x + i * grid->ax + j * grid->bx), offset_x);
            const __m256i y = _mm256_add_epi32(_mm256_set1_epi32(grid->y + i * grid->ay + j * grid->by), offset_y);
            inside = _mm256_sub_epi32(inside, _mm256_and_si256(within(x, last_x), within(y, last_y)));
            const __m256i sum = bilinear(&plane, to_level(x, level, plane.right), to_level(y, level, plane.bottom));
            const __m128i both = _mm_packus_epi32(_mm256_castsi256_si128(sum), _mm256_extracti128_si256(sum, 1));
            uint16_t *to = grey + (ptrdiff_t)j * size + i;
            _mm_storel_epi64((__m128i *)(void *)to, both);
            _mm_storel_epi64((__m128i *)(void *)(to + size), _mm_unpackhi_epi64(both, both));
        }
    return v_sum32(inside);
}

/* Eight levels, as N g - s, times the scale: the high halves, rounded. */
static inline __m256i high_halves(__m256i levels, __m256i samples, __m256i sum, __m256i scale)
{
    const __m256i d = _mm256_sub_epi32(_mm256_mullo_epi32(levels, samples), sum), half = _mm256_set1_epi64x((int64_t)1 << 31);
    const __m256i even = _mm256_add_epi64(_mm256_mul_epi32(d, scale), half);
    const __m256i odd = _mm256_add_epi64(_mm256_mul_epi32(_mm256_srli_epi64(d, 32), scale), half);
    return _mm256_blend_epi32(_mm256_srli_epi64(even, 32), odd, 0xaa);
}

static void patch_normalise_avx2(const uint16_t *grey, int32_t size, int16_t *unit)
{
    const int32_t samples = size * size;
    __m256i sums = v_zero(), squares = v_zero();
    for (int32_t i = 0; i < samples; i += 16) {
        const __m256i g = v_load(grey + i), square = _mm256_madd_epi16(g, g); /* below 2^31 */
        sums = _mm256_add_epi32(sums, _mm256_madd_epi16(g, v_set1(1)));
        squares = _mm256_add_epi64(squares, _mm256_srli_epi64(square, 32));
        squares = _mm256_add_epi64(squares, _mm256_and_si256(square, _mm256_set1_epi64x(0xffffffff)));
    }
    int64_t lanes[4];
    v_store(lanes, squares);
    const int32_t sum = v_sum32(sums);
    const __m256i scale = _mm256_set1_epi32(asj_patch_unit_scale(sum, lanes[0] + lanes[1] + lanes[2] + lanes[3], size));
    const __m256i count = _mm256_set1_epi32(samples), shift = _mm256_set1_epi32(sum);
    for (int32_t i = 0; i < samples; i += 16) {
        const __m256i g = v_load(grey + i);
        const __m256i low = high_halves(_mm256_cvtepu16_epi32(_mm256_castsi256_si128(g)), count, shift, scale);
        const __m256i high = high_halves(_mm256_cvtepu16_epi32(_mm256_extracti128_si256(g, 1)), count, shift, scale);
        v_store(unit + i, _mm256_permute4x64_epi64(_mm256_packs_epi32(low, high), 0xd8));
    }
}

#endif
