/* SPDX-License-Identifier: BSD-2-Clause */
/* As lines.h, for 16 lanes. */
#ifndef ASJ_SRC_X86_LINES512_H
#define ASJ_SRC_X86_LINES512_H

#include "detect/line_sums.h"
#include "loads.h"

#include <immintrin.h>

typedef struct lane_sums {
    __m512 w, x, y, xx, xy, yy;
} lane_sums;

/* Of 16 columns while their rows are walked along: sums of w, w y, w y^2. */
typedef struct column_sums {
    __m512 w, y, yy;
} column_sums;

/* Neighbouring halves, quarters, .. of a and of b added up: of all lanes, as far apart as in total() of line_sums.c. */
static inline __m512 halves(__m512 a, __m512 b)
{
    return _mm512_add_ps(_mm512_shuffle_f32x4(a, b, 0x44), _mm512_shuffle_f32x4(a, b, 0xee));
}

static inline __m512 quarters(__m512 a, __m512 b)
{
    return _mm512_add_ps(_mm512_shuffle_f32x4(a, b, 0x88), _mm512_shuffle_f32x4(a, b, 0xdd));
}

static inline __m512 eighths(__m512 a, __m512 b)
{
    const __m512d c = _mm512_castps_pd(a), d = _mm512_castps_pd(b);
    return _mm512_add_ps(_mm512_castpd_ps(_mm512_unpacklo_pd(c, d)), _mm512_castpd_ps(_mm512_unpackhi_pd(c, d)));
}

static inline __m512 last_two(__m512 a, __m512 b)
{
    return _mm512_add_ps(_mm512_shuffle_ps(a, b, 0x88), _mm512_shuffle_ps(a, b, 0xdd));
}

/* All twelve at once: down and up in turns until they are single numbers. */
static inline void total_sums(const lane_sums sides[2], asj_line_sums sums[2])
{
    const lane_sums *down = &sides[0], *up = &sides[1];
    const __m512 first = quarters(halves(down->w, down->xx), halves(up->w, up->xx));
    const __m512 second = quarters(halves(down->x, down->xy), halves(up->x, up->xy));
    const __m512 third = quarters(halves(down->y, down->yy), halves(up->y, up->yy));
    const __m512 all = last_two(eighths(first, second), eighths(third, third)); /* w x y - xx xy yy - w x y .. */
    float list[16];
    _mm512_storeu_ps(list, all);
    for (int i = 0; i < 2; i++)
        sums[i] = (asj_line_sums){list[8 * i],     list[8 * i + 1], list[8 * i + 2],
                                  list[8 * i + 4], list[8 * i + 5], list[8 * i + 6]};
}

/* 16 grey values each of a minus those of b: none is above 32640 (image.h) */
static inline __m512 difference(const uint16_t *a, const uint16_t *b)
{
    const __m256i p = _mm256_loadu_si256((const __m256i *)(const void *)a);
    const __m256i q = _mm256_loadu_si256((const __m256i *)(const void *)b);
    return _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(_mm256_sub_epi16(p, q)));
}

/* To the sums of the lanes in `on`. */
static inline void add_lanes(column_sums *to, __mmask16 on, __m512 w, __m512 wy, __m512 wyy)
{
    to->w = _mm512_mask_add_ps(to->w, on, to->w, w);
    to->y = _mm512_mask_add_ps(to->y, on, to->y, wy);
    to->yy = _mm512_mask_add_ps(to->yy, on, to->yy, wyy);
}

static inline void add_columns(lane_sums *to, const column_sums *columns, __m512 dx)
{
    const __m512 x = _mm512_mul_ps(columns->w, dx);
    to->w = _mm512_add_ps(to->w, columns->w);
    to->x = _mm512_add_ps(to->x, x);
    to->y = _mm512_add_ps(to->y, columns->y);
    to->xx = _mm512_add_ps(to->xx, _mm512_mul_ps(x, dx));
    to->xy = _mm512_add_ps(to->xy, _mm512_mul_ps(columns->y, dx));
    to->yy = _mm512_add_ps(to->yy, columns->yy);
}

