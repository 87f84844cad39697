/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5 as in the paper (option refinement = search):  argmax_theta sum of gamma over S_p(r_theta, theta),  over theta +- 0.1 rad
 * (paper, end of section "Junction Detection"; the step is ours, a twentieth of that).
 *
 * The sector of scale r has constant width 2 tau, so its number of pixels J differs from angle to angle; what is maximised is the
 * normalised  (omega - J mu) / (sigma sqrt(J)),  as the sum itself would prefer angles with more pixels. */
#include "search.h"
#include "nfa.h"

#include <math.h>

#define STEPS 20          /* to either side */
#define STEP 0.005        /* rad */
#define LEAST_LENGTH 3.0  /* px: shorter branches are searched as if they were this long */

typedef struct sums {
    double gamma, pixels;
} sums;

static void add_pixel(const asj_frame *frame, int32_t x, int32_t y, double dx, double dy, double distance, sums *s)
{
    if (x < 0 || y < 0 || x >= frame->width || y >= frame->height)
        return;
    const double gx = frame->gradient_x[y * frame->stride + x], gy = frame->gradient_y[y * frame->stride + x];
    const double gamma = (fabs(gy * dx - gx * dy) - fabs(gx * dx + gy * dy)) / distance;
    s->gamma += gamma > 0 ? gamma / ASJ_GRADIENT_ONE : 0;
    s->pixels++;
}

/* Normalised junction-ness of the sector of radius `length` around `angle`, at a whole pixel. Walks along the axis (x or y) that
 * the branch is longer on, and across it over the few pixels that can be inside. */
static double sector_strength(const asj_frame *frame, double x, double y, double angle, double length, double tau)
{
    const double ux = cos(angle), uy = sin(angle), limit = cos(tau / length);
    const int32_t px = (int32_t)lrint(x), py = (int32_t)lrint(y), steps = (int32_t)ceil(length);
    const int along_x = fabs(ux) >= fabs(uy);
    const int32_t sign = (along_x ? ux : uy) < 0 ? -1 : 1;
    const double slope = along_x ? uy / fabs(ux) : ux / fabs(uy); /* across for one step along */
    sums s = {0, 0};
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
    return s.pixels > 0 ? (s.gamma - s.pixels * ASJ_GAMMA_MEAN) / (ASJ_GAMMA_SD * sqrt(s.pixels)) : 0;
}

void asj_search_orientation(const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        asj_hypothesis_branch *branch = &hypothesis->branches[i];
        const double start = branch->angle, length = fmax(branch->length, LEAST_LENGTH);
        double best = -HUGE_VAL;
        for (int step = -STEPS; step <= STEPS; step++) {
            double angle = start + STEP * step;
            double strength = sector_strength(frame, hypothesis->x, hypothesis->y, angle, length, options->sector_width);
            if (strength > best) {
                best = strength;
                branch->angle = asj_angle_wrap(angle);
            }
        }
    }
}
