/* SPDX-License-Identifier: BSD-2-Clause */
/* Junction-ness of a sector of any radius (paper, eq. junction-ness-branch).
 *
 * The sector of scale r has constant width 2 tau at its end, so its number of pixels J differs from angle to angle and from scale
 * to scale. Departure: what is maximised is the normalised  (omega - J mu) / (sigma sqrt(J)),  as the sum itself would prefer
 * angles with more pixels. Under zoom by 0.9, 73 % of the branches of three photographs keep their length with it, 69 % with the
 * sum. */
#include "search.h"
#include "gradient.h"
#include "null_model.h"

#include <math.h>
#include <stdlib.h>

/* What a pixel (dx, dy) from p is to the sector, decided without roots but near its outline: there, and only there, rounding might
 * decide otherwise than the definition does,  d = |(dx, dy)| <= length and  (dx, dy).u >= d cos(tau / length). */
typedef struct outline {
    double ux, uy, length;
    double cosine, tangent; /* of tau / length; tangent 0 when the sector is so wide that only the definition is asked */
    double surely;          /* length^2, less what rounding may do */
} outline;

#define SLACK 1e-9  /* px: far more than rounding makes of the products below */
#define WIDE 1.4    /* rad */
#define NARROW 8    /* px: a sector of this length goes by 22 degrees to either side at most, so that no side is across */

static int is_inside(const outline *o, int32_t dx, int32_t dy)
{
    const double along = dx * o->ux + dy * o->uy, across = fabs(dy * o->ux - dx * o->uy), edge = along * o->tangent;
    const double square = (double)dx * dx + (double)dy * dy;
    if (o->tangent > 0 && across > edge + SLACK)
        return 0;
    if (o->tangent > 0 && across < edge - SLACK && square < o->surely)
        return 1;
    const double distance = sqrt(square);
    return distance > 0 && distance <= o->length && along >= o->cosine * distance;
}

/* gamma = (|g x d| - |g . d|) / |d| where that is positive; the numerator is a whole number. */
static void add_pixel(const asj_frame *frame, int32_t x, int32_t y, int32_t dx, int32_t dy, asj_search_sum *s)
{
    if (x < 0 || y < 0 || x >= frame->width || y >= frame->height)
        return;
    const int32_t gx = frame->gradient_x[y * frame->stride + x], gy = frame->gradient_y[y * frame->stride + x];
    const int32_t numerator = abs(gy * dx - gx * dy) - abs(gx * dx + gy * dy);
    if (numerator > 0)
        s->gamma += numerator / sqrt((double)dx * dx + (double)dy * dy) / ASJ_GRADIENT_ONE;
    s->pixels++;
}

/* Where the sector's sides are, across the axis that the branch is longer on, one px along it. */
typedef struct opening {
    double from, to;
} opening;

/* tan(atan(slope) -+ half). Short ones are wide: everything around is looked at, on every step. */
static opening opening_of(double slope, double half, double length)
{
    if (length < NARROW)
        return (opening){-2 * length, 2 * length};
    const double middle = atan(slope);
    return (opening){tan(middle - half), tan(middle + half)};
}

/* Walks along the axis (x or y) that the branch is longer on, and across it over the few pixels that can be inside. */
asj_search_sum asj_search_omega(const asj_frame *frame, double x, double y, double angle, double length, double tau)
{
    const double half = tau / length;
    const outline o = {cos(angle), sin(angle), length, cos(half), half < WIDE ? tan(half) : 0, length * length * (1 - 1e-12)};
    const int32_t px = (int32_t)lrint(x), py = (int32_t)lrint(y), steps = (int32_t)ceil(length);
    const int along_x = fabs(o.ux) >= fabs(o.uy);
    const int32_t sign = (along_x ? o.ux : o.uy) < 0 ? -1 : 1;
    const double slope = along_x ? o.uy / fabs(o.ux) : o.ux / fabs(o.uy); /* across for one step along */
    const opening across = opening_of(slope, half, length);
    asj_search_sum s = {0, 0};
    for (int32_t i = 0; i <= steps; i++) {
        const double step = length < NARROW ? 1 : i;
        const int32_t last = (int32_t)floor(step * across.to + SLACK);
        for (int32_t j = (int32_t)ceil(step * across.from - SLACK); j <= last; j++) {
            const int32_t dx = along_x ? sign * i : j, dy = along_x ? j : sign * i;
            if (is_inside(&o, dx, dy))
                add_pixel(frame, px + dx, py + dy, dx, dy, &s);
        }
    }
    return s;
}

double asj_search_strength(const asj_frame *frame, double x, double y, double angle, double length, double tau)
{
    const asj_search_sum s = asj_search_omega(frame, x, y, angle, length, tau);
    return asj_gamma_strength(s.gamma, s.pixels);
}

