/* SPDX-License-Identifier: BSD-2-Clause */
/* Sums over the pixels of a band: names as in the reference, line_sums.c. */
#ifndef ASJ_SRC_X86_LINES_H
#define ASJ_SRC_X86_LINES_H

#include "detect/line_sums.h"
#include "loads.h"

#include <immintrin.h>
#include <math.h>

typedef struct lane_sums {
    __m256 w, x, y, xx, xy, yy;
} lane_sums;

/* Of 8 columns while their rows are walked along: sums of w, w y, w y^2. */
typedef struct column_sums {
    __m256 w, y, yy;
} column_sums;

/* Neighbouring halves, quarters, .. of a and of b added up: of all lanes, as far apart as in total() of line_sums.c. */
static inline __m256 halves(__m256 a, __m256 b)
{
    return _mm256_add_ps(_mm256_permute2f128_ps(a, b, 0x20), _mm256_permute2f128_ps(a, b, 0x31));
}

static inline __m256 quarters(__m256 a, __m256 b)
{
    const __m256d c = _mm256_castps_pd(a), d = _mm256_castps_pd(b);
    return _mm256_add_ps(_mm256_castpd_ps(_mm256_unpacklo_pd(c, d)), _mm256_castpd_ps(_mm256_unpackhi_pd(c, d)));
}

static inline __m256 last_two(__m256 a, __m256 b)
{
    return _mm256_add_ps(_mm256_shuffle_ps(a, b, 0x88), _mm256_shuffle_ps(a, b, 0xdd));
}

/* All six at once, of both halves of the lanes. */
static inline asj_line_sums total_sums(const lane_sums *low, const lane_sums *high)
{
    const __m256 w = _mm256_add_ps(low->w, high->w), xx = _mm256_add_ps(low->xx, high->xx);
    const __m256 x = _mm256_add_ps(low->x, high->x), xy = _mm256_add_ps(low->xy, high->xy);
    const __m256 y = _mm256_add_ps(low->y, high->y), yy = _mm256_add_ps(low->yy, high->yy), third = halves(y, yy);
    float list[8];
    _mm256_storeu_ps(list, last_two(quarters(halves(w, xx), halves(x, xy)), quarters(third, third))); /* w x y - xx xy yy */
    return (asj_line_sums){list[0], list[1], list[2], list[4], list[5], list[6]};
}

/* 8 grey values each of a minus those of b: none is above 32640 (image.h) */
static inline __m256 difference(const uint16_t *a, const uint16_t *b)
{
    const __m128i p = _mm_loadu_si128((const __m128i *)(const void *)a), q = _mm_loadu_si128((const __m128i *)(const void *)b);
    return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_sub_epi16(p, q)));
}

static inline void add_lanes(column_sums *to, __m256 w, __m256 dy)
{
    const __m256 y = _mm256_mul_ps(w, dy);
    to->w = _mm256_add_ps(to->w, w);
    to->y = _mm256_add_ps(to->y, y);
    to->yy = _mm256_add_ps(to->yy, _mm256_mul_ps(y, dy));
}

static inline void add_columns(lane_sums *to, const column_sums *columns, __m256 dx)
{
    const __m256 x = _mm256_mul_ps(columns->w, dx);
    to->w = _mm256_add_ps(to->w, columns->w);
    to->x = _mm256_add_ps(to->x, x);
    to->y = _mm256_add_ps(to->y, columns->y);
    to->xx = _mm256_add_ps(to->xx, _mm256_mul_ps(x, dx));
    to->xy = _mm256_add_ps(to->xy, _mm256_mul_ps(columns->y, dx));
    to->yy = _mm256_add_ps(to->yy, columns->yy);
}