/* The 16 columns from `column` on. */
static inline void sum_columns(const asj_frame *frame, const asj_line_band *band, int32_t column, lane_sums sides[2])
{
    const __m512 lane = _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15), zero = _mm512_setzero_ps();
    const __m512 ux = _mm512_set1_ps(band->ux), uy = _mm512_set1_ps(band->uy), middle_y = _mm512_set1_ps(band->middle_y);
    const __m512 at = _mm512_add_ps(_mm512_set1_ps((float)column), lane), dx = _mm512_sub_ps(at, _mm512_set1_ps(band->middle_x));
    const __mmask16 valid = _mm512_cmp_ps_mask(at, _mm512_set1_ps((float)band->right), _CMP_LE_OQ);
    const __m512 t = _mm512_mul_ps(_mm512_set1_ps(band->step_t), dx), s = _mm512_mul_ps(_mm512_set1_ps(band->step_s), dx);
    const __m512 reach_t = _mm512_set1_ps(band->reach_t), reach_s = _mm512_set1_ps(band->reach_s);
    const __m512 first = _mm512_max_ps(_mm512_sub_ps(t, reach_t), _mm512_sub_ps(s, reach_s));
    const __m512 last = _mm512_min_ps(_mm512_add_ps(t, reach_t), _mm512_add_ps(s, reach_s));
    const ptrdiff_t stride = frame->stride;
    int32_t first_row = band->top, last_row = band->bottom;
    if (band->right - band->left >= ASJ_LINE_LANES)
        asj_line_band_rows(band, column, ASJ_LINE_LANES, &first_row, &last_row);
    const uint16_t *p = frame->gray + (band->y + first_row) * stride + band->x + column;
    column_sums up = {zero, zero, zero}, down = up;
    __m512 rows = _mm512_set1_ps((float)first_row);
    for (int32_t row = first_row; row <= last_row; row++, p += stride) {
        const __m512 gx = difference(p + 1, p - 1), gy = difference(p + stride, p - stride);
        const __m512 across = _mm512_sub_ps(_mm512_mul_ps(gy, ux), _mm512_mul_ps(gx, uy));
        const __m512 along = _mm512_add_ps(_mm512_mul_ps(gx, ux), _mm512_mul_ps(gy, uy));
        const __m512 w = _mm512_sub_ps(_mm512_abs_ps(across), _mm512_abs_ps(along)), dy = _mm512_sub_ps(rows, middle_y);
        __mmask16 inside = _mm512_mask_cmp_ps_mask(valid, dy, first, _CMP_GE_OQ);
        inside = _mm512_mask_cmp_ps_mask(inside, dy, last, _CMP_LE_OQ);
        inside = _mm512_mask_cmp_ps_mask(inside, w, zero, _CMP_GT_OQ);
        const __mmask16 is_up = _mm512_cmp_ps_mask(across, zero, _CMP_GT_OQ);
        const __m512 wy = _mm512_mul_ps(w, dy), wyy = _mm512_mul_ps(wy, dy);
        add_lanes(&up, inside & is_up, w, wy, wyy);
        add_lanes(&down, (__mmask16)(inside & ~is_up), w, wy, wyy);
        rows = _mm512_add_ps(rows, _mm512_set1_ps(1));
    }
    add_columns(&sides[0], &down, dx);
    add_columns(&sides[1], &up, dx);
}

static void line_sums_avx512(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2])
{
    const __m512 zero = _mm512_setzero_ps();
    lane_sums sides[2] = {{zero, zero, zero, zero, zero, zero}, {zero, zero, zero, zero, zero, zero}};
    for (int32_t column = band->left; column <= band->right; column += ASJ_LINE_LANES)
        sum_columns(frame, band, column, sides);
    total_sums(sides, sums);
}

/* Two neighbours each at sixteen places. */
static inline __m512i two_at_sixteen(const uint16_t *gray, const int32_t *at)
{
    return _mm512_inserti64x4(_mm512_castsi256_si512(two_at_eight(gray, at)), two_at_eight(gray, at + 8), 1);
}

/* Four neighbours each at eight places, .. */
static inline __m512i four_at_eight(const uint16_t *gray, const int32_t *at)
{
    const __m256i low = _mm256_set_m128i(four_at_two(gray, at[2], at[3]), four_at_two(gray, at[0], at[1]));
    const __m256i high = _mm256_set_m128i(four_at_two(gray, at[6], at[7]), four_at_two(gray, at[4], at[5]));
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}

/* .. and at sixteen: the first two and the last two. */
static inline void four_each(const uint16_t *gray, const int32_t *at, __m512i *first, __m512i *last)
{
    const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    const __m512i low = four_at_eight(gray, at), high = four_at_eight(gray, at + 8);
    *first = _mm512_permutex2var_epi32(low, even, high);
    *last = _mm512_permutex2var_epi32(low, _mm512_add_epi32(even, _mm512_set1_epi32(1)), high);
}

