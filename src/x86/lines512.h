/* SPDX-License-Identifier: BSD-2-Clause */
/* As lines.h, for 16 lanes. Only avx512.c includes this. */
#ifndef ASJ_SRC_X86_LINES512_H
#define ASJ_SRC_X86_LINES512_H

#include "../ops.h"

typedef struct lane_sums {
    __m512 w, t, tt, s, ts;
} lane_sums;

/* To the sums of the lanes in `on`. */
static inline void add_lanes(lane_sums *to, __mmask16 on, __m512 w, __m512 wt, __m512 wtt, __m512 ws, __m512 wts)
{
    to->w = _mm512_mask_add_ps(to->w, on, to->w, w);
    to->t = _mm512_mask_add_ps(to->t, on, to->t, wt);
    to->tt = _mm512_mask_add_ps(to->tt, on, to->tt, wtt);
    to->s = _mm512_mask_add_ps(to->s, on, to->s, ws);
    to->ts = _mm512_mask_add_ps(to->ts, on, to->ts, wts);
}

/* The lower lanes are those of even rows, the higher ones of odd rows. */
static inline float total(__m512 v)
{
    const __m256 high = _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(v), 1));
    const __m256 eight = _mm256_add_ps(_mm512_castps512_ps256(v), high);
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
    const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}

static inline asj_line_sums total_sums(const lane_sums *list)
{
    return (asj_line_sums){total(list->w), total(list->t), total(list->tt), total(list->s), total(list->ts)};
}

/* 8 grey values each at two places: none is above 32640 (image.h) */
static inline __m256i grey(const uint16_t *even, const uint16_t *odd)
{
    return _mm256_loadu2_m128i((const __m128i *)(const void *)odd, (const __m128i *)(const void *)even);
}

static inline __m512 halves(float even, float odd)
{
    const __m512d low = _mm512_castps_pd(_mm512_set1_ps(even));
    return _mm512_castpd_ps(_mm512_insertf64x4(low, _mm256_castps_pd(_mm256_set1_ps(odd)), 1));
}

static inline __m512 difference(__m256i a, __m256i b)
{
    return _mm512_cvtepi32_ps(_mm512_cvtepi16_epi32(_mm256_sub_epi16(a, b)));
}

/* A row of the band as far as it has been walked along. */
typedef struct band_row {
    const uint16_t *pixels;
    int32_t column, last;
} band_row;

/* Two rows at once; lanes of one that is at its end add nothing. */
static inline void add_two_rows(const asj_frame *frame, const asj_line_band *band, int32_t row, band_row even, band_row odd,
                                lane_sums *down, lane_sums *up)
{
    const __m512 lane = _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7);
    const __m512 ux = _mm512_set1_ps(band->ux), uy = _mm512_set1_ps(band->uy), zero = _mm512_setzero_ps();
    const float dy = (float)row - band->origin_y, next = (float)(row + 1) - band->origin_y;
    const __m512 row_t = halves(dy * band->uy, next * band->uy), row_s = halves(dy * band->ux, next * band->ux);
    const __m512 end = halves((float)even.last, (float)odd.last);
    const ptrdiff_t stride = frame->stride;
    for (; even.column <= even.last || odd.column <= odd.last; even.column += ASJ_LINE_LANES, odd.column += ASJ_LINE_LANES) {
        even.column = even.column <= even.last ? even.column : even.last + 1;
        odd.column = odd.column <= odd.last ? odd.column : odd.last + 1;
        const __m512 at = _mm512_add_ps(halves((float)even.column, (float)odd.column), lane);
        const __m512 dx = _mm512_sub_ps(at, _mm512_set1_ps(band->origin_x));
        const __m512 t = _mm512_add_ps(row_t, _mm512_mul_ps(dx, ux)), s = _mm512_sub_ps(row_s, _mm512_mul_ps(dx, uy));
        __mmask16 inside = _mm512_cmp_ps_mask(at, end, _CMP_LE_OQ);
        inside = _mm512_mask_cmp_ps_mask(inside, t, _mm512_set1_ps(band->first), _CMP_GE_OQ);
        inside = _mm512_mask_cmp_ps_mask(inside, t, _mm512_set1_ps(band->last), _CMP_LE_OQ);
        inside = _mm512_mask_cmp_ps_mask(inside, s, _mm512_set1_ps(band->low), _CMP_GE_OQ);
        inside = _mm512_mask_cmp_ps_mask(inside, s, _mm512_set1_ps(band->high), _CMP_LE_OQ);
        const uint16_t *p = even.pixels + even.column, *q = odd.pixels + odd.column;
        const __m512 gx = difference(grey(p + 1, q + 1), grey(p - 1, q - 1));
        const __m512 gy = difference(grey(p + stride, q + stride), grey(p - stride, q - stride));
        const __m512 across = _mm512_sub_ps(_mm512_mul_ps(gy, ux), _mm512_mul_ps(gx, uy));
        const __m512 along = _mm512_add_ps(_mm512_mul_ps(gx, ux), _mm512_mul_ps(gy, uy));
        const __m512 w = _mm512_sub_ps(_mm512_abs_ps(across), _mm512_abs_ps(along));
        inside = _mm512_mask_cmp_ps_mask(inside, w, zero, _CMP_GT_OQ);
        const __mmask16 is_up = _mm512_cmp_ps_mask(across, zero, _CMP_GT_OQ);
        const __m512 wt = _mm512_mul_ps(w, t), wtt = _mm512_mul_ps(wt, t), ws = _mm512_mul_ps(w, s), wts = _mm512_mul_ps(wt, s);
        add_lanes(up, inside & is_up, w, wt, wtt, ws, wts);
        add_lanes(down, (__mmask16)(inside & ~is_up), w, wt, wtt, ws, wts);
    }
}