/* The 8 columns from `column` on. */
static inline void sum_columns(const asj_frame *frame, const asj_line_band *band, int32_t column, lane_sums sides[2])
{
    const __m256 zero = _mm256_setzero_ps(), sign = _mm256_set1_ps(-0.0f), lane = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256 ux = _mm256_set1_ps(band->ux), uy = _mm256_set1_ps(band->uy);
    const __m256 at = _mm256_add_ps(_mm256_set1_ps((float)column), lane), dx = _mm256_sub_ps(at, _mm256_set1_ps(band->middle_x));
    const __m256 valid = _mm256_cmp_ps(at, _mm256_set1_ps((float)band->right), _CMP_LE_OQ);
    const __m256 t = _mm256_mul_ps(_mm256_set1_ps(band->step_t), dx), s = _mm256_mul_ps(_mm256_set1_ps(band->step_s), dx);
    const __m256 reach_t = _mm256_set1_ps(band->reach_t), reach_s = _mm256_set1_ps(band->reach_s);
    const __m256 earliest = _mm256_max_ps(_mm256_sub_ps(t, reach_t), _mm256_sub_ps(s, reach_s));
    const __m256 first = _mm256_blendv_ps(_mm256_set1_ps(HUGE_VALF), earliest, valid); /* no row of what is no column */
    const __m256 last = _mm256_min_ps(_mm256_add_ps(t, reach_t), _mm256_add_ps(s, reach_s));
    const ptrdiff_t stride = frame->stride;
    int32_t first_row, last_row;
    asj_line_band_rows(band, column, 8, &first_row, &last_row);
    const uint16_t *p = frame->gray + (band->y + first_row) * stride + band->x + column;
    column_sums up = {zero, zero, zero}, down = up;
    for (int32_t row = first_row; row <= last_row; row++, p += stride) {
        const __m256 gx = difference(p + 1, p - 1), gy = difference(p + stride, p - stride);
        const __m256 across = _mm256_sub_ps(_mm256_mul_ps(gy, ux), _mm256_mul_ps(gx, uy));
        const __m256 along = _mm256_add_ps(_mm256_mul_ps(gx, ux), _mm256_mul_ps(gy, uy));
        const __m256 dy = _mm256_set1_ps((float)row - band->middle_y), is_up = _mm256_cmp_ps(across, zero, _CMP_GT_OQ);
        const __m256 inside = _mm256_and_ps(_mm256_cmp_ps(dy, first, _CMP_GE_OQ), _mm256_cmp_ps(dy, last, _CMP_LE_OQ));
        __m256 w = _mm256_sub_ps(_mm256_andnot_ps(sign, across), _mm256_andnot_ps(sign, along));
        w = _mm256_and_ps(_mm256_max_ps(w, zero), inside);
        add_lanes(&up, _mm256_and_ps(w, is_up), dy);
        add_lanes(&down, _mm256_andnot_ps(is_up, w), dy);
    }
    add_columns(&sides[0], &down, dx);
    add_columns(&sides[1], &up, dx);
}

static void line_sums_avx2(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2])
{
    const __m256 zero = _mm256_setzero_ps();
    const lane_sums none = {zero, zero, zero, zero, zero, zero};
    lane_sums low[2] = {none, none}, high[2] = {none, none};
    for (int32_t column = band->left; column <= band->right; column += ASJ_LINE_LANES) {
        sum_columns(frame, band, column, low);
        if (column + 8 <= band->right)
            sum_columns(frame, band, column + 8, high);
    }
    for (int i = 0; i < 2; i++)
        sums[i] = total_sums(&low[i], &high[i]);
}

/* Four neighbours each at eight places: the first two of each, and the others; halves of vectors in such an order that both come
 * out in theirs. */
static inline void four_each(const uint16_t *gray, const int32_t *at, __m256i *first, __m256i *second)
{
    const __m256 a = _mm256_castsi256_ps(_mm256_set_m128i(four_at_two(gray, at[4], at[5]), four_at_two(gray, at[0], at[1])));
    const __m256 b = _mm256_castsi256_ps(_mm256_set_m128i(four_at_two(gray, at[6], at[7]), four_at_two(gray, at[2], at[3])));
    *first = _mm256_castps_si256(_mm256_shuffle_ps(a, b, 0x88));
    *second = _mm256_castps_si256(_mm256_shuffle_ps(a, b, 0xdd));
}

/* Where 8 samples are: the upper left one of the four pixels around each, and the weights of left and right ones, in 1/4096 and 16
 * bits each, and of lower ones. */
typedef struct sample_places {
    int32_t at[8];
    __m256i weights;
    __m256 low;
} sample_places;

