/* SPDX-License-Identifier: BSD-2-Clause */
/* Arcs of rays, all samples of one at once: names as in the reference, ray_walk.c. */
#ifndef ASJ_SRC_X86_ARCS_H
#define ASJ_SRC_X86_ARCS_H

#include "detect/ray_walk.h"

#include <immintrin.h>
#include <stdlib.h>

/* cos and sin of d / r for each lane; lanes behind the last sample hold anything. */
static inline void turns_of(const asj_scan *scan, int32_t r, __m256i *cosine, __m256i *sine)
{
    const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), d = _mm256_sub_epi32(lane, _mm256_set1_epi32(scan->half_width));
    const __m256i size = _mm256_abs_epi32(d);
    __m128i c = _mm_set1_epi32(1 << 30), s;
    if (r < ASJ_SCAN_TABLE_RADIUS) {
        c = _mm_loadu_si128((const __m128i *)(const void *)scan->arc_cosine[r]);
        s = _mm_loadu_si128((const __m128i *)(const void *)scan->arc_sine[r]);
    } else {
        const int64_t one = (int64_t)1 << 30;
        s = _mm_setr_epi32(0, (int32_t)(one / r), (int32_t)(2 * one / r), (int32_t)(3 * one / r));
    }
    *cosine = _mm256_permutevar8x32_epi32(_mm256_castsi128_si256(c), size);
    *sine = _mm256_sign_epi32(_mm256_permutevar8x32_epi32(_mm256_castsi128_si256(s), size), d);
}

/* Every other lane of two, the even ones of `even` and those of `odd` behind them: lower halves of 64 bits. */
static inline __m256i lower_halves(__m256i even, __m256i odd)
{
    return _mm256_blend_epi32(even, _mm256_slli_epi64(odd, 32), 0xaa);
}

/* (a b - c d) >> 30 of the even lanes, in the lower halves of 64 bits: shifted logically, which these do not feel. */
static inline __m256i rotated(__m256i a, __m256i b, __m256i c, __m256i d)
{
    return _mm256_srli_epi64(_mm256_sub_epi64(_mm256_mul_epi32(a, b), _mm256_mul_epi32(c, d)), 30);
}

/* (start + (r e >> 14)) >> 16, the same way. */
static inline __m256i pixel_at(__m256i start, __m256i r, __m256i e)
{
    return _mm256_srli_epi64(_mm256_add_epi64(start, _mm256_srli_epi64(_mm256_mul_epi32(r, e), 14)), 16);
}

static void place_arc_avx2(const asj_scan *scan, const asj_ray_direction *way, int32_t r, asj_arc *arc)
{
    const __m256i ux = _mm256_set1_epi32((int32_t)way->ux), uy = _mm256_set1_epi32((int32_t)way->uy);
    const __m256i x = _mm256_set1_epi64x(way->x + 32768), y = _mm256_set1_epi64x(way->y + 32768), radius = _mm256_set1_epi32(r);
    const __m256i minus_uy = _mm256_sub_epi32(_mm256_setzero_si256(), uy);
    __m256i c, s;
    turns_of(scan, r, &c, &s);
    const __m256i odd_c = _mm256_srli_epi64(c, 32), odd_s = _mm256_srli_epi64(s, 32);
    const __m256i ex = rotated(c, ux, s, uy), odd_ex = rotated(odd_c, ux, odd_s, uy);
    const __m256i ey = rotated(s, ux, c, minus_uy), odd_ey = rotated(odd_s, ux, odd_c, minus_uy);
    const __m256i at_x = lower_halves(pixel_at(x, radius, ex), pixel_at(x, radius, odd_ex));
    const __m256i at_y = lower_halves(pixel_at(y, radius, ey), pixel_at(y, radius, odd_ey));
    const __m256i cosine = _mm256_srli_epi32(lower_halves(ex, odd_ex), 16), sine = lower_halves(ey, odd_ey);
    _mm256_storeu_si256((__m256i *)(void *)arc->x, at_x);
    _mm256_storeu_si256((__m256i *)(void *)arc->y, at_y);
    _mm256_storeu_si256((__m256i *)(void *)arc->unit, _mm256_blend_epi16(cosine, sine, 0xaa));
}

/* Branch i of all samples, one after the other. */
static inline void turn_lists(asj_arc_branches branches, __m256i list[ASJ_FIELD_BRANCHES])
{
    __m256i v[4], t[4];
    for (int i = 0; i < 4; i++)
        v[i] = _mm256_loadu2_m128i((const __m128i *)(const void *)branches[i + 4], (const __m128i *)(const void *)branches[i]);
    for (int i = 0; i < 4; i += 2) {
        t[i] = _mm256_unpacklo_epi32(v[i], v[i + 1]);
        t[i + 1] = _mm256_unpackhi_epi32(v[i], v[i + 1]);
    }
    for (int i = 0; i < 2; i++) {
        list[2 * i] = _mm256_unpacklo_epi64(t[i], t[i + 2]);
        list[2 * i + 1] = _mm256_unpackhi_epi64(t[i], t[i + 2]);
    }
}

