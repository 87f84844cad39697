/* SPDX-License-Identifier: BSD-2-Clause */
/* Octaves. The paper looks at one scale. Edges blurred by 2 px or more fall through that: their gradient spreads over more pixels
 * than a sector is wide, and noise, which does not, drowns it. On the image halved (means of 2 x 2 pixels) such an edge is half as
 * wide and the noise half as strong, so the same steps find there what they miss here. Pixel (i, j) of octave o is centred at
 *     x = (i + 0.5) 2^o - 0.5,  y likewise.
 *
 * Octave -1, when it is asked for, works on the image upsampled by two (core/upsample.c): the same formula. Corners with branches
 * of fewer pixels than a sector needs are found there.
 *
 * With half_octaves there is one half-way between two: the same formula for o + 1/2, made of octave o (core/half_octave.c). What is
 * too soft or too weak for an octave, and too small for the next one, is found between them: corners of 5 grey levels .966 for
 * .820, in 1.5 times the time.
 *
 * Which octave an edge belongs to is decided by its own width (edge_width.c), not by which octave fired first: lines that are
 * fitted to edges wider than the fits look follow noise, and corners of them are off by pixels.
 *   - a branch wider than WIDEST is dropped: a coarser octave sees it, or nothing does (a gradient of light);
 *   - a junction that two branches narrower than SHARP make is located by the finest octave that found it;
 *   - others give way to the next coarser octave, and stay when that has found nothing.
 * Each octave counts its own tests, times the number of octaves: an n-th of the false alarms that epsilon allows for each, so that
 * all of them together have no more than epsilon. (Counting the pixels of all octaves in each says the same of them together, but
 * asks of coarse octaves, which have few pixels, as much as of the image itself.)
 *
 * Junctions of two octaves are one when they are closer than NEAR px of the coarser octave and have a direction in common. The one
 * that stays gets the other's branches that were too soft for its own octave to see; and sharp ones beyond doubt (FAINT_NFA; with
 * complete_junctions any), which are too faint for its own octave, in which there is more noise: where walls meet in even light.
 * Ghosts go: octave_ghosts.c.
 *
 * With independent_octaves nothing of this is done: each octave is a detector of its own, with its own false alarms, whose branches
 * end at its own junctions, and all junctions are listed. So the list without coarser octaves is a part of the list with them. */
#include "octaves.h"
#include "complete.h"
#include "octave_ghosts.h"
#include "core/angle.h"
#include "core/sort.h"

#include <math.h>

#define LEAST_SIDE 48 /* px of an octave: twice the largest of the default radii to either side, and something between */

#define SHARP 1.7  /* px of its octave: from here on an edge is sharp (below 0.9) in the next one */
#define WIDEST 2.7 /* px: beyond, the band of the fits (1.6 px to either side) holds less than half of the edge */

#define NEAR 2.5                  /* px of the coarser octave */
#define SAME_DIRECTION 0.3        /* rad */
#define JOINED_OFF 1.5            /* px of the coarser octave: the line of a soft branch passes the junction at most so far away */
#define FAINT_OFF 0.3             /* the same of a sharp one: of 138 that 1.5 has join in 30 rooms 107 are left, hardly any false */

/* Natural logarithm. Rendered rooms: true edges with a line .952 -> .962, from end to end .920 -> .926, lines that are true as
 * before; and in a photograph the 584 px in which two walls meet. From 1e-10 to 1e-30 that is the same. */
#define FAINT_NFA (-30 * ASJ_LN_10)

/* How many there are. */
static int32_t count_octaves(int32_t width, int32_t height)
{
    int32_t count = 1;
    while (width >> count >= LEAST_SIDE && height >> count >= LEAST_SIDE)
        count++;
    return count;
}

asj_octave_range asj_octaves_of(const asj_detect_options *options, int32_t width, int32_t height)
{
    const int32_t count = count_octaves(width, height);
    asj_octave_range range = {options->first_octave < count ? options->first_octave : count - 1, 0, 0, 0};
    range.end = count - range.first < options->octaves ? count : range.first + options->octaves;
    const double step = options->half_octaves ? 0.5 : 1;
    for (double o = range.first; o <= range.end - 1; o += step, range.count++)
        range.pixels += (double)asj_octave_size(width, o) * asj_octave_size(height, o);
    return range;
}