/* Central differences at the four pixels around 8 samples, bilinear. */
static inline void sample_eight(const uint16_t *gray, int32_t stride, const sample_places *places, __m256 *gx, __m256 *gy)
{
    const int32_t *at = places->at;
    const __m256i weights = places->weights;
    __m256i left0, right0, left1, right1;
    const __m256i above = two_at_eight(gray - stride, at), below = two_at_eight(gray + 2 * stride, at);
    four_each(gray - 1, at, &left0, &right0);
    four_each(gray + stride - 1, at, &left1, &right1);
    const __m256i middle0 = _mm256_or_si256(_mm256_srli_epi32(left0, 16), _mm256_slli_epi32(right0, 16));
    const __m256i middle1 = _mm256_or_si256(_mm256_srli_epi32(left1, 16), _mm256_slli_epi32(right1, 16));
    const __m256i x0 = _mm256_madd_epi16(_mm256_sub_epi16(right0, left0), weights);
    const __m256i x1 = _mm256_madd_epi16(_mm256_sub_epi16(right1, left1), weights);
    const __m256i y0 = _mm256_madd_epi16(_mm256_sub_epi16(middle1, above), weights);
    const __m256i y1 = _mm256_madd_epi16(_mm256_sub_epi16(below, middle0), weights);
    const __m256 low = places->low;
    *gx = _mm256_add_ps(_mm256_cvtepi32_ps(x0), _mm256_mul_ps(low, _mm256_cvtepi32_ps(_mm256_sub_epi32(x1, x0))));
    *gy = _mm256_add_ps(_mm256_cvtepi32_ps(y0), _mm256_mul_ps(low, _mm256_cvtepi32_ps(_mm256_sub_epi32(y1, y0))));
}

static inline __m256i whole_part(__m256 v)
{
    const __m256i whole = _mm256_cvttps_epi32(v);
    return _mm256_add_epi32(whole, _mm256_castps_si256(_mm256_cmp_ps(_mm256_cvtepi32_ps(whole), v, _CMP_GT_OQ)));
}

/* As total_profile() of line_sums.c. */
static inline void total_profile(int32_t count, int32_t side, asj_profile_sums *sums)
{
    const __m256 zero = _mm256_setzero_ps(), lane = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    lane_sums parts[2] = {{zero, zero, zero, zero, zero, zero}, {zero, zero, zero, zero, zero, zero}};
    sums->counts[side] = 0;
    for (int32_t k = 0; k < count; k += 8) {
        lane_sums *part = &parts[k / 8 % 2];
        const __m256 at = _mm256_add_ps(_mm256_set1_ps((float)k), lane);
        const __m256 valid = _mm256_cmp_ps(at, _mm256_set1_ps((float)count), _CMP_LT_OQ);
        const __m256 w = _mm256_and_ps(valid, _mm256_loadu_ps(sums->w[side] + k)), weighted = _mm256_mul_ps(w, at);
        const __m256 r = _mm256_and_ps(valid, _mm256_loadu_ps(sums->moment[side] + k));
        sums->counts[side] += __builtin_popcount((unsigned)_mm256_movemask_ps(_mm256_cmp_ps(w, zero, _CMP_GT_OQ)));
        part->w = _mm256_add_ps(part->w, w);
        part->x = _mm256_add_ps(part->x, weighted);
        part->xx = _mm256_add_ps(part->xx, _mm256_mul_ps(weighted, at));
        part->y = _mm256_add_ps(part->y, r);
        part->xy = _mm256_add_ps(part->xy, _mm256_mul_ps(r, at));
    }
    const asj_line_sums all = total_sums(&parts[0], &parts[1]);
    sums->totals[side] = (struct asj_profile_totals){all.w, all.x, all.xx, all.y, all.xy};
}

