/* SPDX-License-Identifier: BSD-2-Clause */
/* Grey levels across an edge, eight rows at once: names as in the reference, edge_rows.c. */
#ifndef ASJ_SRC_X86_EDGES_H
#define ASJ_SRC_X86_EDGES_H

#include "detect/edge_rows.h"
#include "loads.h"

#include <immintrin.h>

/* Where the first samples of eight rows are, in 1/65536 px from a pixel near them. */
typedef struct eight_rows {
    const uint16_t *gray; /* of that pixel */
    __m256i x, y;
} eight_rows;

/* 0, step, .. 7 step behind `first`. */
static inline void rows_from(int32_t first, int32_t step, __m256d t[2])
{
    const __m128i lane = _mm_mullo_epi32(_mm_set1_epi32(step), _mm_setr_epi32(0, 1, 2, 3));
    const __m128i low = _mm_add_epi32(_mm_set1_epi32(first), lane);
    t[0] = _mm256_cvtepi32_pd(low);
    t[1] = _mm256_cvtepi32_pd(_mm_add_epi32(low, _mm_set1_epi32(4 * step)));
}

/* -1 where 0 <= v <= last. */
static inline __m256d is_within(__m256d v, int32_t last)
{
    const __m256d from = _mm256_cmp_pd(v, _mm256_setzero_pd(), _CMP_GE_OQ);
    return _mm256_and_pd(from, _mm256_cmp_pd(v, _mm256_set1_pd(last), _CMP_LE_OQ));
}

/* Of four coordinates, none negative, the pixel before, and what is left in 1/65536 px. */
static inline __m128i split_places(__m256d v, __m128i *pixel)
{
    *pixel = _mm256_cvttpd_epi32(v);
    return _mm256_cvttpd_epi32(_mm256_mul_pd(_mm256_set1_pd(65536), _mm256_sub_pd(v, _mm256_cvtepi32_pd(*pixel))));
}

/* Those of eight from the pixel of the first one on, which is returned: it is ASJ_GRAY_BORDER farther. */
static inline int32_t places_from_first(const __m256d v[2], __m256i *places)
{
    __m128i low, high;
    const __m128i low_part = split_places(v[0], &low), high_part = split_places(v[1], &high);
    const int32_t first = _mm_cvtsi128_si32(low);
    const __m256i pixels = _mm256_sub_epi32(_mm256_set_m128i(high, low), _mm256_set1_epi32(first));
    *places = _mm256_add_epi32(_mm256_slli_epi32(pixels, 16), _mm256_set_m128i(high_part, low_part));
    return first;
}

/* Returns how many of eight rows there are before the first outside the image; the others lie where the first one does. */
static inline int32_t place_rows(const asj_edge_line *line, int32_t t, int32_t step, eight_rows *rows)
{
    const asj_frame *frame = line->frame;
    const double start = line->offset - ASJ_EDGE_HALF;
    const __m256d off_x = _mm256_set1_pd(start * line->uy), off_y = _mm256_set1_pd(start * line->ux);
    const __m256d border = _mm256_set1_pd(ASJ_GRAY_BORDER);
    __m256d at[2], x[2], y[2], in[2];
    rows_from(t, step, at);
    for (int i = 0; i < 2; i++) {
        x[i] = _mm256_add_pd(_mm256_set1_pd(line->x), _mm256_mul_pd(at[i], _mm256_set1_pd(line->ux)));
        y[i] = _mm256_add_pd(_mm256_set1_pd(line->y), _mm256_mul_pd(at[i], _mm256_set1_pd(line->uy)));
        in[i] = _mm256_and_pd(is_within(x[i], frame->width - 1), is_within(y[i], frame->height - 1));
        x[i] = _mm256_add_pd(_mm256_sub_pd(x[i], off_x), border);
        y[i] = _mm256_add_pd(_mm256_add_pd(y[i], off_y), border);
    }
    const unsigned inside = (unsigned)_mm256_movemask_pd(in[0]) | (unsigned)_mm256_movemask_pd(in[1]) << 4;
    const __m256d first_x = _mm256_set1_pd(_mm256_cvtsd_f64(x[0])), first_y = _mm256_set1_pd(_mm256_cvtsd_f64(y[0]));
    if (!(inside & 1))
        return 0;
    for (int i = 0; i < 2; i++) {
        x[i] = _mm256_blendv_pd(first_x, x[i], in[i]);
        y[i] = _mm256_blendv_pd(first_y, y[i], in[i]);
    }
    const int32_t column = places_from_first(x, &rows->x) - ASJ_GRAY_BORDER;
    const int32_t row = places_from_first(y, &rows->y) - ASJ_GRAY_BORDER;
    rows->gray = frame->gray + row * frame->stride + column;
    return __builtin_ctz(~inside);
}