void asj_octaves_map(asj_hypothesis *hypothesis, double octave)
{
    const double scale = asj_octave_scale(octave);
    asj_hypothesis_scale(hypothesis, scale, scale, scale);
    hypothesis->octave = octave;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        hypothesis->branches[i].octave = octave;
}

int32_t asj_octaves_sharing(const asj_detect_options *options, int32_t width, int32_t height)
{
    return options->independent_octaves ? 1 : asj_octaves_of(options, width, height).count;
}

/* Of the two sharpest branches the less sharp one, px of the octave: two make a junction. */
static double softness(const asj_hypothesis *hypothesis)
{
    double first = HUGE_VAL, second = HUGE_VAL;
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        const double width = hypothesis->branches[i].is_another ? HUGE_VAL : hypothesis->branches[i].width;
        second = width < first ? first : fmin(second, width);
        first = fmin(first, width);
    }
    return second;
}

/* Sharp ones first, of these the finest octave first; of the others the coarsest. Ties by meaning and place. */
static int by_preference(const void *a, const void *b)
{
    const asj_hypothesis *p = a, *q = b;
    const int soft = softness(p) > SHARP, other = softness(q) > SHARP;
    if (soft != other)
        return soft - other;
    if (p->octave != q->octave)
        return soft == (p->octave > q->octave) ? -1 : 1;
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p->x < q->x ? -1 : p->x > q->x;
}

/* Whether the branches that said where it is make a junction. */
static int makes_junction(const asj_hypothesis *hypothesis, double minimum_opening)
{
    asj_hypothesis first = *hypothesis;
    int keep[ASJ_MAX_BRANCHES];
    for (int32_t b = 0; b < first.branch_count; b++)
        keep[b] = !first.branches[b].is_another;
    asj_hypothesis_select(&first, keep);
    return asj_hypothesis_has_opening(&first, minimum_opening * ASJ_DEGREE);
}

static size_t drop_wide(asj_hypothesis *hypotheses, size_t count, double minimum_opening)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        int keep[ASJ_MAX_BRANCHES];
        for (int32_t b = 0; b < hypotheses[i].branch_count; b++)
            keep[b] = hypotheses[i].branches[b].width <= WIDEST;
        asj_hypothesis_select(&hypotheses[i], keep);
        if (makes_junction(&hypotheses[i], minimum_opening))
            hypotheses[kept++] = hypotheses[i];
    }
    return kept;
}

static int share_direction(const asj_hypothesis *a, const asj_hypothesis *b)
{
    for (int32_t i = 0; i < a->branch_count; i++)
        for (int32_t j = 0; j < b->branch_count; j++)
            if (asj_angle_distance(a->branches[i].angle, b->branches[j].angle) < SAME_DIRECTION)
                return 1;
    return 0;
}

/* The nearest of those that stay which is the same junction in another octave; -1 = none. */
static int32_t find_same(const asj_octave_grid *grid, const asj_hypothesis *hypotheses, const asj_hypothesis *hypothesis)
{
    const double coarsest = grid->coarsest > hypothesis->octave ? grid->coarsest : hypothesis->octave;
    const asj_octave_cells w = asj_octave_grid_around(grid, hypothesis, NEAR * asj_octave_scale(coarsest));
    double least = HUGE_VAL;
    int32_t found = -1;
    for (int32_t row = w.top; row <= w.bottom; row++)
        for (int32_t column = w.left; column <= w.right; column++)
            for (int32_t i = grid->heads[row * grid->columns + column]; i >= 0; i = grid->next[i]) {
                const asj_hypothesis *other = &hypotheses[i];
                const double coarser = other->octave > hypothesis->octave ? other->octave : hypothesis->octave;
                const double reach = NEAR * asj_octave_scale(coarser);
                const double distance = hypot(other->x - hypothesis->x, other->y - hypothesis->y);
                if (other->octave != hypothesis->octave && distance <= reach && distance < least &&
                    share_direction(other, hypothesis)) {
                    least = distance;
                    found = i;
                }
            }
    return found;
}

/* Whether a branch of a coarser octave, whose offset is that from the junction, may be one of it. */
static int may_join(const asj_hypothesis_branch *branch, const asj_detect_options *options, const asj_hypothesis *hypothesis)
{
    const double scale = asj_octave_scale(branch->octave);
    const int soft = branch->width * scale > SHARP * asj_octave_scale(hypothesis->octave);
    return fabs(branch->offset) <= (soft ? JOINED_OFF : FAINT_OFF) * scale &&
           (soft || branch->log_nfa <= FAINT_NFA || asj_complete_is_asked(options));
}