/* Samples k .. k + 7 at each offset, those past the end like the last. */
static inline void find_places(const asj_line_profile *profile, int32_t stride, int32_t k, sample_places *places)
{
    const __m256 lane = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7), last = _mm256_set1_ps((float)(profile->count - 1));
    const __m256 ux = _mm256_set1_ps(profile->ux), uy = _mm256_set1_ps(profile->uy);
    const __m256 index = _mm256_min_ps(_mm256_add_ps(_mm256_set1_ps((float)k), lane), last);
    const __m256 t = _mm256_add_ps(_mm256_set1_ps(profile->first), _mm256_mul_ps(index, _mm256_set1_ps(profile->step)));
    const __m256 middle = _mm256_add_ps(_mm256_set1_ps(profile->a), _mm256_mul_ps(_mm256_set1_ps(profile->b), t));
    const __m256 x0 = _mm256_add_ps(_mm256_set1_ps(profile->origin_x), _mm256_mul_ps(t, ux));
    const __m256 y0 = _mm256_add_ps(_mm256_set1_ps(profile->origin_y), _mm256_mul_ps(t, uy));
    for (int32_t i = 0; i < profile->offsets; i++, places++) {
        const __m256 s = _mm256_add_ps(middle, _mm256_set1_ps(profile->offset[i]));
        const __m256 x = _mm256_sub_ps(x0, _mm256_mul_ps(s, uy)), y = _mm256_add_ps(y0, _mm256_mul_ps(s, ux));
        const __m256i ix = whole_part(x), iy = whole_part(y);
        const __m256 part = _mm256_sub_ps(x, _mm256_cvtepi32_ps(ix));
        const __m256i right = _mm256_cvttps_epi32(_mm256_mul_ps(part, _mm256_set1_ps(4096.0f)));
        const __m256i at = _mm256_add_epi32(_mm256_mullo_epi32(iy, _mm256_set1_epi32(stride)), ix);
        _mm256_storeu_si256((__m256i *)(void *)places->at, at);
        places->weights = _mm256_or_si256(_mm256_sub_epi32(_mm256_set1_epi32(4096), right), _mm256_slli_epi32(right, 16));
        places->low = _mm256_sub_ps(y, _mm256_cvtepi32_ps(iy));
    }
}

/* All places are found before anything is read there: from a place to what is added up are a hundred cycles, and processors, which
 * look a few hundred operations ahead, have more samples under way so. */
static void line_profile_avx2(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums)
{
    const __m256 zero = _mm256_setzero_ps(), sign = _mm256_set1_ps(-0.0f);
    const __m256 ux = _mm256_set1_ps(profile->ux), uy = _mm256_set1_ps(profile->uy);
    const int32_t stride = (int32_t)frame->stride;
    const uint16_t *gray = frame->gray + profile->y * frame->stride + profile->x;
    const int whole = asj_line_profile_inside(frame, profile, 0, profile->count);
    sample_places places[ASJ_PROFILE_OFFSETS];
    for (int32_t k = 0; k < profile->count; k += 8) {
        const int32_t to = k + 8 < profile->count ? k + 8 : profile->count;
        if (frame->stride > 30000 || (!whole && !asj_line_profile_inside(frame, profile, k, to))) { /* indices stay below 2^31 */
            asj_line_profile_part(frame, profile, k, to, sums);
            continue;
        }
        __m256 up = zero, down = zero, up_moment = zero, down_moment = zero;
        find_places(profile, stride, k, places);
        for (int32_t i = 0; i < profile->offsets; i++) {
            const __m256 offset = _mm256_set1_ps(profile->offset[i]);
            __m256 gx, gy;
            sample_eight(gray, stride, &places[i], &gx, &gy);
            const __m256 across = _mm256_sub_ps(_mm256_mul_ps(gy, ux), _mm256_mul_ps(gx, uy));
            const __m256 along = _mm256_add_ps(_mm256_mul_ps(gx, ux), _mm256_mul_ps(gy, uy));
            const __m256 w = _mm256_max_ps(_mm256_sub_ps(_mm256_andnot_ps(sign, across), _mm256_andnot_ps(sign, along)), zero);
            const __m256 is_up = _mm256_cmp_ps(across, zero, _CMP_GT_OQ);
            const __m256 w_up = _mm256_and_ps(w, is_up), w_down = _mm256_andnot_ps(is_up, w);
            up = _mm256_add_ps(up, w_up);
            down = _mm256_add_ps(down, w_down);
            up_moment = _mm256_add_ps(up_moment, _mm256_mul_ps(w_up, offset));
            down_moment = _mm256_add_ps(down_moment, _mm256_mul_ps(w_down, offset));
        }
        _mm256_storeu_ps(sums->w[0] + k, down);
        _mm256_storeu_ps(sums->w[1] + k, up);
        _mm256_storeu_ps(sums->moment[0] + k, down_moment);
        _mm256_storeu_ps(sums->moment[1] + k, up_moment);
    }
    for (int32_t side = 0; side < 2; side++)
        total_profile(profile->count, side, sums);
}

#endif
