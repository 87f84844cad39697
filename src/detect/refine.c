/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: orientation (paper, end of section "Junction Detection").
 *
 * line_fit (default): the line fit of line_fit.c over t = 5 .. L - 3 (less for short branches), then the meeting point of all
 * lines. The first pixels are left out because blur bends edges inwards at a corner. About three times as accurate as the search
 * and a hundred times cheaper.
 *
 * search: the paper's  argmax_theta sum of gamma over S_p(r_theta, theta),  over theta +- 0.1 rad. The sector of scale r has
 * constant width 2 tau, so its number of pixels J differs from angle to angle; what is maximised is the normalised
 * (omega - J mu) / (sigma sqrt(J)), as the sum itself would prefer angles with more pixels. */
#include "refine.h"
#include "line_fit.h"
#include "locate.h"
#include "nfa.h"
#include "strip.h"

#include <math.h>

#define PI 3.141592653589793
#define BENT 3       /* standard uncertainties */
#define NEAR_PART 80   /* px */
#define SETTLED 0.1    /* px at the end of a branch */
#define WIDE 2         /* px: half-width of the band in which a line is looked for */
#define HALF_WIDTH 1.6 /* and of that in which it is fitted last */
#define DOUBT 6         /* natural logarithm of a number of false alarms */
#define OPENING_DOUBT 5 /* degrees */
#define LARGEST_OFFSET 2 /* px: a line that misses the junction by more belongs to something else */

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

static void search(const asj_frame *frame, const asj_detect_options *options, asj_draft *draft)
{
    for (int32_t i = 0; i < draft->branch_count; i++) {
        asj_draft_branch *branch = &draft->branches[i];
        const double start = branch->angle, length = fmax(branch->length, 3);
        double best = -HUGE_VAL;
        for (int step = -20; step <= 20; step++) {
            double angle = start + 0.005 * step;
            double strength = sector_strength(frame, draft->x, draft->y, angle, length, options->sector_width);
            if (strength > best) {
                best = strength;
                branch->angle = asj_angle_wrap(angle);
            }
        }
    }
}

/* The part of a branch that its line is fitted to. */
static double first_px(const asj_draft_branch *branch)
{
    return fmin(5, 0.25 * branch->length + 0.5);
}

static double last_px(const asj_draft_branch *branch)
{
    return fmax(branch->length - 3, 8);
}

/* The line over the whole branch, which asj_orient() has found roughly. Long branches are fitted over growing parts, each twice as
 * long as the one before, so that the narrow band around the last line always holds the edge. When a part longer than NEAR_PART
 * moves the line significantly where it passes the junction, the edge is bent (lenses do that): then the shorter part is
 * believed. */
static void follow_line(const asj_context *context, const asj_frame *frame, const asj_draft *draft, asj_draft_branch *branch)
{
    const double first = first_px(branch), end = last_px(branch);
    asj_draft_branch longer = *branch;
    for (double reach = NEAR_PART;; reach *= 2) {
        const double last = fmin(end, reach), t[2] = {first, last};
        const asj_line_range range = {first, last, {WIDE, HALF_WIDTH, 0}, 2};
        asj_rough_line line = asj_rough_line_of(&longer);
        if (!asj_line_guess(context->ops->line, frame, draft->x, draft->y, t, WIDE, &line))
            return;
        asj_rough_line_keep(&line, &longer);
        if (!asj_line_fit(context->ops->line, frame, draft->x, draft->y, &range, &longer) ||
            (reach > NEAR_PART && fabs(longer.offset - branch->offset) > BENT * sqrt(branch->offset_variance)))
            return;
        *branch = longer;
        if (reach >= end)
            return;
    }
}

void asj_refine(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft)
{
    if (options->refinement == ASJ_REFINE_SEARCH) {
        search(frame, options, draft);
        return;
    }
    for (int32_t i = 0; i < draft->branch_count; i++)
        follow_line(context, frame, draft, &draft->branches[i]);
    asj_locate_meet(draft);
}

/* The line over the whole branch, roughly: guessed over parts that grow from one at whose end it is known to a pixel, and once more
 * unless that would move it no further. */
static void find_line(const asj_context *context, const asj_frame *frame, const asj_draft *draft, asj_draft_branch *branch)
{
    const double end = last_px(branch), uncertainty = sqrt(branch->angle_variance);
    asj_rough_line line = asj_rough_line_of(branch);
    double reach = NEAR_PART / 4;
    while (reach < end && 2 * reach * uncertainty < 1)
        reach *= 2;
    for (int32_t rounds = 0; rounds < 2; reach *= 2) {
        const double t[2] = {first_px(branch), fmin(end, reach)};
        const asj_rough_line before = line;
        if (!asj_line_guess(context->ops->line, frame, draft->x, draft->y, t, WIDE, &line))
            break;
        const double turn = fabs(before.ux * line.uy - before.uy * line.ux); /* its sine */
        rounds += reach < end ? 0 : turn * end > SETTLED ? 1 : 2;
    }
    asj_rough_line_keep(&line, branch);
}

