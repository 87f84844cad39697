/* SPDX-License-Identifier: BSD-2-Clause */
/* Validation. A branch is reported when it is long enough, its line passes the junction, the strip along it is meaningful
 * (strip.c) and reaches the junction, and no better branch points the same way; a junction, when two of its branches open and it
 * would be found again (steady.c), which edges that a branch crosses instead of following one (tilt.c) make less likely. In coarse
 * octaves two branches may be meaningful together. */
#include "validate.h"
#include "blurred_corner.h"
#include "core/angle.h"
#include "curvature.h"
#include "locate.h"
#include "steady.h"
#include "strip.h"
#include "tilt.h"

#include <math.h>

/* asj_reject_early(): strips that are tried, px, each with the shorter one that comes for nothing. Most branches that are
 * meaningful at all are so at 20 px. */
#define EARLY_LENGTH 20.0
#define EARLY_SHORTER 12.0
#define EARLY_LONGER 50.0
#define EARLY_SHORTEST 8.0

/* And its slack of angles, beside that of meaning (validate.h): degrees. */
#define EARLY_OPENING 5.0

/* asj_reject_oriented(): of 2987 hypotheses of six photographs whose branches were oriented 1938 failed in the end. This finds 590
 * of them, and 3 of the others; with a slack of .25 sd 630 and 6. */
#define ORIENTED_STRENGTH 0.5 /* sd of near_strength, .. */
#define ORIENTED_MOVE 0.5     /* .. px of what a junction may move */

#define LARGEST_OFFSET 2.0 /* px: a line that misses the junction by more belongs to something else */

/* The same where the line has no say in where the junction is. So many directions are looked at for such branches, and so much lies
 * around a corner, that epsilon is not enough: in five photographs most that look false have an NFA above 1e-5. */
#define LARGEST_OFFSET_OF_ANOTHER 0.5 /* px */
#define ANOTHER_LOG (5 * ASJ_LN_10)

/* A soft edge's end is uncertain by its width, and what a scan goes beyond a short one drowns it. So of edges wider than SOFT a
 * strip without the last SOFT_END widths is tried too; the number of tests counts all ends. Not on the image itself: there such
 * edges may be blurred noise, and true ones are sharper in the next octave. */
#define SOFT 0.9     /* px */
#define SOFT_END 4.0

/* A sharp edge that reaches the junction is there what it is farther on. Coarse octaves, in which little noise is left, ask for
 * this share of it: 0.8 to 1.2 are found at corners, 0 to 0.4 where edges only seem to meet. */
#define LEAST_SHARE 0.45

/* In the image itself noise and other branches make the first px of a true branch weaker than that, and an edge that passes 3 px
 * from the junction lends it 0.2 to 0.35. So a branch with less than this share is none of two that make a junction; of one that
 * others make it is a branch. */
#define LEAST_IMAGE_SHARE 0.38

/* Two branches together. Where both are short and weak neither strip may be meaningful by itself, though a junction of both is one
 * place with two ends: of two strips with tails F_i, F_j there are NM (sqrt(NM))^2 octaves tests, so
 *     NFA = (NM)^2 octaves F_i F_j = NFA_i NFA_j / (NM octaves),      NFA_i = (NM)^(3/2) octaves F_i (strip.c).
 * Two that open are kept if that is at most epsilon / exp(PAIR_LOG), and either NFA is at most epsilon sqrt(NM), a limit of its
 * own, below what the place would allow each when it is given (epsilon NM octaves), so that no sure branch carries what is none.
 * The directions of two are not the same test any more: PAIR_LOG stands for them (a hundred). Only of sharp edges in coarse
 * octaves, where little noise is left and short branches are long edges. Corners of 5 grey levels in noise of 2 (tests/accuracy):
 * recall .628 -> .817, precision .997 -> .997. With soft edges too, at blur 5 and 25 grey levels, precision falls from .955 to
 * .928; but where a blurred corner explains what is there it stays. */
#define PAIR_LOG (2 * ASJ_LN_10)

enum { NOT_AT_ALL, IF_OTHERS_OPEN, WITH_OTHERS, ALONE }; /* 0 = may not be left */

static double log_places(const asj_frame *frame)
{
    return log((double)frame->width * frame->height);
}

/* Whether the branch reaches the junction. */
static int reaches(const asj_frame *frame, const asj_detect_options *options, const asj_hypothesis_branch *branch,
                   const asj_strip *strip)
{
    const int sharp = frame->octave > 0 && branch->width <= SOFT && branch->apart <= 0;
    return strip->near_strength >= options->near_strength && !(sharp && options->strip_test && strip->near_share < LEAST_SHARE);
}

