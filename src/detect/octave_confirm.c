/* SPDX-License-Identifier: BSD-2-Clause */
/* What an octave sees has to be there in the image. A coarse one joins what it cannot tell apart: an edge that ends at the inner
 * line of a frame seems to end at the outer one, the sides of a cut corner seem to meet, the two edges of a band make one line
 * between them. The image itself shows the gap, or the band.
 *
 * Contrast across a branch, t px from its junction, I the grey level at (t, s) along and across it:
 *     c(t) = I(t, d) - I(t, -d),   of a thin line whose edges stand `apart`   c(t) = I(t, apart) + I(t, -apart) - 2 I(t, 0).
 * An edge reaches its junction when its contrast in the first px, n, is not much less than that farther out, f. With e the standard
 * deviation of the samples that make f, and k samples near the junction, it does not when
 *     |n / f| + DOUBT e / (|f| sqrt(k)) < LEAST_SHARE:
 * noise alone rejects nothing. (The magnitude, since at a crossing the far part may have changed its sign.) What is near begins
 * where no other branch touches it. Rendered rooms have precision .990 with it and .974 without, recall .945 and .948.
 *
 * What the image itself is SURE of stays: it joins nothing that it can tell apart, and round corners, borders one or two pixels
 * wide and a jutting edge leave as little contrast near true corners (tests/accuracy/tried/detection.md, "What the image itself is
 * sure of"). */
#include "octave_confirm.h"
#include "core/angle.h"
#include "gray_at.h"

#include <math.h>

#define ACROSS 1.5       /* widths of the edge: d, at which 87 % of a blurred step are seen; */
#define LEAST_ACROSS 1.5 /* px: the least d */
#define AWAY 1.5         /* widths of another branch: its edge is no nearer to what is measured, */
#define LEAST_WIDTH 0.7  /* px: and no edge is taken for sharper than this */

#define NEAR_LENGTH 1.0  /* px of the branch's octave: the part near the junction, */
#define LEAST_NEAR 3.0   /* px: and at the image's own scale */
#define FAR 6.0          /* px of the branch's octave: where the part farther out begins, */
#define FAR_END 14.0     /* where it ends: beyond, the edge may be another one, */
#define LEAST_FAR 4.0    /* how long it is at least, */
#define LEFT_OUT 3.0     /* and what is left out before the end */
#define LEAST_SHARE 0.65 /* 0.9 to 1.1 where edges meet, 0 to 0.6 where they do not. More loses corners on strong edges */
#define DOUBT 3.0        /* standard deviations */

#define SURE (-15 * ASJ_LN_10) /* of an octave that is no coarser than the image */

/* An edge that seems wide, and has most of its step within a few px somewhere, is a sharp one or several. A blur of WIDE px leaves
 * 50 % of what ACROSS sees between -STEP and STEP. */
#define WIDE 3.5         /* px */
#define STEP 2.0         /* px */
#define SHARP_SHARE 0.65

typedef struct contrast {
    double mean, sd; /* of the samples, 1 px apart */
    int32_t samples;
} contrast;

/* A stretch of a branch that is measured, in px of the image. */
typedef struct stretch {
    double first, last, across;
} stretch;

/* px of the image: of the branch's octave one; nothing finer is to be seen in the image than it has itself. */
static double scale_of(const asj_hypothesis_branch *branch)
{
    return fmax(asj_octave_scale(branch->octave), 1);
}

/* px of the image */
static double width_of(const asj_hypothesis_branch *branch)
{
    return branch->width * asj_octave_scale(branch->octave);
}

/* (ux, uy): the branch's direction. */
static double contrast_at(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch, double ux,
                          double uy, double t, double across)
{
    const double x = hypothesis->x + t * ux - branch->offset * uy, y = hypothesis->y + t * uy + branch->offset * ux;
    const double right = asj_gray_at(frame, x - across * uy, y + across * ux);
    const double left = asj_gray_at(frame, x + across * uy, y - across * ux);
    return branch->apart > 0 ? right + left - 2 * asj_gray_at(frame, x, y) : right - left;
}

