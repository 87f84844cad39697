/* SPDX-License-Identifier: BSD-2-Clause */
/* What the line fits measure in the image.
 *
 * First, for a quick fit (line_fit.c: asj_line_guess), sums over whole pixels instead of samples between them.
 *
 * The weight of a pixel is that of line_fit.c, max(|g.n| - |g.u|, 0) of the raw gradient, and so are the normal equations: samples
 * at the same t enter those only through sum w and sum w s. What is missing are residuals, and the smooth edge of the band that
 * interpolation gives. Tests of junctions that are mostly none, and first lines of fits to come, need neither.
 *
 * The sums of ASJ_LINE_LANES neighbouring columns, and of every other row, are kept apart and added at the end, in float: vector
 * forms then give the same bits. */
#include "line_sums.h"

#include <math.h>
#include <string.h>

#define LANES ASJ_LINE_LANES
#define FAR 16000.0f /* columns */

/* Columns where a direction's projection lies within `range`: along x it changes by `per_column` (not 0), along y by `per_row`. */
static void set_columns(double per_column, double per_row, double origin_x, const double range[2], float *from, float *to,
                        float *step)
{
    if (fabs(per_column) < 1e-3) {
        *from = -FAR;
        *to = FAR;
        *step = 0;
        return;
    }
    const double a = origin_x + range[0] / per_column, b = origin_x + range[1] / per_column;
    *from = (float)fmin(a, b);
    *to = (float)fmax(a, b);
    *step = (float)(-per_row / per_column);
}

void asj_line_band_set(const asj_frame *frame, double x, double y, double angle, const double t[2], const double s[2],
                       asj_line_band *band)
{
    const double ux = cos(angle), uy = sin(angle), px = floor(x), py = floor(y);
    const double along = fmin(t[0] * uy, t[1] * uy), along_end = fmax(t[0] * uy, t[1] * uy);
    const double across = fmin(s[0] * ux, s[1] * ux), across_end = fmax(s[0] * ux, s[1] * ux);
    band->ux = (float)ux;
    band->uy = (float)uy;
    band->first = (float)t[0];
    band->last = (float)t[1];
    band->low = (float)s[0];
    band->high = (float)s[1];
    band->x = (int32_t)px;
    band->y = (int32_t)py;
    band->origin_x = (float)(x - px);
    band->origin_y = (float)(y - py);
    band->left = 1 - band->x;
    band->right = frame->width - 2 - band->x;
    const double top = floor(y - py + along + across), bottom = ceil(y - py + along_end + across_end);
    band->top = (int32_t)fmax(top, 1 - py);
    band->bottom = (int32_t)fmin(bottom, frame->height - 2 - py);
    set_columns(ux, uy, x - px, t, &band->near_t, &band->far_t, &band->step_t);
    set_columns(-uy, ux, x - px, s, &band->near_s, &band->far_s, &band->step_s);
}

typedef struct lanes {
    float w[LANES], t[LANES], tt[LANES], s[LANES], ts[LANES];
} lanes;

static void add_pixel(lanes *to, int lane, float w, float t, float s)
{
    const float wt = w * t;
    to->w[lane] += w;
    to->t[lane] += wt;
    to->tt[lane] += wt * t;
    to->s[lane] += w * s;
    to->ts[lane] += wt * s;
}

static float total(const float even[LANES], const float odd[LANES])
{
    float v[LANES];
    for (int i = 0; i < LANES; i++)
        v[i] = even[i] + odd[i];
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

void asj_line_sums_of(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2])
{
    lanes list[2][2]; /* of even and odd rows */
    memset(list, 0, sizeof list);
    for (int32_t row = band->top; row <= band->bottom; row++) {
        int32_t first, last;
        asj_line_band_row(band, row, &first, &last);
        const uint16_t *pixels = frame->gray + (band->y + row) * frame->stride + band->x;
        const float dy = (float)row - band->origin_y, row_t = dy * band->uy, row_s = dy * band->ux;
        for (int32_t column = first; column <= last; column++) {
            const float dx = (float)column - band->origin_x, t = row_t + dx * band->ux, s = row_s - dx * band->uy;
            if (!(t >= band->first && t <= band->last && s >= band->low && s <= band->high))
                continue;
            const uint16_t *p = pixels + column;
            const float gx = (float)(p[1] - p[-1]), gy = (float)(p[frame->stride] - p[-frame->stride]);
            const float across = gy * band->ux - gx * band->uy, w = fabsf(across) - fabsf(gx * band->ux + gy * band->uy);
            if (w > 0)
                add_pixel(&list[(row - band->top) & 1][across > 0], (column - first) % LANES, w, t, s);
        }
    }
    for (int i = 0; i < 2; i++)
        sums[i] = (asj_line_sums){total(list[0][i].w, list[1][i].w), total(list[0][i].t, list[1][i].t),
                                  total(list[0][i].tt, list[1][i].tt), total(list[0][i].s, list[1][i].s),
                                  total(list[0][i].ts, list[1][i].ts)};
}

/* Central differences at the four pixels around the sample, bilinear: along x in whole numbers (1/4096 px), along y in float. */
static void sample(const uint16_t *const row[4], const int32_t column[4], int32_t right, float low, float *gx, float *gy)
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

/* At (x, y) from the profile's pixel; outside the image its border counts. */
static void sample_at(const asj_frame *frame, const asj_line_profile *profile, float x, float y, float *gx, float *gy)
{
    const int32_t right = frame->width - 1, bottom = frame->height - 1;
    int32_t column[4], ix = (int32_t)x, iy = (int32_t)y;
    const uint16_t *row[4];
    ix -= (float)ix > x;
    iy -= (float)iy > y;
    for (int32_t i = 0; i < 4; i++) {
        column[i] = clamp(profile->x + ix - 1 + i, right);
        row[i] = frame->gray + (ptrdiff_t)clamp(profile->y + iy - 1 + i, bottom) * frame->stride;
    }
    sample(row, column, (int32_t)((x - (float)ix) * 4096.0f), y - (float)iy, gx, gy);
}

void asj_line_profile_part(const asj_frame *frame, const asj_line_profile *profile, int32_t from, int32_t to,
                           asj_profile_sums *sums)
{
    const float ux = profile->ux, uy = profile->uy;
    for (int32_t k = from; k < to; k++) {
        const float t = profile->first + (float)k * profile->step, middle = profile->a + profile->b * t;
        float w[2] = {0, 0}, moment[2] = {0, 0};
        for (int32_t i = 0; i < profile->offsets; i++) {
            const float s = middle + profile->offset[i];
            float gx, gy;
            sample_at(frame, profile, profile->origin_x + t * ux - s * uy, profile->origin_y + t * uy + s * ux, &gx, &gy);
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
}

void asj_line_profile_of(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums)
{
    asj_line_profile_part(frame, profile, 0, profile->count, sums);
}

int asj_line_profile_inside(const asj_frame *frame, const asj_line_profile *profile, int32_t from, int32_t to)
{
    const float spare = 1.05f; /* px: one, and what rounding makes of large coordinates */
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