static inline __m256i level_at(const eight_rows *rows, ptrdiff_t stride, __m256i x, __m256i y)
{
    const __m256i below = _mm256_mullo_epi32(_mm256_srai_epi32(y, 16), _mm256_set1_epi32((int32_t)stride));
    const __m256i at = _mm256_add_epi32(below, _mm256_srai_epi32(x, 16)), byte = _mm256_set1_epi32(255);
    const __m256i wx = _mm256_and_si256(_mm256_srli_epi32(x, 8), byte), wy = _mm256_and_si256(_mm256_srli_epi32(y, 8), byte);
    const __m256i weights = _mm256_or_si256(_mm256_sub_epi32(_mm256_set1_epi32(256), wx), _mm256_slli_epi32(wx, 16));
    int32_t places[ASJ_EDGE_BATCH];
    _mm256_storeu_si256((__m256i *)(void *)places, at);
    const __m256i upper = two_at_eight(rows->gray, places), lower = two_at_eight(rows->gray + stride, places);
    const __m256i above = _mm256_srli_epi32(_mm256_madd_epi16(upper, weights), 1);
    const __m256i change = _mm256_sub_epi32(_mm256_srli_epi32(_mm256_madd_epi16(lower, weights), 1), above);
    return _mm256_srli_epi32(_mm256_add_epi32(_mm256_slli_epi32(above, 8), _mm256_mullo_epi32(wy, change)), 7);
}

static inline void read_eight(const asj_edge_line *line, const eight_rows *rows, int32_t *levels, ptrdiff_t room)
{
    const __m256i step_x = _mm256_set1_epi32((int32_t)(-65536 * line->uy)), step_y = _mm256_set1_epi32((int32_t)(65536 * line->ux));
    __m256i x = rows->x, y = rows->y, level[ASJ_EDGE_SAMPLES], sum = _mm256_setzero_si256();
    for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++) {
        level[i] = level_at(rows, line->frame->stride, x, y);
        sum = _mm256_add_epi32(sum, level[i]);
        x = _mm256_add_epi32(x, step_x);
        y = _mm256_add_epi32(y, step_y);
    }
    for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++) {
        const __m256i all = _mm256_mullo_epi32(level[i], _mm256_set1_epi32(ASJ_EDGE_SAMPLES));
        _mm256_storeu_si256((__m256i *)(void *)(levels + i * room), _mm256_sub_epi32(all, sum));
    }
}

static int32_t edge_rows_avx2(const asj_edge_line *line, int32_t first, int32_t step, int32_t count, int32_t *levels,
                              ptrdiff_t room)
{
    for (int32_t k = 0; k < count; k += ASJ_EDGE_BATCH) {
        const int32_t wanted = count - k < ASJ_EDGE_BATCH ? count - k : ASJ_EDGE_BATCH;
        eight_rows rows;
        const int32_t inside = place_rows(line, first + k * step, step, &rows);
        if (inside > 0)
            read_eight(line, &rows, levels + k, room);
        if (inside < wanted)
            return k + inside;
    }
    return count;
}

#endif