/* The branches that are closest to the ray's direction, as closest() has them. */
static inline void closest_branches(const __m256i list[ASJ_FIELD_BRANCHES], uint16_t angle, __m256i *forward, __m256i *axial)
{
    const __m256i ray = _mm256_set1_epi32((int32_t)((uint32_t)angle << 16)), quarter = _mm256_set1_epi32(16384);
    const __m256i far = _mm256_set1_epi32(1 << 20), zero = _mm256_setzero_si256();
    __m256i nearest = _mm256_set1_epi32(INT32_MAX), nearest_axis = nearest;
    *forward = *axial = zero;
    for (int32_t i = 0; i < ASJ_FIELD_BRANCHES; i++) {
        const __m256i none = _mm256_and_si256(_mm256_cmpeq_epi32(_mm256_srli_epi32(list[i], 16), zero), far);
        const __m256i turn = _mm256_srai_epi32(_mm256_sub_epi32(_mm256_slli_epi32(list[i], 16), ray), 16);
        const __m256i distance = _mm256_abs_epi32(turn);
        const __m256i axis = _mm256_sub_epi32(quarter, _mm256_abs_epi32(_mm256_sub_epi32(quarter, distance)));
        const __m256i order = _mm256_or_si256(distance, none), axis_order = _mm256_or_si256(axis, none);
        *forward = _mm256_blendv_epi8(*forward, list[i], _mm256_cmpgt_epi32(nearest, order)); /* of equals the first one */
        *axial = _mm256_blendv_epi8(*axial, list[i], _mm256_cmpgt_epi32(nearest_axis, axis_order));
        nearest = _mm256_min_epi32(nearest, order);
        nearest_axis = _mm256_min_epi32(nearest_axis, axis_order);
    }
}

/* gamma~ of the branches; *along: of their directions along the ray. */
static inline __m256i junctionness(const asj_scan *scan, __m256i branch, __m256i unit, __m256i turned_unit, __m256i *along)
{
    const __m256i angle = _mm256_and_si256(branch, _mm256_set1_epi32(65535)), mask = _mm256_set1_epi32(1023);
    const __m256i place = _mm256_and_si256(_mm256_srli_epi32(_mm256_add_epi32(angle, _mm256_set1_epi32(32)), 6), mask);
    const __m256i direction = _mm256_i32gather_epi32((const int *)(const void *)scan->unit, place, 4);
    *along = _mm256_madd_epi16(direction, unit);
    const __m256i across = _mm256_madd_epi16(direction, turned_unit);
    const __m256i share = _mm256_srai_epi32(_mm256_sub_epi32(_mm256_abs_epi32(*along), _mm256_abs_epi32(across)), 14);
    const __m256i gamma = _mm256_srai_epi32(_mm256_mullo_epi32(share, _mm256_srli_epi32(branch, 16)), 14);
    return _mm256_max_epi32(gamma, _mm256_setzero_si256());
}

static void sum_arc_avx2(const asj_scan *scan, const asj_ray_direction *way, const asj_arc *arc, asj_arc_branches branches,
                         asj_arc_sums *sums)
{
    const __m256i unit = _mm256_loadu_si256((const __m256i *)(const void *)arc->unit), zero = _mm256_setzero_si256();
    const __m256i swapped = _mm256_or_si256(_mm256_slli_epi32(unit, 16), _mm256_srli_epi32(unit, 16)); /* (sine, cosine) */
    const __m256i turned_unit = _mm256_sign_epi16(swapped, _mm256_set1_epi32((int32_t)0xffff0001u));
    __m256i list[ASJ_FIELD_BRANCHES], forward, axial, along, ignored;
    turn_lists(branches, list);
    closest_branches(list, way->angle, &forward, &axial);
    const __m256i gamma = junctionness(scan, forward, unit, turned_unit, &along);
    const __m256i axial_gamma = junctionness(scan, axial, unit, turned_unit, &ignored);
    const __m256i ahead = _mm256_and_si256(gamma, _mm256_cmpgt_epi32(along, zero));
    const __m256i pairs = _mm256_hadd_epi32(_mm256_hadd_epi32(gamma, ahead), _mm256_hadd_epi32(axial_gamma, zero));
    const __m128i all = _mm_add_epi32(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1));
    *sums = (asj_arc_sums){_mm_cvtsi128_si32(all), _mm_extract_epi32(all, 1), scan->axial ? _mm_extract_epi32(all, 2) : 0};
}

#endif
