/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: orientation (paper, end of section "Junction Detection").
 *
 * line_fit (default): the line fit of line_fit.c over t = 5 .. L - 3 (less for short branches), then the meeting point of all
 * lines. The first pixels are left out because blur bends edges inwards at a corner, the last because the end is known to a few
 * pixels only. About three times as accurate as the search and a hundred times cheaper.
 *
 * search: the paper's way (search.c). */
#include "refine.h"
#include "blurred_corner.h"
#include "line_fit.h"
#include "locate.h"
#include "tilt.h"

#include <math.h>

/* A longer part is believed if it moves the line where it passes the junction by no more than BENT standard uncertainties; up to
 * NEAR_PART it always is. Chosen: 3 of them seldom happen by chance, and shorter parts are too uncertain to tell a bent edge. */
#define NEAR_PART 80.0 /* px */
#define BENT 3.0       /* standard uncertainties */

/* A stronger edge a few px beside the farther part of one pulls its line over (the handles of a cupboard those of its panels, by
 * 2.7 degrees). What is fitted over HELD_PART alone leaves that line, at either end, by PULLED px and by PULLED_SURELY times the
 * standard uncertainty of where it passes the junction then. The length stays that of the scan along the other line. Rendered
 * rooms: lines that are true .934 -> .956; nine tenths of the corners within .34 px for .45, of the orientations within .58
 * degrees for .68. With 5 in place of 7 lines are .959, but by the paper's criterion fewer junctions repeat where photographs
 * have arcs and cloth. */
#define HELD_PART 40.0     /* px (35 does as well), .. */
#define HELD_FROM 50.0     /* .. of a part longer than this, else it is most of it */
#define PULLED 0.75        /* px */
#define PULLED_SURELY 7.0

#define SETTLED 0.1    /* px: a line that moves by less at the end of its branch is not guessed once more */

/* Half-widths of the band in which a line is looked for, and of that in which it is fitted last, px. Chosen: a pixel of error and
 * the blur of an edge to either side; narrower cuts edges off, wider takes neighbours in. */
#define WIDE 2.0
#define HALF_WIDTH 1.6

/* Ends of the part that is fitted: see above. Of short branches less is left out, and at least 8 px are looked at. px. */
#define LEFT_OUT_FIRST 5.0
#define LEFT_OUT_LAST 3.0
#define LEAST_LAST 8.0

/* The same of edges wider than ASJ_SOFT_FROM, in their widths, from which their corner is then sought (blurred_corner.c). */
#define SOFT_FIRST 2.0
#define SOFT_LAST 4.0
#define SOFT_SHARE 0.25 /* of the branch, at most */
#define SOFT_LEAST 4.0 /* px: the shortest part */

static double first_px(const asj_hypothesis_branch *branch)
{
    const double first = fmin(LEFT_OUT_FIRST, 0.25 * branch->length + 0.5);
    return branch->width > ASJ_SOFT_FROM ? fmin(first, SOFT_FIRST * branch->width) : first;
}

static double last_px(const asj_hypothesis_branch *branch)
{
    const int soft = branch->width > ASJ_SOFT_FROM;
    const double far = soft ? fmin(SOFT_LAST * branch->width, SOFT_SHARE * branch->length) : 0;
    const double left_out = fmax(LEFT_OUT_LAST, far);
    return fmax(branch->length - left_out, soft ? fmin(LEAST_LAST, first_px(branch) + SOFT_LEAST) : LEAST_LAST);
}

/* The line from `first` to `last` px along the branch, in a narrow band around the one that is known. */
static int fit_part(const asj_context *context, const asj_frame *frame, const asj_hypothesis *hypothesis, double first, double last,
                    asj_hypothesis_branch *branch)
{
    const double t[2] = {first, last};
    const asj_line_range range = {first, last, {WIDE, HALF_WIDTH, 0}, 2};
    asj_rough_line line = asj_rough_line_of(branch);
    if (!asj_line_guess(context->ops->line, frame, hypothesis->x, hypothesis->y, t, WIDE, &line))
        return 0;
    asj_rough_line_keep(&line, branch);
    return asj_line_fit(context->ops->line, frame, hypothesis->x, hypothesis->y, &range, branch);
}