static void line_sums_avx512(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2])
{
    const __m512 zero = _mm512_setzero_ps();
    lane_sums up = {zero, zero, zero, zero, zero}, down = up;
    for (int32_t row = band->top; row <= band->bottom; row += 2) {
        band_row even, odd;
        even.pixels = frame->gray + (band->y + row) * frame->stride + band->x;
        asj_line_band_row(band, row, &even.column, &even.last);
        odd = even;
        odd.column = odd.last + 1;
        if (row < band->bottom) {
            odd.pixels += frame->stride;
            asj_line_band_row(band, row + 1, &odd.column, &odd.last);
        }
        add_two_rows(frame, band, row, even, odd, &down, &up);
    }
    sums[0] = total_sums(&down);
    sums[1] = total_sums(&up);
}

/* As in lines.h. */
static inline void sample_sixteen(const uint16_t *gray, int32_t stride, __m512i at, __m512i right, __m512 low, __m512 *gx,
                                  __m512 *gy)
{
#define PAIRS(offset) _mm512_i32gather_epi32(_mm512_add_epi32(at, _mm512_set1_epi32(offset)), (const void *)gray, 2)
    const __m512i above = PAIRS(-stride), below = PAIRS(2 * stride);
    const __m512i left0 = PAIRS(-1), right0 = PAIRS(1), left1 = PAIRS(stride - 1), right1 = PAIRS(stride + 1);
#undef PAIRS
    const __m512i middle0 = _mm512_or_si512(_mm512_srli_epi32(left0, 16), _mm512_slli_epi32(right0, 16));
    const __m512i middle1 = _mm512_or_si512(_mm512_srli_epi32(left1, 16), _mm512_slli_epi32(right1, 16));
    const __m512i weights = _mm512_or_si512(_mm512_sub_epi32(_mm512_set1_epi32(4096), right), _mm512_slli_epi32(right, 16));
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

/* Samples k .. k + 15 of a profile, those past its end like the last. */
static inline void profile_sixteen(const asj_frame *frame, const asj_line_profile *profile, int32_t k, asj_profile_sums *sums)
{
    const __m512 zero = _mm512_setzero_ps(), ux = _mm512_set1_ps(profile->ux), uy = _mm512_set1_ps(profile->uy);
    const __m512 lane = _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const int32_t stride = (int32_t)frame->stride;
    const uint16_t *gray = frame->gray + profile->y * frame->stride + profile->x;
    const __m512 last = _mm512_set1_ps((float)(profile->count - 1));
    const __m512 index = _mm512_min_ps(_mm512_add_ps(_mm512_set1_ps((float)k), lane), last);
    const __m512 t = _mm512_add_ps(_mm512_set1_ps(profile->first), _mm512_mul_ps(index, _mm512_set1_ps(profile->step)));
    const __m512 middle = _mm512_add_ps(_mm512_set1_ps(profile->a), _mm512_mul_ps(_mm512_set1_ps(profile->b), t));
    const __m512 x0 = _mm512_add_ps(_mm512_set1_ps(profile->origin_x), _mm512_mul_ps(t, ux));
    const __m512 y0 = _mm512_add_ps(_mm512_set1_ps(profile->origin_y), _mm512_mul_ps(t, uy));
    __m512 up = zero, down = zero, up_moment = zero, down_moment = zero;
    for (int32_t i = 0; i < profile->offsets; i++) {
        const __m512 offset = _mm512_set1_ps(profile->offset[i]), s = _mm512_add_ps(middle, offset);
        const __m512 x = _mm512_sub_ps(x0, _mm512_mul_ps(s, uy)), y = _mm512_add_ps(y0, _mm512_mul_ps(s, ux));
        const __m512i ix = whole_part(x), iy = whole_part(y);
        const __m512 part = _mm512_sub_ps(x, _mm512_cvtepi32_ps(ix)), low = _mm512_sub_ps(y, _mm512_cvtepi32_ps(iy));
        const __m512i right = _mm512_cvttps_epi32(_mm512_mul_ps(part, _mm512_set1_ps(4096.0f)));
        const __m512i at = _mm512_add_epi32(_mm512_mullo_epi32(iy, _mm512_set1_epi32(stride)), ix);
        __m512 gx, gy;
        sample_sixteen(gray, stride, at, right, low, &gx, &gy);
        const __m512 across = _mm512_sub_ps(_mm512_mul_ps(gy, ux), _mm512_mul_ps(gx, uy));
        const __m512 along = _mm512_add_ps(_mm512_mul_ps(gx, ux), _mm512_mul_ps(gy, uy));
        const __m512 w = _mm512_max_ps(_mm512_sub_ps(_mm512_abs_ps(across), _mm512_abs_ps(along)), zero);
        const __m512 moment = _mm512_mul_ps(w, offset);
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

static void line_profile_avx512(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums)
{
    const int32_t lanes = 2 * ASJ_LINE_LANES;
    const int whole = asj_line_profile_inside(frame, profile, 0, profile->count);
    for (int32_t k = 0; k < profile->count; k += lanes) {
        const int32_t to = k + lanes < profile->count ? k + lanes : profile->count;
        if (frame->stride > 30000 || (!whole && !asj_line_profile_inside(frame, profile, k, to))) /* indices stay below 2^31 */
            asj_line_profile_part(frame, profile, k, to, sums);
        else
            profile_sixteen(frame, profile, k, sums);
    }
}

static void fill_lines(asj_ops *ops)
{
    ops->line_sums = line_sums_avx512;
    ops->line_profile = line_profile_avx512;
}

#endif
