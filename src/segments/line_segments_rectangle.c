/* SPDX-License-Identifier: BSD-2-Clause */
/* Rectangle approximation of a region (von Gioi et al., PAMI 2010, section 2.6): the centre is the mean of the samples weighted by
 * the gradient's norm, the direction the principal axis of their weighted second moments, length and width what covers them all.
 *
 * With the central moments  C = [[cxx, cxy], [cxy, cyy]]  the larger eigenvalue is  (cxx + cyy + d) / 2,
 * d = sqrt((cxx - cyy)^2 + 4 cxy^2), its eigenvector  (cxx - cyy + d, 2 cxy)  or, where that would cancel,
 * (2 cxy, cyy - cxx + d). Of both ways along it, the one that the level lines point. */
#include "line_segments_rectangle.h"

#include <math.h>

static void set_centre(const asj_levels *levels, const int32_t *samples, int32_t count, asj_rectangle *r)
{
    double total = 0, x = 0, y = 0;
    for (int32_t i = 0; i < count; i++) {
        const double weight = (double)levels->norm[samples[i]];
        x += weight * (samples[i] % levels->width);
        y += weight * (samples[i] / levels->width);
        total += weight;
    }
    r->x = x / total;
    r->y = y / total;
}

static void set_direction(const asj_levels *levels, const int32_t *samples, int32_t count, asj_rectangle *r)
{
    double xx = 0, xy = 0, yy = 0;
    for (int32_t i = 0; i < count; i++) {
        const double weight = (double)levels->norm[samples[i]];
        const double dx = samples[i] % levels->width - r->x, dy = samples[i] / levels->width - r->y;
        xx += weight * dx * dx;
        xy += weight * dx * dy;
        yy += weight * dy * dy;
    }
    const double d = sqrt((xx - yy) * (xx - yy) + 4 * xy * xy);
    const double ux = xx >= yy ? xx - yy + d : 2 * xy, uy = xx >= yy ? 2 * xy : yy - xx + d;
    const double size = sqrt(ux * ux + uy * uy);
    if (size > 0) {
        r->ux = ux / size;
        r->uy = uy / size;
    } /* else as round as can be: as it was */
}

asj_rectangle asj_rectangle_of(const asj_levels *levels, const int32_t *samples, int32_t count, double towards_x, double towards_y)
{
    asj_rectangle r = {0, 0, towards_x, towards_y, 0, 0, 0, 0};
    set_centre(levels, samples, count, &r);
    set_direction(levels, samples, count, &r);
    if (r.ux * towards_x + r.uy * towards_y < 0) {
        r.ux = -r.ux;
        r.uy = -r.uy;
    }
    for (int32_t i = 0; i < count; i++) {
        const double dx = samples[i] % levels->width - r.x, dy = samples[i] / levels->width - r.y;
        const double along = dx * r.ux + dy * r.uy, across = dy * r.ux - dx * r.uy;
        r.first = along < r.first ? along : r.first;
        r.last = along > r.last ? along : r.last;
        r.low = across < r.low ? across : r.low;
        r.high = across > r.high ? across : r.high;
    }
    return r;
}

/* Narrows [*left, *right] to where  low <= value + slope x <= high. */
static void narrow(double value, double slope, double low, double high, double *left, double *right)
{
    if (fabs(slope) < 1e-9) {
        if (value < low || value > high)
            *right = *left - 1;
        return;
    }
    const double a = (low - value) / slope, b = (high - value) / slope;
    *left = fmax(*left, fmin(a, b));
    *right = fmin(*right, fmax(a, b));
}

int32_t asj_rectangle_count(const asj_levels *levels, const asj_rectangle *r, const float *cosines, int32_t count, int32_t *aligned)
{
    const double spread = 0.5 * asj_rectangle_width(r), middle = 0.5 * (r->low + r->high);
    const double low = middle - spread, high = middle + spread;
    const double a = r->first * r->uy, b = r->last * r->uy, c = low * r->ux, d = high * r->ux;
    const double top = fmax(ceil(r->y + fmin(a, b) + fmin(c, d)), 0);
    const double bottom = fmin(floor(r->y + fmax(a, b) + fmax(c, d)), levels->height - 1);
    const float ux = (float)r->ux, uy = (float)r->uy;
    int32_t inside = 0;
    for (int32_t i = 0; i < count; i++)
        aligned[i] = 0;
    for (int32_t y = (int32_t)top; y <= (int32_t)bottom; y++) {
        const double dy = y - r->y;
        double left = 0, right = levels->width - 1;
        narrow(dy * r->uy - r->x * r->ux, r->ux, r->first, r->last, &left, &right);
        narrow(dy * r->ux + r->x * r->uy, -r->uy, low, high, &left, &right);
        for (int32_t x = (int32_t)ceil(left); x <= (int32_t)floor(right); x++) {
            const asj_unit_vector *at = &levels->direction[(ptrdiff_t)y * levels->width + x];
            const float cosine = at->x * ux + at->y * uy; /* of samples without level line: 0, aligned with nothing */
            inside++;
            for (int32_t i = 0; i < count; i++)
                aligned[i] += cosine >= cosines[i];
        }
    }
    return inside;
}