/* px: two pixels of a gradient's differences, and half a pixel */
#define FRAME_REACH 2.5

/* A branch that runs along the border of the image, no farther from it than a gradient reaches, is the frame of the picture (a
 * scan's margin, a resampling filter's ringing), not an edge of the scene. */
static int on_frame(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    const double x = hypothesis->x + branch->length * cos(branch->angle), y = hypothesis->y + branch->length * sin(branch->angle);
    return fmax(hypothesis->x, x) <= FRAME_REACH || fmax(hypothesis->y, y) <= FRAME_REACH ||
           fmin(hypothesis->x, x) >= frame->width - 1 - FRAME_REACH || fmin(hypothesis->y, y) >= frame->height - 1 - FRAME_REACH;
}

/* Of two branches closer than merge_angle the more meaningful one stays; of those that lie on one line, the stronger one. */
static int less_meaningful(const asj_hypothesis_branch *a, const asj_hypothesis_branch *b)
{
    const double same = 1e-3; /* of a natural logarithm: what rounding makes of one line */
    return fabs(a->log_nfa - b->log_nfa) > same ? a->log_nfa > b->log_nfa : a->strength < b->strength;
}

static void merge(const asj_detect_options *options, const asj_hypothesis *hypothesis, int *keep)
{
    const double least = options->merge_angle * ASJ_DEGREE;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        for (int32_t j = i + 1; j < hypothesis->branch_count; j++) {
            const asj_hypothesis_branch *a = &hypothesis->branches[i], *b = &hypothesis->branches[j];
            if (keep[i] && keep[j] && asj_angle_distance(a->angle, b->angle) < least)
                keep[less_meaningful(a, b) ? i : j] = 0;
        }
}

/* A hypothesis whose branches are asked whether they may be left. */
typedef struct inquiry {
    const asj_context *context;
    const asj_frame *frame;
    const asj_detect_options *options;
    asj_hypothesis *hypothesis;
    asj_strip *strips; /* along each branch, whole: what judge() leaves behind; NULL: the question is another one */
} inquiry;

/* What is asked of branch `number`, and whether it may be left. */
typedef int (*question)(const inquiry *about, int32_t number);

/* Whether a strip of some length is meaningful, or nearly so: the angle will still become better. */
static int may_be_meaningful(const inquiry *about, int32_t number)
{
    const asj_hypothesis *hypothesis = about->hypothesis;
    const double angle = hypothesis->branches[number].angle, limit = log(about->options->epsilon) + ASJ_EARLY_LOG_NFA;
    const asj_strip_line line = {hypothesis->x, hypothesis->y, angle, EARLY_LENGTH};
    const asj_strip_line longer = {hypothesis->x, hypothesis->y, angle, EARLY_LONGER};
    return asj_strip_passes(about->context, about->frame, about->options, &line, EARLY_SHORTER, limit) ||
           asj_strip_passes(about->context, about->frame, about->options, &longer, EARLY_SHORTEST, limit);
}

static double early_opening(const asj_detect_options *options)
{
    return fmax(options->minimum_opening - EARLY_OPENING, 0) * ASJ_DEGREE;
}

/* Asks the branches, the weakest first, as long as two of those that may be left open by `least` radians; returns whether they
 * do. */
static int ask_all(const inquiry *about, question ask, double least, int *answers)
{
    const asj_hypothesis *hypothesis = about->hypothesis;
    const int32_t count = hypothesis->branch_count;
    const asj_hypothesis_branch *branches = hypothesis->branches;
    int32_t order[ASJ_MAX_BRANCHES] = {0};
    for (int32_t i = 0; i < count; i++) {
        int32_t k = i;
        for (; k > 0 && branches[order[k - 1]].strength > branches[i].strength; k--)
            order[k] = order[k - 1];
        order[k] = i;
    }
    for (int32_t i = 0; i < ASJ_MAX_BRANCHES; i++)
        answers[i] = 1;
    int opens = asj_hypothesis_opens(hypothesis, answers, least);
    for (int32_t k = 0; k < count && opens; k++) {
        answers[order[k]] = ask(about, order[k]);
        opens = answers[order[k]] || asj_hypothesis_opens(hypothesis, answers, least);
    }
    return opens;
}

void asj_reject_early(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                      asj_hypothesis *hypothesis)
{
    int keep[ASJ_MAX_BRANCHES];
    if (!options->strip_test)
        return;
    const inquiry about = {context, frame, options, hypothesis, NULL};
    const int opens = ask_all(&about, may_be_meaningful, early_opening(options), keep);
    asj_hypothesis_select(hypothesis, keep);
    hypothesis->branch_count = opens ? hypothesis->branch_count : 0;
}