/* As in lines.h, of 16 samples. */
typedef struct sample_places {
    int32_t at[16];
    __m512i weights;
    __m512 low;
} sample_places;

static inline void sample_sixteen(const uint16_t *gray, int32_t stride, const sample_places *places, __m512 *gx, __m512 *gy)
{
    const int32_t *at = places->at;
    const __m512i weights = places->weights;
    const __m512 low = places->low;
    __m512i left0, right0, left1, right1;
    const __m512i above = two_at_sixteen(gray - stride, at), below = two_at_sixteen(gray + 2 * stride, at);
    four_each(gray - 1, at, &left0, &right0);
    four_each(gray + stride - 1, at, &left1, &right1);
    const __m512i middle0 = _mm512_or_si512(_mm512_srli_epi32(left0, 16), _mm512_slli_epi32(right0, 16));
    const __m512i middle1 = _mm512_or_si512(_mm512_srli_epi32(left1, 16), _mm512_slli_epi32(right1, 16));
    const __m512i x0 = _mm512_madd_epi16(_mm512_sub_epi16(right0, left0), weights);
    const __m512i x1 = _mm512_madd_epi16(_mm512_sub_epi16(right1, left1), weights);
    const __m512i y0 = _mm512_madd_epi16(_mm512_sub_epi16(middle1, above), weights);
    const __m512i y1 = _mm512_madd_epi16(_mm512_sub_epi16(below, middle0), weights);
    *gx = _mm512_add_ps(_mm512_cvtepi32_ps(x0), _mm512_mul_ps(low, _mm512_cvtepi32_ps(_mm512_sub_epi32(x1, x0))));
    *gy = _mm512_add_ps(_mm512_cvtepi32_ps(y0), _mm512_mul_ps(low, _mm512_cvtepi32_ps(_mm512_sub_epi32(y1, y0))));
}

static inline __m512i whole_part(__m512 v)
{
    const __m512i whole = _mm512_cvttps_epi32(v);
    const __mmask16 above = _mm512_cmp_ps_mask(_mm512_cvtepi32_ps(whole), v, _CMP_GT_OQ);
    return _mm512_mask_sub_epi32(whole, above, whole, _mm512_set1_epi32(1));
}

/* The samples of these indices, as numbers, each at an offset. */
static inline void find_places(const asj_line_profile *profile, int32_t stride, __m512 index, __m512 offset, sample_places *places)
{
    const __m512 ux = _mm512_set1_ps(profile->ux), uy = _mm512_set1_ps(profile->uy);
    const __m512 t = _mm512_add_ps(_mm512_set1_ps(profile->first), _mm512_mul_ps(index, _mm512_set1_ps(profile->step)));
    const __m512 middle = _mm512_add_ps(_mm512_set1_ps(profile->a), _mm512_mul_ps(_mm512_set1_ps(profile->b), t));
    const __m512 x0 = _mm512_add_ps(_mm512_set1_ps(profile->origin_x), _mm512_mul_ps(t, ux));
    const __m512 y0 = _mm512_add_ps(_mm512_set1_ps(profile->origin_y), _mm512_mul_ps(t, uy));
    const __m512 s = _mm512_add_ps(middle, offset);
    const __m512 x = _mm512_sub_ps(x0, _mm512_mul_ps(s, uy)), y = _mm512_add_ps(y0, _mm512_mul_ps(s, ux));
    const __m512i ix = whole_part(x), iy = whole_part(y);
    const __m512 part = _mm512_sub_ps(x, _mm512_cvtepi32_ps(ix));
    const __m512i right = _mm512_cvttps_epi32(_mm512_mul_ps(part, _mm512_set1_ps(4096.0f)));
    _mm512_storeu_si512(places->at, _mm512_add_epi32(_mm512_mullo_epi32(iy, _mm512_set1_epi32(stride)), ix));
    places->weights = _mm512_or_si512(_mm512_sub_epi32(_mm512_set1_epi32(4096), right), _mm512_slli_epi32(right, 16));
    places->low = _mm512_sub_ps(y, _mm512_cvtepi32_ps(iy));
}