static contrast measure(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch,
                        const stretch *at)
{
    const double ux = cos(branch->angle), uy = sin(branch->angle);
    contrast c = {0, 0, 0};
    double squares = 0;
    for (double t = at->first; t <= at->last; t += 1, c.samples++) {
        const double value = contrast_at(frame, hypothesis, branch, ux, uy, t, at->across);
        c.mean += value;
        squares += value * value;
    }
    c.mean /= c.samples > 0 ? c.samples : 1;
    c.sd = c.samples > 0 ? sqrt(fmax(squares / c.samples - c.mean * c.mean, 0)) : 0;
    return c;
}

/* Where the other branches no longer touch what is measured: (t, across) and (t, -across) are t sin(turn) - across cos(turn) away
 * from a ray that opens by less than a right angle, and t from others. */
static double begin_of(const asj_hypothesis *hypothesis, int32_t i, double across)
{
    double begin = 0;
    for (int32_t j = 0; j < hypothesis->branch_count; j++) {
        const asj_hypothesis_branch *other = &hypothesis->branches[j];
        const double turn = asj_angle_distance(hypothesis->branches[i].angle, other->angle);
        const double away = AWAY * fmax(width_of(other), LEAST_WIDTH);
        if (j != i)
            begin = fmax(begin, turn < 0.5 * ASJ_PI ? (away + across * cos(turn)) / sin(turn) : away);
    }
    return begin;
}

/* Whether an edge that seems wide is sharp. */
static int is_sharp(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch,
                    const stretch *far)
{
    const stretch step = {far->first, far->last, STEP};
    double most = 0;
    if (width_of(branch) <= WIDE)
        return 0;
    asj_hypothesis_branch edge = *branch;
    edge.apart = 0;
    for (double s = -far->across; s <= far->across; s += 1) {
        edge.offset = branch->offset + s;
        most = fmax(most, fabs(measure(frame, hypothesis, &edge, &step).mean));
    }
    const double edges = branch->apart > 0 ? 2 : 1; /* of a line */
    return most >= SHARP_SHARE * fabs(measure(frame, hypothesis, branch, far).mean) / edges;
}

static int is_there(const asj_frame *frame, const asj_hypothesis *hypothesis, int32_t i)
{
    const asj_hypothesis_branch *branch = &hypothesis->branches[i];
    const double scale = scale_of(branch);
    const double across = branch->apart > 0 ? branch->apart : fmax(LEAST_ACROSS, ACROSS * width_of(branch));
    const double begin = begin_of(hypothesis, i, across), near_length = fmax(NEAR_LENGTH * scale, LEAST_NEAR);
    const stretch near = {begin, begin + near_length, across};
    const stretch far = {FAR * scale, fmin(FAR_END * scale, branch->length - LEFT_OUT * scale), across};
    if (far.last - far.first < LEAST_FAR * scale)
        return 1;
    if (is_sharp(frame, hypothesis, branch, &far))
        return 0;
    const contrast f = measure(frame, hypothesis, branch, &far);
    if (begin > FAR * scale || f.mean == 0)
        return 1;
    const contrast n = measure(frame, hypothesis, branch, &near);
    return fabs(n.mean) + DOUBT * f.sd / sqrt(n.samples) >= LEAST_SHARE * fabs(f.mean);
}

void asj_octave_confirm(const asj_frame *frame, double minimum_opening, asj_hypothesis *hypothesis)
{
    int keep[ASJ_MAX_BRANCHES];
    if (hypothesis->octave <= 0 && hypothesis->log_nfa <= SURE)
        return;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        keep[i] = is_there(frame, hypothesis, i);
    asj_hypothesis_select(hypothesis, keep);
    if (!asj_hypothesis_has_opening(hypothesis, minimum_opening * ASJ_DEGREE))
        hypothesis->branch_count = 0;
}