/* Adds the branches of a coarser octave that are too soft for the octave of `hypothesis`, or too faint. */
static void join(const asj_hypothesis *coarse, const asj_detect_options *options, asj_hypothesis *hypothesis)
{
    const double dx = hypothesis->x - coarse->x, dy = hypothesis->y - coarse->y;
    for (int32_t i = 0; i < coarse->branch_count && hypothesis->branch_count < ASJ_MAX_BRANCHES; i++) {
        asj_hypothesis_branch branch = coarse->branches[i];
        const double ux = cos(branch.angle), uy = sin(branch.angle);
        branch.offset -= dy * ux - dx * uy;
        branch.length -= dx * ux + dy * uy;
        if (may_join(&branch, options, hypothesis) && branch.length > 0 && branch.length >= options->minimum_length &&
            asj_hypothesis_is_free(hypothesis, branch.angle, asj_joined_apart(options)))
            asj_hypothesis_insert(hypothesis, &branch);
    }
}

size_t asj_octaves_merge(asj_hypothesis *hypotheses, size_t count, const asj_detect_options *options, int32_t width, int32_t height,
                         int32_t *cells)
{
    asj_octave_grid grid = asj_octave_grid_start(width, height, cells);
    size_t kept = 0;
    count = drop_wide(hypotheses, count, options->minimum_opening);
    if (count > 1)
        asj_sort(hypotheses, count, sizeof *hypotheses, by_preference);
    for (size_t i = 0; i < count; i++) {
        const asj_hypothesis hypothesis = hypotheses[i];
        const int32_t same = find_same(&grid, hypotheses, &hypothesis);
        if (same >= 0 && hypothesis.octave > hypotheses[same].octave)
            join(&hypothesis, options, &hypotheses[same]);
        if (same >= 0 || asj_octave_ghost(&grid, hypotheses, &hypothesis, options->minimum_opening))
            continue;
        hypotheses[kept] = hypothesis;
        asj_octave_grid_add(&grid, hypotheses, kept++);
    }
    return kept;
}

/* Whether join() would surely take no branch. */
static int adds_nothing(const asj_hypothesis *hypothesis, const asj_hypothesis *finer)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        if (asj_hypothesis_is_free(finer, hypothesis->branches[i].angle, ASJ_JOINED_APART))
            return 0;
    return 1;
}

static int is_at_finer(const asj_octave_known *known, const asj_hypothesis *hypothesis)
{
    const asj_octave_grid *grid = &known->grid;
    const asj_hypothesis *finer = known->finer;
    const double reach = NEAR * asj_octave_scale(hypothesis->octave);
    const asj_octave_cells w = asj_octave_grid_around(grid, hypothesis, reach);
    for (int32_t row = w.top; row <= w.bottom; row++)
        for (int32_t column = w.left; column <= w.right; column++)
            for (int32_t i = grid->heads[row * grid->columns + column]; i >= 0; i = grid->next[i])
                if (hypot(finer[i].x - hypothesis->x, finer[i].y - hypothesis->y) <= reach &&
                    share_direction(hypothesis, &finer[i]) && adds_nothing(hypothesis, &finer[i]))
                    return 1;
    return 0;
}

asj_octave_known asj_octave_known_start(const asj_hypothesis *finer, size_t count, double octave, const asj_detect_options *options,
                                        int32_t width, int32_t height, int32_t *cells)
{
    asj_octave_known known = {asj_octave_grid_start(width, height, cells), finer, octave, options};
    for (size_t i = 0; i < count; i++)
        if (softness(&finer[i]) <= SHARP)
            asj_octave_grid_add(&known.grid, finer, i);
    return known;
}

int asj_octave_is_known(const asj_octave_known *known, const asj_hypothesis *hypothesis, int what)
{
    if (!known->finer)
        return 0;
    asj_hypothesis mapped = *hypothesis;
    asj_octaves_map(&mapped, known->octave);
    return is_at_finer(known, &mapped) ||
           (what == ASJ_KNOWN_LINES && asj_octave_ghost(&known->grid, known->finer, &mapped, known->options->minimum_opening));
}
