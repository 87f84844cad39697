/* SPDX-License-Identifier: BSD-2-Clause */
/* Blur rounds a corner: within three of its standard deviations the edges bend, inwards where the corner is acute and outwards
 * where it is obtuse, and lines fitted to them meet somewhere else. How far they bend is known.
 *
 * Corner of opening phi at the origin, its first edge along t, s at right angles, the second edge along (cos phi, sin phi). Its
 * gradient is that of two half-lines of unit steps. Blurred with a Gaussian of standard deviation b, up to a factor, with
 * p = t cos phi + s sin phi and q = s cos phi - t sin phi the coordinates along and across the second edge,
 *     G_s = N(t / b) exp(-s^2 / 2 b^2) - cos phi N(p / b) exp(-q^2 / 2 b^2),   G_t = sin phi N(p / b) exp(-q^2 / 2 b^2)
 * with N the normal distribution function. (A corner on the other side of the edge is the same mirrored, and a dark one the same
 * with another sign.) The line fit (line_fit.c) weights with max(|G_s| - |G_t|, 0): so the line that it finds on a known corner
 * can be computed, sample for sample. Sought is the corner whose lines are those that were found. Corrected edges are what was
 * found, less what the corner as it is known by now would add; a few rounds settle to a hundredth of a pixel.
 *
 * What ends a branch at its other side bends it too. That part is left out of the fit (refine.c): nobody knows by how much. */
#include "bent_corner.h"
#include "core/angle.h"
#include "edge_width.h"
#include "locate.h"

#include <math.h>

#define ROUNDS 5
#define SETTLED 0.01    /* px: a round that moves the corner by less is the last */
#define MOST_SAMPLES 32 /* along an edge */
#define FARTHEST 3.0    /* widths that a corner may be moved: more is no correction */
#define NOTHING 4.0     /* standard deviations from where on a normal distribution is 0 or 1 */

/* The other edge as seen from this one, and the blur. */
typedef struct corner {
    double cosine, sine, blur;
} corner;

static double normal(double z)
{
    return z > NOTHING ? 1 : z < -NOTHING ? 0 : 0.5 * erfc(-0.7071067811865476 * z);
}

/* The line fit's weight at (t, s). */
static double weight_at(const corner *c, double t, double s)
{
    const double p = (t * c->cosine + s * c->sine) / c->blur, q = (s * c->cosine - t * c->sine) / c->blur, z = s / c->blur;
    const double other = fabs(q) < NOTHING ? normal(p) * exp(-0.5 * q * q) : 0;
    const double across = normal(t / c->blur) * exp(-0.5 * z * z) - c->cosine * other;
    return fmax(across - fabs(c->sine * other), 0);
}

typedef struct line {
    double a, b; /* s = a + b t */
} line;

/* The line that a fit in a band around `around` finds. 0: none. */
static int fit(const corner *c, const asj_fitted_part *part, const line *around, line *found)
{
    const int32_t reach = (int32_t)ceil(part->half_width);
    const double step = fmax((part->last - part->first) / (MOST_SAMPLES - 1), 1);
    double w = 0, wt = 0, wtt = 0, wr = 0, wtr = 0;
    for (double t = part->first; t <= part->last; t += step) {
        double sum = 0, moment = 0;
        for (int32_t i = -reach; i <= reach; i++) {
            const double offset = part->half_width * i / reach, weight = weight_at(c, t, around->a + around->b * t + offset);
            sum += weight;
            moment += weight * offset;
        }
        w += sum;
        wt += sum * t;
        wtt += sum * t * t;
        wr += moment;
        wtr += moment * t;
    }
    const double determinant = w * wtt - wt * wt;
    if (!(determinant > 1e-5 * w * wtt))
        return 0;
    *found = (line){around->a + (wtt * wr - wt * wtr) / determinant, around->b + (w * wtr - wt * wr) / determinant};
    return 1;
}

/* One branch of `known`, the corner as it is known by now, from the line of `raw`. 0: leave it. */
static int correct(const asj_hypothesis *raw, const asj_fitted_part *part, const asj_hypothesis *known, int32_t i,
                   asj_hypothesis_branch *corrected)
{
    const asj_hypothesis_branch *line_found = &raw->branches[i], *edge = &known->branches[i];
    const double turn = remainder(known->branches[1 - i].angle - edge->angle, ASJ_TWO_PI), side = turn < 0 ? -1 : 1;
    const double width = fmin(line_found->width, ASJ_WIDEST_EDGE);
    const corner c = {cos(turn), fabs(sin(turn)), sqrt(width * width + ASJ_EDGE_SAMPLING)};
    const double dx = known->x - raw->x, dy = known->y - raw->y, ux = cos(line_found->angle), uy = sin(line_found->angle);
    const double tilt = tan(remainder(line_found->angle - edge->angle, ASJ_TWO_PI)), along = dx * ux + dy * uy;
    const asj_fitted_part seen = {part->first - along, part->last - along, part->half_width};
    /* with the corner's inside at positive s */
    const line found = {side * (line_found->offset - (dy * ux - dx * uy)) * sqrt(1 + tilt * tilt), side * tilt};
    line expected;
    if (!(fabs(tilt) < 0.5) || !fit(&c, &seen, &found, &expected))
        return 0;
    *corrected = *edge;
    corrected->angle = asj_angle_wrap(edge->angle + side * atan(found.b - expected.b));
    corrected->offset = side * (found.a - expected.a);
    return 1;
}

void asj_bent_corner(const asj_fitted_part *parts, asj_hypothesis *hypothesis)
{
    const asj_hypothesis raw = *hypothesis;
    asj_hypothesis known = raw;
    if (raw.branch_count != 2 || !(fmax(raw.branches[0].width, raw.branches[1].width) > ASJ_BENT_FROM))
        return;
    for (int32_t round = 0; round < ROUNDS; round++) {
        asj_hypothesis next = known;
        for (int32_t i = 0; i < 2; i++)
            if (raw.branches[i].apart > 0 || !correct(&raw, &parts[i], &known, i, &next.branches[i]))
                return;
        if (!asj_locate_meet(&next))
            return;
        const double moved = hypot(next.x - known.x, next.y - known.y);
        known = next;
        if (moved < SETTLED)
            break;
    }
    const double blur = fmax(raw.branches[0].width, raw.branches[1].width);
    if (hypot(known.x - raw.x, known.y - raw.y) <= FARTHEST * blur)
        *hypothesis = known;
}