/* Weights of 16 samples; *across: their gradients along n. */
static inline __m512 sample_weights(const uint16_t *gray, int32_t stride, const sample_places *places, __m512 ux, __m512 uy,
                                    __m512 *across)
{
    __m512 gx, gy;
    sample_sixteen(gray, stride, places, &gx, &gy);
    const __m512 along = _mm512_add_ps(_mm512_mul_ps(gx, ux), _mm512_mul_ps(gy, uy));
    *across = _mm512_sub_ps(_mm512_mul_ps(gy, ux), _mm512_mul_ps(gx, uy));
    return _mm512_max_ps(_mm512_sub_ps(_mm512_abs_ps(*across), _mm512_abs_ps(along)), _mm512_setzero_ps());
}

/* Samples k .. k + 15 of a profile, those past its end like the last. Places first: see lines.h. */
static inline void profile_sixteen(const asj_frame *frame, const asj_line_profile *profile, int32_t k, asj_profile_sums *sums)
{
    const __m512 zero = _mm512_setzero_ps(), ux = _mm512_set1_ps(profile->ux), uy = _mm512_set1_ps(profile->uy);
    const __m512 lane = _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const int32_t stride = (int32_t)frame->stride;
    const uint16_t *gray = frame->gray + profile->y * frame->stride + profile->x;
    const __m512 last = _mm512_set1_ps((float)(profile->count - 1));
    const __m512 index = _mm512_min_ps(_mm512_add_ps(_mm512_set1_ps((float)k), lane), last);
    __m512 up = zero, down = zero, up_moment = zero, down_moment = zero;
    sample_places places[ASJ_PROFILE_OFFSETS];
    for (int32_t i = 0; i < profile->offsets; i++)
        find_places(profile, stride, index, _mm512_set1_ps(profile->offset[i]), &places[i]);
    for (int32_t i = 0; i < profile->offsets; i++) {
        __m512 across;
        const __m512 w = sample_weights(gray, stride, &places[i], ux, uy, &across);
        const __m512 moment = _mm512_mul_ps(w, _mm512_set1_ps(profile->offset[i]));
        const __mmask16 is_up = _mm512_cmp_ps_mask(across, zero, _CMP_GT_OQ), is_down = (__mmask16)~is_up;
        up = _mm512_mask_add_ps(up, is_up, up, w);
        down = _mm512_mask_add_ps(down, is_down, down, w);
        up_moment = _mm512_mask_add_ps(up_moment, is_up, up_moment, moment);
        down_moment = _mm512_mask_add_ps(down_moment, is_down, down_moment, moment);
    }
    _mm512_storeu_ps(sums->w[0] + k, down);
    _mm512_storeu_ps(sums->w[1] + k, up);
    _mm512_storeu_ps(sums->moment[0] + k, down_moment);
    _mm512_storeu_ps(sums->moment[1] + k, up_moment);
}

/* Those of a profile of at most 16 samples at all offsets, one after the other in the lanes; returns how many vectors they fill. */
static inline int32_t find_all_places(const asj_line_profile *profile, int32_t stride, sample_places *places)
{
    const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const int32_t count = profile->count, all = count * profile->offsets;
    const __m512 offsets = _mm512_maskz_loadu_ps((__mmask16)((1 << ASJ_PROFILE_OFFSETS) - 1), profile->offset);
    const int32_t inverse = 65536 / count + 1; /* number / count = number inverse >> 16 up to 16 ASJ_PROFILE_OFFSETS */
    int32_t vectors = 0;
    for (int32_t first = 0; first < all; first += 16, vectors++) {
        const __m512i number = _mm512_min_epi32(_mm512_add_epi32(_mm512_set1_epi32(first), lane), _mm512_set1_epi32(all - 1));
        const __m512i i = _mm512_srli_epi32(_mm512_mullo_epi32(number, _mm512_set1_epi32(inverse)), 16);
        const __m512 index = _mm512_cvtepi32_ps(_mm512_sub_epi32(number, _mm512_mullo_epi32(i, _mm512_set1_epi32(count))));
        find_places(profile, stride, index, _mm512_permutexvar_ps(i, offsets), &places[vectors]);
    }
    return vectors;
}