/* It may move by max_move at least, whatever its directions are: most have moved by less. */
static int has_moved_far(const asj_detect_options *options, const asj_hypothesis *hypothesis, double slack)
{
    const double moved = hypot(hypothesis->x - hypothesis->x0, hypothesis->y - hypothesis->y0);
    return moved > options->max_move + options->max_move + slack &&
           moved > options->max_move + asj_locate_most_move(options, hypothesis) + slack;
}

/* Whether it seems to reach the junction. Ends of soft edges are uncertain. */
static int may_reach(const inquiry *about, int32_t number)
{
    const asj_hypothesis_branch *branch = &about->hypothesis->branches[number];
    const asj_strip_line line = {about->hypothesis->x, about->hypothesis->y, branch->angle, branch->length};
    const double least = about->options->near_strength - ORIENTED_STRENGTH;
    return branch->width > SOFT || asj_strip_near_strength(about->context, about->frame, about->options, &line) >= least;
}

void asj_reject_oriented(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         asj_hypothesis *hypothesis)
{
    int keep[ASJ_MAX_BRANCHES];
    if (!options->strip_test || hypothesis->branch_count < 2) /* those of complete_step.c have one */
        return;
    const inquiry about = {context, frame, options, hypothesis, NULL};
    const int opens = ask_all(&about, may_reach, early_opening(options), keep);
    asj_hypothesis_select(hypothesis, keep);
    if (!opens || has_moved_far(options, hypothesis, ORIENTED_MOVE))
        hypothesis->branch_count = 0;
}

/* px of the frame's octave for those of the image that minimum_length has. */
static double least_length(const asj_frame *frame, const asj_detect_options *options)
{
    return options->minimum_length / asj_octave_scale(frame->octave);
}

/* Returns whether the branch is to be kept, ALONE, only WITH_OTHERS, IF_OTHERS_OPEN; sets its number of false alarms then. */
static int judge(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                 const asj_hypothesis *hypothesis, asj_hypothesis_branch *branch, asj_strip *strip)
{
    const double log_epsilon = log(options->epsilon), explained = hypothesis->explained;
    asj_strip_line line = {hypothesis->x, hypothesis->y, branch->angle, branch->length};
    if (branch->length < least_length(frame, options) || branch->length <= 0 || fabs(branch->offset) > LARGEST_OFFSET ||
        (options->ignore_frame && on_frame(frame, hypothesis, branch)))
        return NOT_AT_ALL;
    *strip = asj_strip_test(context, frame, options, &line);
    branch->log_nfa = options->strip_test ? asj_strip_correlated(frame, strip, branch->width, explained) : strip->log_nfa;
    if (options->strip_test && branch->log_nfa > log_epsilon && frame->octave > 0 && branch->width > SOFT) {
        line.length -= SOFT_END * branch->width;
        const asj_strip shorter = asj_strip_test(context, frame, options, &line);
        branch->log_nfa = fmin(branch->log_nfa, asj_strip_correlated(frame, &shorter, branch->width, explained));
    }
    if (!reaches(frame, options, branch, strip) || (!options->strip_test && asj_is_tilted(options, &strip->sums)))
        return NOT_AT_ALL;
    if (!options->strip_test || branch->log_nfa <= log_epsilon)
        return options->strip_test && frame->octave <= 0 && strip->near_share < LEAST_IMAGE_SHARE ? IF_OTHERS_OPEN : ALONE;
    const int pairs = frame->octave > 0 && (branch->width <= SOFT || asj_blurred_corner_is_sure(hypothesis));
    return pairs && branch->log_nfa <= log_epsilon + 0.5 * log_places(frame) ? WITH_OTHERS : NOT_AT_ALL;
}

static int judge_one(const inquiry *about, int32_t number)
{
    return judge(about->context, about->frame, about->options, about->hypothesis, &about->hypothesis->branches[number],
                 &about->strips[number]);
}

/* keep[i] = 0 or 1, from what judge() says: of the branches that are meaningful only WITH_OTHERS those that are so with another
 * one that opens, and those of a junction that others make. */
