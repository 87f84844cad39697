/* SPDX-License-Identifier: BSD-2-Clause */
/* Branches that cross edges instead of following one (not in the paper).
 *
 * Where parallel edges lie a few px from each other, slats of a blind, books on a shelf, keys, a ray that crosses them at a small
 * angle always has one of them in its strip, and gamma, which falls by only a fifth at 10 degrees, takes them for an edge along
 * it. The gradients tell: on the edge of a branch what they have along it, g_u, is noise, of either sign and independent of what
 * they have across, g_n; on edges that it crosses at an angle phi g_u = g_n tan phi at each. So, over the pixels of the strip
 * (strip.c),
 *
 *     tan phi = sum g_u g_n / sum g_n^2,      rho = |sum g_u g_n| / sqrt(sum g_u^2  sum g_n^2),
 *
 * the slope of g_u over g_n and their correlation about zero. Dark to bright or bright to dark is the same. A branch is tilted when
 * phi is more than max_tilt and rho more than STEADY. Noise makes phi of a weak edge as large, not rho, which is about
 * 1 / sqrt(number of pixels) then; a line that is a degree off makes rho as large, not phi.
 *
 * A tilted branch is turned by phi before it is scanned for the last time; it stays turned if its strip has more gamma then and
 * less than half of the tilt. How tilted it is at the end counts against its junction, and a tilted one that makes none goes
 * (steady.c); where strips do not judge it goes in any case (validate.c).
 *
 * Not in preset match: corners with such a branch are often corners, and find their partners by the other branches (sixteen pairs
 * of photographs: 754 right matches instead of 830 with a test at 8 degrees; 814 when branches are turned only). */
#include "tilt.h"
#include "core/angle.h"
#include "line_fit.h"

#include <math.h>

/* The least rho. With 0.5 true branches go: 6 % fewer of the junctions of eighteen photographs repeat at zoom 0.8 than with 0.6,
 * and with 0.6 as many as without this test. */
#define STEADY 0.6

#define TURNS 2             /* the second one is small */
#define MOST_TURN 0.5       /* tangent: farther away it is another edge, which has a branch of its own */
#define MORE_GAMMA 1.1      /* what is turned has so much more */
#define TURNED_WIDTH 1.5    /* px: half-width of the band where its line is guessed; the next edge is near */

static double tangent(const asj_strip_sums *sums)
{
    return sums->nn > 0 ? sums->un / sums->nn : 0;
}

int asj_is_tilted(const asj_detect_options *options, const asj_strip_sums *sums)
{
    return options->max_tilt > 0 && fabs(tangent(sums)) > tan(options->max_tilt * ASJ_DEGREE) &&
           fabs(sums->un) > STEADY * sqrt(sums->uu * sums->nn);
}

double asj_tilt(const asj_detect_options *options, const asj_strip_sums *sums)
{
    const double both = sums->un * sums->un / sqrt(sums->uu * sums->nn) / sums->nn;
    return options->max_tilt > 0 && sums->uu > 0 && sums->nn > 0 ? both / tan(options->max_tilt * ASJ_DEGREE) : 0;
}

/* Along the branch's line, which may miss the junction. */
static asj_strip_sums sums_along(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                                 const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    const asj_strip_line line = {hypothesis->x - branch->offset * sin(branch->angle),
                                 hypothesis->y + branch->offset * cos(branch->angle), branch->angle,
                                 fmin(branch->length, options->strip_length)};
    return asj_strip_add_up(context, frame, &line, options->strip_half_width, 0);
}

/* 1 when the branch was turned. */
static int turn(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                const asj_hypothesis *hypothesis, const double t[2], asj_hypothesis_branch *branch)
{
    const asj_strip_sums before = sums_along(context, frame, options, hypothesis, branch);
    asj_hypothesis_branch turned = *branch;
    if (!asj_is_tilted(options, &before) || !(fabs(tangent(&before)) < MOST_TURN))
        return 0;
    turned.angle = asj_angle_wrap(branch->angle - atan(tangent(&before)));
    asj_rough_line line = asj_rough_line_of(&turned);
    if (!asj_line_guess(context->ops->line, frame, hypothesis->x, hypothesis->y, t, TURNED_WIDTH, &line))
        return 0;
    asj_rough_line_keep(&line, &turned);
    const asj_strip_sums after = sums_along(context, frame, options, hypothesis, &turned);
    if (!(fabs(tangent(&after)) < 0.5 * fabs(tangent(&before))) || after.gamma < MORE_GAMMA * before.gamma)
        return 0;
    *branch = turned;
    return 1;
}

void asj_turn_to_edge(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                      const asj_hypothesis *hypothesis, double first, double last, asj_hypothesis_branch *branch)
{
    const double t[2] = {first, last};
    for (int32_t n = 0; options->max_tilt > 0 && n < TURNS; n++)
        if (!turn(context, frame, options, hypothesis, t, branch))
            return;
}
