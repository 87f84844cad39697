/* SPDX-License-Identifier: BSD-2-Clause */
/* What the line fits measure in the image.
 *
 * First, for a quick fit (line_fit.c: asj_line_guess), sums over whole pixels instead of samples between them.
 *
 * The weight of a pixel is that of line_fit.c, max(|g.n| - |g.u|, 0) of the raw gradient, and so are the normal equations: samples
 * at the same t enter those only through sum w and sum w s. What is missing are residuals, and the smooth edge of the band that
 * interpolation gives. Tests of junctions that are mostly none, and first lines of fits to come, need neither.
 *
 * Every column has its own sums of w, w y and w y^2; those with x follow from them. ASJ_LINE_LANES neighbouring columns are kept
 * apart and added at the end, in float: vector forms then give the same bits. */
#include "line_sums.h"

#include <math.h>
#include <string.h>

#define LANES ASJ_LINE_LANES
#define FAR 1e6f   /* rows */
#define LEAST 1e-9 /* of a projection that changes from row to row */

/* Where a direction's projection, which along x changes by `per_column` and along y by `per_row`, is within +-half. */
static void set_rows(double per_column, double per_row, double half, float *reach, float *step)
{
    const int changes = fabs(per_row) > LEAST;
    const double inverse = changes ? 1 / per_row : 0;
    *reach = changes ? (float)(half * fabs(inverse)) : FAR;
    *step = (float)(-per_column * inverse);
}

/* floor() for what is near the image, without a call. */
static int32_t whole(double value)
{
    return (int32_t)(value + 524288) - 524288;
}

static int32_t larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

void asj_line_band_set(const asj_frame *frame, const asj_line_box *box, asj_line_band *band)
{
    const double x = box->x, y = box->y, ux = box->ux, uy = box->uy, half_length = box->half_length, half_width = box->half_width;
    const double wide = half_length * fabs(ux) + half_width * fabs(uy), high = half_length * fabs(uy) + half_width * fabs(ux);
    band->ux = (float)ux;
    band->uy = (float)uy;
    band->x = whole(x);
    band->y = whole(y);
    band->middle_x = (float)(x - band->x);
    band->middle_y = (float)(y - band->y);
    band->left = larger(-whole(wide - x), 1) - band->x;
    band->right = smaller(whole(x + wide), frame->width - 2) - band->x;
    band->top = larger(-whole(high - y), 1) - band->y;
    band->bottom = smaller(whole(y + high), frame->height - 2) - band->y;
    set_rows(ux, uy, half_length, &band->reach_t, &band->step_t);
    set_rows(-uy, ux, half_width, &band->reach_s, &band->step_s);
}

typedef struct lanes {
    float w[LANES], x[LANES], y[LANES], xx[LANES], xy[LANES], yy[LANES];
} lanes;

/* The rows of a column that are inside, from the middle's. */
static void column_rows(const asj_line_band *band, float dx, float *first, float *last)
{
    const float t = band->step_t * dx, s = band->step_s * dx;
    const float first_t = t - band->reach_t, first_s = s - band->reach_s, last_t = t + band->reach_t, last_s = s + band->reach_s;
    *first = first_t > first_s ? first_t : first_s;
    *last = last_t < last_s ? last_t : last_s;
}

static void add_column(const asj_frame *frame, const asj_line_band *band, int32_t column, lanes sides[2])
{
    const int32_t lane = (column - band->left) % LANES;
    int32_t top, bottom;
    const float dx = (float)column - band->middle_x;
    float first, last, w[2] = {0, 0}, y[2] = {0, 0}, yy[2] = {0, 0};
    column_rows(band, dx, &first, &last);
    asj_line_band_rows(band, column, 1, &top, &bottom);
    for (int32_t row = top; row <= bottom; row++) {
        const float dy = (float)row - band->middle_y;
        if (!(dy >= first && dy <= last))
            continue;
        const uint16_t *p = frame->gray + (band->y + row) * frame->stride + band->x + column;
        const float gx = (float)(p[1] - p[-1]), gy = (float)(p[frame->stride] - p[-frame->stride]);
        const float across = gy * band->ux - gx * band->uy, weight = fabsf(across) - fabsf(gx * band->ux + gy * band->uy);
        if (!(weight > 0))
            continue;
        w[across > 0] += weight;
        y[across > 0] += weight * dy;
        yy[across > 0] += weight * dy * dy;
    }
    for (int i = 0; i < 2; i++) {
        const float x = w[i] * dx;
        sides[i].w[lane] += w[i];
        sides[i].x[lane] += x;
        sides[i].y[lane] += y[i];
        sides[i].xx[lane] += x * dx;
        sides[i].xy[lane] += y[i] * dx;
        sides[i].yy[lane] += yy[i];
    }
}

static float total(const float lane[LANES])
{
    float v[LANES / 2];
    for (int i = 0; i < LANES / 2; i++)
        v[i] = lane[i] + lane[LANES / 2 + i];
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

void asj_line_sums_of(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2])
{
    lanes sides[2];
    memset(sides, 0, sizeof sides);
    for (int32_t column = band->left; column <= band->right; column++)
        add_column(frame, band, column, sides);
    for (int i = 0; i < 2; i++)
        sums[i] = (asj_line_sums){total(sides[i].w),  total(sides[i].x),  total(sides[i].y),
                                  total(sides[i].xx), total(sides[i].xy), total(sides[i].yy)};
}