/* Whether the line leaves that of its first HELD_PART alone there, which it becomes then. */
static int was_pulled(const asj_context *context, const asj_frame *frame, const asj_hypothesis *hypothesis, double first,
                      asj_hypothesis_branch *branch)
{
    asj_hypothesis_branch held = *branch;
    if (!fit_part(context, frame, hypothesis, first, HELD_PART, &held))
        return 0;
    const double begin = held.offset - branch->offset, end = begin + HELD_PART * sin(held.angle - branch->angle);
    if (fmax(fabs(begin), fabs(end)) <= fmax(PULLED, PULLED_SURELY * sqrt(held.offset_variance)))
        return 0;
    *branch = held;
    return 1;
}

/* The line over the whole branch, which asj_orient() has found roughly. Long branches are fitted over growing parts, each twice as
 * long as the one before, so that the narrow band around the last line always holds the edge. When a part longer than NEAR_PART
 * moves the line significantly where it passes the junction, the edge is bent (lenses do that): then the shorter part is
 * believed. So is HELD_PART of what an edge beside it pulls away, but for presets that take weak corners: their scans end where
 * they like, and matches of what is hardly there come and go with every change. */
static void follow_line(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                        const asj_hypothesis *hypothesis, asj_hypothesis_branch *branch)
{
    const double first = first_px(branch), end = last_px(branch);
    asj_hypothesis_branch longer = *branch;
    for (double reach = NEAR_PART;; reach *= 2) {
        const double last = fmin(end, reach);
        if (!fit_part(context, frame, hypothesis, first, last, &longer) ||
            (reach > NEAR_PART && fabs(longer.offset - branch->offset) > BENT * sqrt(branch->offset_variance)))
            return;
        *branch = longer;
        if ((reach <= NEAR_PART && options->strip_test && last > HELD_FROM &&
             was_pulled(context, frame, hypothesis, first, branch)) ||
            reach >= end)
            return;
    }
}

void asj_refine(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis)
{
    hypothesis->explained = 0;
    if (options->refinement == ASJ_REFINE_SEARCH)
        return; /* that is done (search_step.c) */
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        follow_line(context, frame, options, hypothesis, &hypothesis->branches[i]);
    asj_locate_meet(frame, options, hypothesis);
    asj_blurred_corner(context, frame, hypothesis);
}

/* The line over the whole branch, roughly: guessed over parts that grow from one at whose end it is known to a pixel, and once more
 * unless that would move it no further. */
static void find_line(const asj_context *context, const asj_frame *frame, const asj_hypothesis *hypothesis,
                      asj_hypothesis_branch *branch)
{
    const double end = last_px(branch), uncertainty = sqrt(branch->angle_variance);
    asj_rough_line line = asj_rough_line_of(branch);
    double reach = NEAR_PART / 4;
    while (reach < end && 2 * reach * uncertainty < 1)
        reach *= 2;
    for (int32_t rounds = 0; rounds < 2; reach *= 2) {
        const double t[2] = {first_px(branch), fmin(end, reach)};
        const asj_rough_line before = line;
        if (!asj_line_guess(context->ops->line, frame, hypothesis->x, hypothesis->y, t, WIDE, &line))
            break;
        const double turn = fabs(before.ux * line.uy - before.uy * line.ux); /* its sine */
        rounds += reach < end ? 0 : turn * end > SETTLED ? 1 : 2;
    }
    asj_rough_line_keep(&line, branch);
}

void asj_orient(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        asj_hypothesis_branch *branch = &hypothesis->branches[i];
        find_line(context, frame, hypothesis, branch);
        asj_turn_to_edge(context, frame, options, hypothesis, first_px(branch), fmin(last_px(branch), NEAR_PART / 2), branch);
    }
    asj_locate_meet(frame, options, hypothesis);
}
