/* SPDX-License-Identifier: BSD-2-Clause */
/* What would be found again (not in the paper).
 *
 * A junction whose parts are all meaningful may still be none that stays: lines that follow a cushion's rim, cloth or what
 * compression leaves meet somewhere else once the picture is a little smaller. No number tells that by itself, and a limit for each
 * drops true corners that one of them is hard on. So they are added up: the log-odds, natural logarithm, that two branches which
 * open are a corner that is found again are
 *
 *     s = START + sum over k of WEIGHT_k clamp(v_k, LEAST_k, MOST_k),
 *
 * with v_k and their weights in the table below, and a junction stays when two of its branches have s >= 0; START says how much is
 * asked. Weights are those of a logistic regression, rounded, over 62000 hypotheses that had come so far, of rendered scenes
 * alone: 170 rooms with letters, books, cushions, cloth, leaves, cables and other things of few px drawn over them, blurred,
 * noisy, most of them compressed (quality 85 to 95), where the share of four copies (.95 to .8 times as large, JPEG of quality 95)
 * with a junction within 3 px was to be told; and 120 rooms and 130 scenes of corners, faint and soft ones among them, where it
 * was whether a true corner lies within 3 px. Photographs had no say in the weights. Coarse octaves have their own: they see less
 * noise and more that only seems to meet, so there how certain the place is and what the edges have near it say most.
 *
 * It stands for three limits of the location's standard deviation and for that of the tilt, by which some true corners hung on one
 * number (tests/accuracy/tried/detection.md, "Steadiness"). */
#include "steady.h"
#include "core/angle.h"
#include "tilt.h"

#include <math.h>

enum { IMAGE, COARSE, KINDS }; /* octave 0 and finer ones; all others */
enum { ISOTROPIC, STRIP, UNCERTAIN, NEAR, SHARE, TILT, TURN, MOVED, VERY_COARSE, NUMBERS };

typedef struct number {
    double least, most;   /* of its value */
    double weight[KINDS];
} number;

static const double start[KINDS] = {-2.0, -4.05};
static const number numbers[NUMBERS] = {
    [ISOTROPIC] = {-10, 30, {0.06, 0}},      /* decades of the isotropic test's NFA */
    [STRIP] = {-3, 15, {0.12, 0.03}},        /* decades of the less meaningful strip's NFA */
    [UNCERTAIN] = {-3.5, 0.7, {-0.4, -1.0}}, /* ln of the location's standard deviation, px of the octave */
    [NEAR] = {-2, 5, {0.14, 0.25}},          /* sd: near_strength (strip.h) of the branch that has less, */
    [SHARE] = {0, 1, {0, 3.0}},              /* and near_share of that which has less */
    [TILT] = {0, 3, {-0.9, -0.8}},           /* tan phi times rho (tilt.c) of the branch that has more, in tan max_tilt */
    [TURN] = {0, 1, {0.9, 1.5}},             /* sine of the angle between the branches */
    [MOVED] = {0, 5, {-0.2, -0.25}},         /* px of the octave from where the isotropic test found it */
    [VERY_COARSE] = {0, 1, {0, -1.0}},       /* 1 from octave 2 on */
};

/* s of two branches, whose strips are p and q. */
static double log_odds(const asj_frame *frame, const asj_detect_options *options, const asj_hypothesis *hypothesis,
                       const asj_hypothesis_branch *a, const asj_strip *p, const asj_hypothesis_branch *b, const asj_strip *q)
{
    const double values[NUMBERS] = {
        [ISOTROPIC] = -hypothesis->log_nfa / ASJ_LN_10,
        [STRIP] = -fmax(a->log_nfa, b->log_nfa) / ASJ_LN_10,
        [UNCERTAIN] = 0.5 * log(hypothesis->location_variance),
        [NEAR] = fmin(p->near_strength, q->near_strength),
        [SHARE] = fmin(p->near_share, q->near_share),
        [TILT] = fmax(asj_tilt(options, &p->sums), asj_tilt(options, &q->sums)),
        [TURN] = sin(asj_angle_distance(a->angle, b->angle)),
        [MOVED] = hypot(hypothesis->x - hypothesis->x0, hypothesis->y - hypothesis->y0),
        [VERY_COARSE] = frame->octave >= 2,
    };
    const int kind = frame->octave > 0 ? COARSE : IMAGE;
    double sum = start[kind];
    for (int k = 0; k < NUMBERS; k++)
        sum += numbers[k].weight[kind] * fmin(fmax(values[k], numbers[k].least), numbers[k].most);
    return sum;
}

/* The most that each branch has with another one that opens. */
static void best_of_each(const asj_frame *frame, const asj_detect_options *options, const asj_hypothesis *hypothesis,
                         const asj_strip *strips, double *best)
{
    const double least = options->minimum_opening * ASJ_DEGREE;
    const asj_hypothesis_branch *branches = hypothesis->branches;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        best[i] = -HUGE_VAL;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        for (int32_t j = i + 1; j < hypothesis->branch_count; j++) {
            const double turn = asj_angle_distance(branches[i].angle, branches[j].angle);
            if (turn < least || turn > ASJ_PI - least)
                continue;
            const double s = log_odds(frame, options, hypothesis, &branches[i], &strips[i], &branches[j], &strips[j]);
            best[i] = fmax(best[i], s);
            best[j] = fmax(best[j], s);
        }
}

void asj_keep_steady(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                     const asj_strip *known, asj_hypothesis *hypothesis)
{
    asj_strip measured[ASJ_MAX_BRANCHES];
    const asj_strip *strips = known ? known : measured;
    double best[ASJ_MAX_BRANCHES];
    int keep[ASJ_MAX_BRANCHES], steady = 0;
    for (int32_t i = 0; i < hypothesis->branch_count && !known; i++) {
        const asj_strip_line line = {hypothesis->x, hypothesis->y, hypothesis->branches[i].angle, hypothesis->branches[i].length};
        measured[i] = asj_strip_test(context, frame, options, &line);
    }
    best_of_each(frame, options, hypothesis, strips, best);
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        steady |= best[i] >= 0;
        keep[i] = best[i] >= 0 || !asj_is_tilted(options, &strips[i].sums);
    }
    asj_hypothesis_select(hypothesis, keep);
    hypothesis->branch_count = steady ? hypothesis->branch_count : 0;
}
