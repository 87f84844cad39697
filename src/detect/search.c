/* SPDX-License-Identifier: BSD-2-Clause */
/* Junction-ness of a sector of any radius (paper, eq. junction-ness-branch).
 *
 * The sector of scale r has constant width 2 tau at its end, so its number of pixels J differs from angle to angle and from scale
 * to scale. Departure: what is maximised is the normalised  (omega - J mu) / (sigma sqrt(J)),  as the sum itself would prefer
 * angles with more pixels. Under zoom by 0.9, 73 % of the branches of three photographs keep their length with it, 69 % with the
 * sum. */
#include "search.h"
#include "gradient.h"
#include "nfa.h"

#include <math.h>

static void add_pixel(const asj_frame *frame, int32_t x, int32_t y, double dx, double dy, double distance, asj_search_sum *s)
{
    if (x < 0 || y < 0 || x >= frame->width || y >= frame->height)
        return;
    const double gx = frame->gradient_x[y * frame->stride + x], gy = frame->gradient_y[y * frame->stride + x];
    const double gamma = (fabs(gy * dx - gx * dy) - fabs(gx * dx + gy * dy)) / distance;
    s->gamma += gamma > 0 ? gamma / ASJ_GRADIENT_ONE : 0;
    s->pixels++;
}

/* Walks along the axis (x or y) that the branch is longer on, and across it over the few pixels that can be inside. */
asj_search_sum asj_search_omega(const asj_frame *frame, double x, double y, double angle, double length, double tau)
{
    const double ux = cos(angle), uy = sin(angle), limit = cos(tau / length);
    const int32_t px = (int32_t)lrint(x), py = (int32_t)lrint(y), steps = (int32_t)ceil(length);
    const int along_x = fabs(ux) >= fabs(uy);
    const int32_t sign = (along_x ? ux : uy) < 0 ? -1 : 1;
    const double slope = along_x ? uy / fabs(ux) : ux / fabs(uy); /* across for one step along */
    asj_search_sum s = {0, 0};
    for (int32_t i = 0; i <= steps; i++) {
        /* tan grows faster than its tangent: half as much again, and everything when the sector is wide */
        const double spread = length < 8 ? 2 * length : i * 1.5 * tau / length * (1 + slope * slope) + 1.5;
        for (int32_t j = (int32_t)floor(i * slope - spread); j <= (int32_t)ceil(i * slope + spread); j++) {
            const int32_t dx = along_x ? sign * i : j, dy = along_x ? j : sign * i;
            const double distance = sqrt(dx * dx + dy * dy), along = dx * ux + dy * uy;
            if (distance > 0 && distance <= length && along >= limit * distance)
                add_pixel(frame, px + dx, py + dy, dx, dy, distance, &s);
        }
    }
    return s;
}

double asj_search_strength(const asj_frame *frame, double x, double y, double angle, double length, double tau)
{
    const asj_search_sum s = asj_search_omega(frame, x, y, angle, length, tau);
    return s.pixels > 0 ? (s.gamma - s.pixels * ASJ_GAMMA_MEAN) / (ASJ_GAMMA_SD * sqrt(s.pixels)) : 0;
}

