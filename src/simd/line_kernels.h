/* SPDX-License-Identifier: BSD-2-Clause */
/* Sums over the pixels of a band in vectors of four floats, for instruction sets of 128 bits: names as in the reference,
 * line_sums.c. Written with the vector types that gcc and clang have for any processor; include the vectors of 128 bits first. */
#ifndef ASJ_SRC_SIMD_LINE_KERNELS_H
#define ASJ_SRC_SIMD_LINE_KERNELS_H

#include "detect/line_sums.h"

#include <string.h>

#define FOURS (ASJ_LINE_LANES / 4) /* vectors that hold the lanes of the reference */

typedef float floats __attribute__((vector_size(16)));
typedef int32_t ints __attribute__((vector_size(16)));
typedef int16_t shorts __attribute__((vector_size(16)));
typedef uint32_t unsigned_ints __attribute__((vector_size(16)));
typedef uint64_t fours __attribute__((vector_size(16))); /* of 16 bits */

typedef struct lane_sums {
    floats w, x, y, xx, xy, yy;
} lane_sums;

static inline floats floats_of(float x)
{
    return (floats){x, x, x, x};
}

static inline floats where(ints mask, floats v)
{
    return (floats)(mask & (ints)v);
}

static inline floats magnitude(floats v)
{
    return (floats)((ints)v & INT32_MAX);
}

static inline floats larger_of(floats a, floats b)
{
    const ints first = a > b;
    return (floats)((first & (ints)a) | (~first & (ints)b));
}

static inline floats smaller_of(floats a, floats b)
{
    const ints first = a < b;
    return (floats)((first & (ints)a) | (~first & (ints)b));
}

static inline floats as_floats(ints v)
{
    return __builtin_convertvector(v, floats);
}

/* As total() of line_sums.c. */
static inline float total_of(const floats lanes[FOURS])
{
    const floats low = lanes[0] + lanes[2], high = lanes[1] + lanes[3], sum = low + high;
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

static inline asj_line_sums total_sums(const lane_sums list[FOURS])
{
#define TOTAL(field) total_of((const floats[FOURS]){list[0].field, list[1].field, list[2].field, list[3].field})
    return (asj_line_sums){TOTAL(w), TOTAL(x), TOTAL(y), TOTAL(xx), TOTAL(xy), TOTAL(yy)};
#undef TOTAL
}

/* Four grey values of a minus those of b: these are below 2^15. */
static inline floats difference(const uint16_t *a, const uint16_t *b)
{
    uint64_t p, q;
    memcpy(&p, a, sizeof p);
    memcpy(&q, b, sizeof q);
    const vec d = v_sub((vec)(fours){p, 0}, (vec)(fours){q, 0});
    return as_floats((ints)v_join_low(d, v_greater(v_zero(), d)));
}

/* Of four columns while their rows are walked along: sums of w, w y, w y^2. */
typedef struct column_sums {
    floats w, y, yy;
} column_sums;

static inline void add_lanes(column_sums *to, floats w, floats dy)
{
    const floats y = w * dy;
    to->w += w;
    to->y += y;
    to->yy += y * dy;
}

static inline void add_columns(lane_sums *to, const column_sums *columns, floats dx)
{
    const floats x = columns->w * dx;
    to->w += columns->w;
    to->x += x;
    to->y += columns->y;
    to->xx += x * dx;
    to->xy += columns->y * dx;
    to->yy += columns->yy;
}

/* The four columns from `column` on. */
static inline void sum_columns(const asj_frame *frame, const asj_line_band *band, int32_t column, lane_sums *down_sums,
                               lane_sums *up_sums)
{
    const floats ux = floats_of(band->ux), uy = floats_of(band->uy), zero = floats_of(0);
    const floats at = floats_of((float)column) + (floats){0, 1, 2, 3}, dx = at - band->middle_x;
    const ints valid = at <= floats_of((float)band->right);
    const floats t = band->step_t * dx, s = band->step_s * dx;
    const floats first = larger_of(t - band->reach_t, s - band->reach_s), last = smaller_of(t + band->reach_t, s + band->reach_s);
    const ptrdiff_t stride = frame->stride;
    int32_t first_row, last_row;
    asj_line_band_rows(band, column, 4, &first_row, &last_row);
    const uint16_t *p = frame->gray + (band->y + first_row) * stride + band->x + column;
    column_sums up = {zero, zero, zero}, down = up;
    for (int32_t row = first_row; row <= last_row; row++, p += stride) {
        const floats gx = difference(p + 1, p - 1), gy = difference(p + stride, p - stride);
        const floats across = gy * ux - gx * uy, along = gx * ux + gy * uy, dy = floats_of((float)row - band->middle_y);
        const ints inside = valid & (dy >= first) & (dy <= last), is_up = across > zero;
        const floats excess = magnitude(across) - magnitude(along), w = where(inside & (excess > zero), excess);
        add_lanes(&up, where(is_up, w), dy);
        add_lanes(&down, where(~is_up, w), dy);
    }
    add_columns(down_sums, &down, dx);
    add_columns(up_sums, &up, dx);
}

static void line_sums(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2])
{
    lane_sums sides[2][FOURS];
    memset(sides, 0, sizeof sides);
    for (int32_t column = band->left, i = 0; column <= band->right; column += 4, i = (i + 1) % FOURS)
        sum_columns(frame, band, column, &sides[0][i], &sides[1][i]);
    sums[0] = total_sums(sides[0]);
    sums[1] = total_sums(sides[1]);
}