static void judge_pairs(const asj_frame *frame, const asj_detect_options *options, const asj_hypothesis *hypothesis, int *keep)
{
    const double limit = log(options->epsilon) + log(frame->octaves) + log_places(frame) - PAIR_LOG;
    const double least = options->minimum_opening * ASJ_DEGREE;
    const int32_t count = hypothesis->branch_count;
    int verdict[ASJ_MAX_BRANCHES];
    for (int32_t i = 0; i < count; i++) {
        verdict[i] = keep[i];
        keep[i] = verdict[i] == ALONE;
    }
    const int opens = asj_hypothesis_opens(hypothesis, keep, least);
    for (int32_t i = 0; i < count; i++)
        keep[i] |= verdict[i] == IF_OTHERS_OPEN && opens;
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = 0; j < count && !keep[i]; j++) {
            const asj_hypothesis_branch *a = &hypothesis->branches[i], *b = &hypothesis->branches[j];
            const double turn = asj_angle_distance(a->angle, b->angle);
            keep[i] = j != i && verdict[i] == WITH_OTHERS && verdict[j] != NOT_AT_ALL && turn >= least && turn <= ASJ_PI - least &&
                      a->log_nfa + b->log_nfa <= limit;
        }
}

/* Where the branches that are left meet: one that was none should not say where the junction is. Of soft ones the lines do not say
 * it. Not where the strip does not judge: what goes there are twins and frames. Returns whether the lines are others now. */
static int meet_again(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                       asj_hypothesis *hypothesis)
{
    const asj_hypothesis before = *hypothesis;
    int soft = 0, worse = 0;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        soft |= hypothesis->branches[i].width > ASJ_SOFT_FROM;
    if (!options->strip_test || options->refinement != ASJ_REFINE_LINE_FIT)
        return 0;
    if (soft)
        asj_blurred_corner(context, frame, hypothesis);
    else
        worse = !asj_locate_meet(frame, options, hypothesis);
    worse |= has_moved_far(options, hypothesis, 0);
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        worse |= fabs(hypothesis->branches[i].offset) > LARGEST_OFFSET;
    worse |= !asj_hypothesis_has_opening(hypothesis, options->minimum_opening * ASJ_DEGREE);
    if (worse)
        *hypothesis = before;
    return !worse;
}

/* Lines over whole branches may move the junction by max_move again after those of the first fit (locate.c); what moves farther has
 * drifted to another edge. */
void asj_validate(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis)
{
    int keep[ASJ_MAX_BRANCHES], moved = 0;
    asj_strip strips[ASJ_MAX_BRANCHES];
    const int32_t count = hypothesis->branch_count;
    const inquiry about = {context, frame, options, hypothesis, strips};
    if (has_moved_far(options, hypothesis, 0) || !ask_all(&about, judge_one, options->minimum_opening * ASJ_DEGREE, keep)) {
        hypothesis->branch_count = 0;
        return;
    }
    judge_pairs(frame, options, hypothesis, keep);
    merge(options, hypothesis, keep);
    for (int32_t i = 0, kept = 0; i < count; i++)
        if (keep[i])
            strips[kept++] = strips[i];
    asj_hypothesis_select(hypothesis, keep);
    if (!asj_hypothesis_has_opening(hypothesis, options->minimum_opening * ASJ_DEGREE)) {
        hypothesis->branch_count = 0;
        return;
    }
    if (hypothesis->branch_count < count)
        moved = meet_again(context, frame, options, hypothesis);
    if (options->strip_test)
        asj_keep_steady(context, frame, options, moved ? NULL : strips, hypothesis);
    if (options->strip_test && asj_is_arc(frame, hypothesis, options->minimum_opening * ASJ_DEGREE))
        hypothesis->branch_count = 0;
    const asj_hypothesis unsorted = *hypothesis;
    hypothesis->branch_count = 0;
    for (int32_t i = 0; i < unsorted.branch_count; i++)
        asj_hypothesis_insert(hypothesis, &unsorted.branches[i]);
}

int asj_validate_another(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         const asj_hypothesis *hypothesis, asj_hypothesis_branch *branch)
{
    asj_strip strip;
    return judge(context, frame, options, hypothesis, branch, &strip) != NOT_AT_ALL &&
           branch->log_nfa <= log(options->epsilon) - ANOTHER_LOG && fabs(branch->offset) <= LARGEST_OFFSET_OF_ANOTHER &&
           asj_hypothesis_is_free(hypothesis, branch->angle, asj_joined_apart(options)) &&
           !asj_is_tilted(options, &strip.sums);
}

void asj_validate_lengths(const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis)
{
    int keep[ASJ_MAX_BRANCHES];
    if (options->minimum_length <= 0)
        return;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        keep[i] = hypothesis->branches[i].length >= least_length(frame, options);
    asj_hypothesis_select(hypothesis, keep);
    if (!asj_hypothesis_has_opening(hypothesis, options->minimum_opening * ASJ_DEGREE))
        hypothesis->branch_count = 0;
}