/* Such a profile: first fits have nine, and each offset for itself would leave half of the lanes without work. */
static inline void profile_short(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums)
{
    const __m512 zero = _mm512_setzero_ps(), ux = _mm512_set1_ps(profile->ux), uy = _mm512_set1_ps(profile->uy);
    const int32_t stride = (int32_t)frame->stride, count = profile->count;
    const uint16_t *gray = frame->gray + profile->y * frame->stride + profile->x;
    float weights[16 * ASJ_PROFILE_OFFSETS + 16]; /* negative where the gradient points along -n */
    sample_places places[ASJ_PROFILE_OFFSETS];
    const int32_t vectors = find_all_places(profile, stride, places);
    for (int32_t v = 0; v < vectors; v++) {
        __m512 across;
        const __m512 w = sample_weights(gray, stride, &places[v], ux, uy, &across);
        const __mmask16 is_down = _mm512_cmp_ps_mask(across, zero, _CMP_LE_OQ);
        _mm512_storeu_ps(weights + 16 * v, _mm512_mask_sub_ps(w, is_down, zero, w));
    }
    __m512 up = zero, down = zero, up_moment = zero, down_moment = zero;
    for (int32_t i = 0; i < profile->offsets; i++) {
        const __m512 w = _mm512_loadu_ps(weights + i * count), offset = _mm512_set1_ps(profile->offset[i]);
        const __m512 is_up = _mm512_max_ps(w, zero), is_down = _mm512_max_ps(_mm512_sub_ps(zero, w), zero);
        up = _mm512_add_ps(up, is_up);
        down = _mm512_add_ps(down, is_down);
        up_moment = _mm512_add_ps(up_moment, _mm512_mul_ps(is_up, offset));
        down_moment = _mm512_add_ps(down_moment, _mm512_mul_ps(is_down, offset));
    }
    _mm512_storeu_ps(sums->w[0], down);
    _mm512_storeu_ps(sums->w[1], up);
    _mm512_storeu_ps(sums->moment[0], down_moment);
    _mm512_storeu_ps(sums->moment[1], up_moment);
}

/* As total_profile() of line_sums.c. */
static inline void total_profile(int32_t count, asj_profile_sums *sums)
{
    const __m512 zero = _mm512_setzero_ps();
    lane_sums sides[2] = {{zero, zero, zero, zero, zero, zero}, {zero, zero, zero, zero, zero, zero}};
    asj_line_sums list[2];
    sums->counts[0] = sums->counts[1] = 0;
    __m512 at = _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (int32_t k = 0; k < count; k += ASJ_LINE_LANES) {
        const __mmask16 valid = (__mmask16)(count - k < ASJ_LINE_LANES ? (1 << (count - k)) - 1 : 0xffff);
        for (int i = 0; i < 2; i++) {
            const __m512 w = _mm512_maskz_loadu_ps(valid, sums->w[i] + k), r = _mm512_maskz_loadu_ps(valid, sums->moment[i] + k);
            const __m512 weighted = _mm512_mul_ps(w, at);
            sums->counts[i] += __builtin_popcount(_mm512_cmp_ps_mask(w, zero, _CMP_GT_OQ));
            sides[i].w = _mm512_add_ps(sides[i].w, w);
            sides[i].x = _mm512_add_ps(sides[i].x, weighted);
            sides[i].xx = _mm512_add_ps(sides[i].xx, _mm512_mul_ps(weighted, at));
            sides[i].y = _mm512_add_ps(sides[i].y, r);
            sides[i].xy = _mm512_add_ps(sides[i].xy, _mm512_mul_ps(r, at));
        }
        at = _mm512_add_ps(at, _mm512_set1_ps(ASJ_LINE_LANES));
    }
    total_sums(sides, list);
    for (int i = 0; i < 2; i++)
        sums->totals[i] = (struct asj_profile_totals){list[i].w, list[i].x, list[i].xx, list[i].y, list[i].xy};
}

static void line_profile_avx512(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums)
{
    const int32_t lanes = ASJ_LINE_LANES;
    const int whole = asj_line_profile_inside(frame, profile, 0, profile->count);
    if (whole && frame->stride <= 30000 && profile->count <= lanes) {
        profile_short(frame, profile, sums);
        total_profile(profile->count, sums);
        return;
    }
    for (int32_t k = 0; k < profile->count; k += lanes) {
        const int32_t to = k + lanes < profile->count ? k + lanes : profile->count;
        if (frame->stride > 30000 || (!whole && !asj_line_profile_inside(frame, profile, k, to))) /* indices stay below 2^31 */
            asj_line_profile_part(frame, profile, k, to, sums);
        else
            profile_sixteen(frame, profile, k, sums);
    }
    total_profile(profile->count, sums);
}

#endif