/* Two neighbours at each of four places. */
static inline shorts pairs_at(const uint16_t *const p[4], ptrdiff_t offset)
{
    int32_t words[4];
    for (int i = 0; i < 4; i++)
        memcpy(&words[i], p[i] + offset, sizeof words[i]);
    return (shorts)(ints){words[0], words[1], words[2], words[3]};
}

/* The second of each pair of a and the first of that of b; pairs of these numbers below 2^15. */
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
static inline shorts between(shorts a, shorts b)
{
    return (shorts)((unsigned_ints)a << 16 | (unsigned_ints)b >> 16);
}

static inline shorts pairs_of(ints first, ints second)
{
    return (shorts)(first << 16 | second);
}
#else
static inline shorts between(shorts a, shorts b)
{
    return (shorts)((unsigned_ints)a >> 16 | (unsigned_ints)b << 16);
}

static inline shorts pairs_of(ints first, ints second)
{
    return (shorts)(first | second << 16);
}
#endif

/* Pairs of numbers times pairs of weights, added up. */
static inline ints weighted(shorts pairs, shorts weights)
{
    return (ints)v_pairs((vec)pairs, (vec)weights);
}

/* Four neighbours at each of four places: the first two of each, and the others. */
static inline void fours_at(const uint16_t *const p[4], ptrdiff_t offset, shorts *first, shorts *second)
{
    uint64_t words[4];
    for (int i = 0; i < 4; i++)
        memcpy(&words[i], p[i] + offset, sizeof words[i]);
    const vec a = (vec)(fours){words[0], words[1]}, b = (vec)(fours){words[2], words[3]};
    const vec even = v_interleave32_low(a, b), odd = v_interleave32_high(a, b); /* of places 0 and 2, of 1 and 3 */
    *first = (shorts)v_interleave32_low(even, odd);
    *second = (shorts)v_interleave32_high(even, odd);
}

/* Central differences at the four pixels around four samples, bilinear; p[i]: the upper left one of sample i. */
static inline void sample_four(const uint16_t *const p[4], ptrdiff_t stride, ints right, floats low, floats *gx, floats *gy)
{
    const shorts above = pairs_at(p, -stride), below = pairs_at(p, 2 * stride);
    shorts left0, right0, left1, right1;
    fours_at(p, -1, &left0, &right0);
    fours_at(p, stride - 1, &left1, &right1);
    const shorts weights = pairs_of(4096 - right, right);
    const ints x0 = weighted(right0 - left0, weights), x1 = weighted(right1 - left1, weights);
    const ints y0 = weighted(between(left1, right1) - above, weights), y1 = weighted(below - between(left0, right0), weights);
    *gx = as_floats(x0) + low * as_floats(x1 - x0);
    *gy = as_floats(y0) + low * as_floats(y1 - y0);
}