void asj_orient(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft)
{
    if (options->refinement == ASJ_REFINE_SEARCH) {
        search(frame, options, draft);
        return;
    }
    for (int32_t i = 0; i < draft->branch_count; i++)
        find_line(context, frame, draft, &draft->branches[i]);
    asj_locate_meet(draft);
}

/* A branch that runs along the border of the image, no farther from it than a gradient reaches, is the frame of the picture (a
 * scan's margin, a resampling filter's ringing), not an edge of the scene. */
static int on_frame(const asj_frame *frame, const asj_draft *draft, const asj_draft_branch *branch)
{
    const double reach = 2.5; /* px */
    const double x = draft->x + branch->length * cos(branch->angle), y = draft->y + branch->length * sin(branch->angle);
    return fmax(draft->x, x) <= reach || fmax(draft->y, y) <= reach ||
           fmin(draft->x, x) >= frame->width - 1 - reach || fmin(draft->y, y) >= frame->height - 1 - reach;
}

/* Of two branches closer than merge_angle the more meaningful one stays; of those that lie on one line, the stronger one. */
static int less_meaningful(const asj_draft_branch *a, const asj_draft_branch *b)
{
    const double same = 1e-3; /* decades of what rounding makes of one line */
    return fabs(a->log_nfa - b->log_nfa) > same ? a->log_nfa > b->log_nfa : a->strength < b->strength;
}

static void merge(const asj_detect_options *options, const asj_draft *draft, int *keep)
{
    const double least = options->merge_angle * (PI / 180);
    for (int32_t i = 0; i < draft->branch_count; i++)
        for (int32_t j = i + 1; j < draft->branch_count; j++) {
            const asj_draft_branch *a = &draft->branches[i], *b = &draft->branches[j];
            if (keep[i] && keep[j] && asj_angle_distance(a->angle, b->angle) < least)
                keep[less_meaningful(a, b) ? i : j] = 0;
        }
}

/* Whether a strip of some length is meaningful, or nearly so: the angle will still become better. */
static int hopeful(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, const asj_draft *draft,
                   const asj_draft_branch *branch)
{
    const double limit = log(options->epsilon) + DOUBT, x = draft->x, y = draft->y, angle = branch->angle;
    return asj_strip_passes(context, frame, options, x, y, angle, 20, 12, limit) || /* px: most that are meaningful are so at 20 */
           asj_strip_passes(context, frame, options, x, y, angle, 50, 8, limit);
}

static int has_opening(const asj_detect_options *options, const asj_draft *draft, const int *keep)
{
    asj_draft rest = *draft;
    asj_draft_select(&rest, keep);
    return asj_draft_has_opening(&rest, fmax(options->minimum_opening - OPENING_DOUBT, 0) * (PI / 180));
}

/* As soon as no two branches that may be left open, the draft is none. */
void asj_foresee(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft)
{
    int keep[ASJ_MAX_BRANCHES];
    if (!options->strip_test)
        return;
    for (int32_t i = 0; i < draft->branch_count; i++)
        keep[i] = 1;
    int opens = has_opening(options, draft, keep);
    for (int32_t i = 0; i < draft->branch_count && opens; i++) {
        keep[i] = hopeful(context, frame, options, draft, &draft->branches[i]);
        opens = keep[i] || has_opening(options, draft, keep);
    }
    asj_draft_select(draft, keep);
    draft->branch_count = opens ? draft->branch_count : 0;
}

/* Lines over whole branches may move the junction as far again as those of the first fit (locate.c); what moves farther has drifted
 * to another edge. */
void asj_validate(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft)
{
    const double log_epsilon = log(options->epsilon);
    int keep[ASJ_MAX_BRANCHES];
    if (hypot(draft->x - draft->x0, draft->y - draft->y0) > 2 * options->max_move) {
        draft->branch_count = 0;
        return;
    }
    for (int32_t i = 0; i < draft->branch_count; i++) {
        asj_draft_branch *branch = &draft->branches[i];
        const asj_strip strip = asj_strip_test(context, frame, options, draft->x, draft->y, branch->angle, branch->length);
        branch->log_nfa = strip.log_nfa;
        keep[i] = branch->length >= options->minimum_length && branch->length > 0 && fabs(branch->offset) <= LARGEST_OFFSET &&
                  (!options->strip_test || strip.log_nfa <= log_epsilon) &&
                  strip.near_strength >= options->near_strength &&
                  !(options->ignore_frame && on_frame(frame, draft, branch));
    }
    merge(options, draft, keep);
    asj_draft_select(draft, keep);
    if (!asj_draft_has_opening(draft, options->minimum_opening * (PI / 180))) {
        draft->branch_count = 0;
        return;
    }
    for (int32_t i = 1; i < draft->branch_count; i++) {
        asj_draft_branch moved = draft->branches[i];
        int32_t j = i;
        for (; j > 0 && draft->branches[j - 1].angle > moved.angle; j--)
            draft->branches[j] = draft->branches[j - 1];
        draft->branches[j] = moved;
    }
}