/* Central differences at the four pixels around the sample, bilinear: along x in whole numbers (1/4096 px), along y in float. */
static inline void sample(const uint16_t *const row[4], const int32_t column[4], int32_t right, float low, float *gx, float *gy)
{
#define I(i, j) (int32_t)row[i][column[j]]
    const int32_t left = 4096 - right;
    const int32_t x0 = (I(1, 2) - I(1, 0)) * left + (I(1, 3) - I(1, 1)) * right;
    const int32_t x1 = (I(2, 2) - I(2, 0)) * left + (I(2, 3) - I(2, 1)) * right;
    const int32_t y0 = (I(2, 1) - I(0, 1)) * left + (I(2, 2) - I(0, 2)) * right;
    const int32_t y1 = (I(3, 1) - I(1, 1)) * left + (I(3, 2) - I(1, 2)) * right;
#undef I
    *gx = (float)x0 + low * (float)(x1 - x0);
    *gy = (float)y0 + low * (float)(y1 - y0);
}

static inline int32_t clamp(int32_t value, int32_t last)
{
    return value < 0 ? 0 : value > last ? last : value;
}

/* At (x, y) from the profile's pixel; outside the image its border counts. `inside`: all four columns and rows are there. */
static inline void sample_at(const asj_frame *frame, const asj_line_profile *profile, int inside, float x, float y, float *gx,
                             float *gy)
{
    const int32_t right = frame->width - 1, bottom = frame->height - 1;
    int32_t column[4], ix = (int32_t)x, iy = (int32_t)y;
    const uint16_t *row[4];
    ix -= (float)ix > x;
    iy -= (float)iy > y;
    for (int32_t i = 0; i < 4; i++) {
        const int32_t at_x = profile->x + ix - 1 + i, at_y = profile->y + iy - 1 + i;
        column[i] = inside ? at_x : clamp(at_x, right);
        row[i] = frame->gray + (ptrdiff_t)(inside ? at_y : clamp(at_y, bottom)) * frame->stride;
    }
    sample(row, column, (int32_t)((x - (float)ix) * 4096.0f), y - (float)iy, gx, gy);
}

static inline void sum_across(const asj_frame *frame, const asj_line_profile *profile, int inside, int32_t k,
                              asj_profile_sums *sums)
{
    const float ux = profile->ux, uy = profile->uy;
    const float t = profile->first + (float)k * profile->step, middle = profile->a + profile->b * t;
    float w[2] = {0, 0}, moment[2] = {0, 0};
    for (int32_t i = 0; i < profile->offsets; i++) {
        const float s = middle + profile->offset[i];
        float gx, gy;
        sample_at(frame, profile, inside, profile->origin_x + t * ux - s * uy, profile->origin_y + t * uy + s * ux, &gx, &gy);
        const float across = gy * ux - gx * uy, weight = fabsf(across) - fabsf(gx * ux + gy * uy);
        if (weight > 0) {
            w[across > 0] += weight;
            moment[across > 0] += weight * profile->offset[i];
        }
    }
    for (int32_t i = 0; i < 2; i++) {
        sums->w[i][k] = w[i];
        sums->moment[i][k] = moment[i];
    }
}

void asj_line_profile_part(const asj_frame *frame, const asj_line_profile *profile, int32_t from, int32_t to,
                           asj_profile_sums *sums)
{
    if (asj_line_profile_inside(frame, profile, from, to))
        for (int32_t k = from; k < to; k++)
            sum_across(frame, profile, 1, k, sums);
    else
        for (int32_t k = from; k < to; k++)
            sum_across(frame, profile, 0, k, sums);
}

static void total_profile(int32_t count, int32_t side, asj_profile_sums *sums)
{
    const float *w = sums->w[side], *r = sums->moment[side];
    lanes list; /* y: of the moments */
    memset(&list, 0, sizeof list);
    sums->counts[side] = 0;
    for (int32_t k = 0; k < count; k++) {
        const int32_t lane = k % LANES;
        const float at = (float)k, weighted = w[k] * at;
        sums->counts[side] += w[k] > 0;
        list.w[lane] += w[k];
        list.x[lane] += weighted;
        list.xx[lane] += weighted * at;
        list.y[lane] += r[k];
        list.xy[lane] += r[k] * at;
    }
    sums->totals[side] = (struct asj_profile_totals){total(list.w), total(list.x), total(list.xx), total(list.y), total(list.xy)};
}

void asj_line_profile_of(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums)
{
    asj_line_profile_part(frame, profile, 0, profile->count, sums);
    for (int32_t side = 0; side < 2; side++)
        total_profile(profile->count, side, sums);
}

int asj_line_profile_inside(const asj_frame *frame, const asj_line_profile *profile, int32_t from, int32_t to)
{
    /* px: one, and what rounding makes of large coordinates; the border is repeated around the image */
    const float spare = 1.05f - ASJ_GRAY_BORDER;
    for (int32_t i = 0; i < 4; i++) {
        const float t = profile->first + (float)(i & 1 ? to - 1 : from) * profile->step;
        const float s = profile->a + profile->b * t + profile->offset[i & 2 ? profile->offsets - 1 : 0];
        const float x = (float)profile->x + profile->origin_x + t * profile->ux - s * profile->uy;
        const float y = (float)profile->y + profile->origin_y + t * profile->uy + s * profile->ux;
        if (!(x >= spare && y >= spare && x <= (float)(frame->width - 1) - spare && y <= (float)(frame->height - 1) - spare))
            return 0;
    }
    return 1;
}

const asj_line_ops asj_line_reference = {.sums = asj_line_sums_of, .profile = asj_line_profile_of};