static inline ints whole_part(floats v)
{
    const ints whole = __builtin_convertvector(v, ints);
    return whole + (as_floats(whole) > v);
}

/* Samples k .. k + 3 of a profile, those past its end like the last. */
static inline void profile_four(const asj_frame *frame, const asj_line_profile *profile, int32_t k, asj_profile_sums *sums)
{
    const floats zero = floats_of(0), ux = floats_of(profile->ux), uy = floats_of(profile->uy);
    const uint16_t *gray = frame->gray + profile->y * frame->stride + profile->x;
    const floats index = smaller_of(floats_of((float)k) + (floats){0, 1, 2, 3}, floats_of((float)(profile->count - 1)));
    const floats t = profile->first + index * profile->step, middle = profile->a + profile->b * t;
    const floats x0 = profile->origin_x + t * ux, y0 = profile->origin_y + t * uy;
    floats up = zero, down = zero, up_moment = zero, down_moment = zero;
    for (int32_t i = 0; i < profile->offsets; i++) {
        const floats offset = floats_of(profile->offset[i]), s = middle + offset, x = x0 - s * uy, y = y0 + s * ux;
        const ints ix = whole_part(x), iy = whole_part(y);
        const ints right = __builtin_convertvector((x - as_floats(ix)) * 4096.0f, ints);
        const uint16_t *p[4];
        for (int lane = 0; lane < 4; lane++)
            p[lane] = gray + iy[lane] * frame->stride + ix[lane];
        floats gx, gy;
        sample_four(p, frame->stride, right, y - as_floats(iy), &gx, &gy);
        const floats across = gy * ux - gx * uy, along = gx * ux + gy * uy;
        const floats excess = magnitude(across) - magnitude(along), w = where(excess > zero, excess), moment = w * offset;
        const ints is_up = across > zero;
        up += where(is_up, w);
        down += where(~is_up, w);
        up_moment += where(is_up, moment);
        down_moment += where(~is_up, moment);
    }
    memcpy(sums->w[0] + k, &down, sizeof down);
    memcpy(sums->w[1] + k, &up, sizeof up);
    memcpy(sums->moment[0] + k, &down_moment, sizeof down_moment);
    memcpy(sums->moment[1] + k, &up_moment, sizeof up_moment);
}

/* As in line_sums.c. */
static inline void total_profile(int32_t count, int32_t side, asj_profile_sums *sums)
{
    lane_sums list[FOURS]; /* y: of the moments */
    ints counts = {0, 0, 0, 0};
    memset(list, 0, sizeof list);
    for (int32_t k = 0, i = 0; k < count; k += 4, i = (i + 1) % FOURS) {
        const floats at = floats_of((float)k) + (floats){0, 1, 2, 3};
        const ints valid = at < floats_of((float)count);
        floats w, r;
        memcpy(&w, sums->w[side] + k, sizeof w);
        memcpy(&r, sums->moment[side] + k, sizeof r);
        w = where(valid, w);
        r = where(valid, r);
        const floats x = w * at;
        counts -= w > floats_of(0);
        list[i].w += w;
        list[i].x += x;
        list[i].xx += x * at;
        list[i].y += r;
        list[i].xy += r * at;
    }
    const asj_line_sums all = total_sums(list);
    sums->counts[side] = (counts[0] + counts[1]) + (counts[2] + counts[3]);
    sums->totals[side] = (struct asj_profile_totals){all.w, all.x, all.xx, all.y, all.xy};
}

static void line_profile(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums)
{
    const int whole = asj_line_profile_inside(frame, profile, 0, profile->count);
    for (int32_t k = 0; k < profile->count; k += 4) {
        const int32_t to = k + 4 < profile->count ? k + 4 : profile->count;
        if (!whole && !asj_line_profile_inside(frame, profile, k, to))
            asj_line_profile_part(frame, profile, k, to, sums);
        else
            profile_four(frame, profile, k, sums);
    }
    for (int32_t side = 0; side < 2; side++)
        total_profile(profile->count, side, sums);
}

static void fill_lines(const asj_ops *ops)
{
    ops->line->sums = line_sums;
    ops->line->profile = line_profile;
}

#endif
