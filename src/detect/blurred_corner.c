/* SPDX-License-Identifier: BSD-2-Clause */
/* Blur rounds a corner: within three of its standard deviations the edges bend, inwards where the corner is acute and outwards
 * where it is obtuse, and lines fitted to them meet somewhere else. A soft edge is often no longer than a few of its widths, too:
 * then its other end bends it as much, and no part of it is straight. So the corner is fitted to the pixels as a whole.
 *
 * Corner at c, its edges along u_1 and u_2, n = u turned by +90 degrees. The gradient of the wedge between them is that of two
 * half-lines; blurred with a Gaussian of standard deviation b, with t_i, s_i the coordinates of a pixel from c along u_i and n_i,
 *     g = h (n_1 N(t_1 / b) exp(-s_1^2 / 2 b^2) - n_2 N(t_2 / b) exp(-s_2^2 / 2 b^2)),     N the normal distribution function:
 * exact for a corner alone. Sought are c, both angles, b and h with the least squares of what it leaves of the differences of grey
 * levels, by Gauss and Newton's steps. The pixels that count lie around the corner (DISC) or along the edges, less what their other
 * ends bend; where the lengths are wrong, as when a scan goes on beyond a short edge, less far along them (SHORT). That only in
 * coarse octaves, where edges are short: of a long one lines say more than a part of it.
 *
 * What the corner explains of the squares of the differences tells it from chance: .99 and more at corners of 25 grey levels in
 * noise of 2, .75 (95 % below .91) at what passes for corners in noise that is blurred by 2 to 8 px. */
#include "blurred_corner.h"
#include "blurred_wedge.h"
#include "core/angle.h"
#include "core/context.h"
#include "core/ops.h"
#include "edge_width.h"

#include <math.h>
#include <string.h>

#define WIDEST 4.0   /* px: wider edges are left to coarser octaves */
#define ALIKE 1.6    /* widths of the edges of one corner differ by this factor at most */

/* The pixels that count, in standard deviations of the blur. DISC: what bends. ACROSS: 95 % of an edge. GUARD: what the other end
 * of an edge bends. Lenses bend longer edges than LONGEST, too. */
#define DISC 3.0
#define ACROSS 2.0
#define GUARD 3.0
#define LONGEST 80.0 /* px */
#define SHORT 8.0    /* in widths: a length. With less, parallel edges close by turn the corner by 5 degrees and more */

#define ROUNDS 8
#define SETTLED 0.02     /* px: a step that moves the corner by less is the last, */
#define UNSETTLED 0.1    /* and one by more, after all rounds, is none */
#define HOPELESS 0.7     /* explained after HOPEFUL rounds: there is no such corner */
#define HOPEFUL 2
#define LARGEST_STEP 0.5 /* of the blur, or rad */
#define FARTHEST 1.5     /* of the blur: from where the lines meet */
#define LEAST_PIVOT 1e-6 /* relative: parameters that the pixels do not tell apart */

#define LEAST_EXPLAINED 0.9 /* else lines that meet are as good */
#define SURE 0.97        /* at lower ones blurred noise may pass */
#define LEAST_ERROR 0.03 /* px: systematic */

enum {
    X = ASJ_WEDGE_X,
    Y = ASJ_WEDGE_Y,
    FIRST = ASJ_WEDGE_FIRST,
    SECOND = ASJ_WEDGE_SECOND,
    BLUR = ASJ_WEDGE_BLUR,
    STEP = ASJ_WEDGE_STEP,
    PARAMETERS = ASJ_WEDGE_PARAMETERS
};

/* Lower triangle of the normal matrix, then its Cholesky factor; the right-hand side; sums over the pixels: of the squares of what
 * the wedge leaves of the differences, of the differences', of the weights. */
typedef struct equations {
    double matrix[PARAMETERS][PARAMETERS], right[PARAMETERS];
    double error, total, weight;
} equations;

/* Of the wedge with step h: what its parameters change is h times what the sums are of, but for h itself. */
static void set_equations(const asj_wedge_sums *sums, double h, equations *e)
{
    const double *with_step = sums->products[STEP];
    for (int a = 0; a < PARAMETERS; a++) {
        const double of_a = a == STEP ? 1 : h;
        e->right[a] = of_a * (sums->seen[a] - h * with_step[a]);
        for (int b = 0; b <= a; b++)
            e->matrix[a][b] = of_a * (b == STEP ? 1 : h) * sums->products[a][b];
    }
    e->error = sums->total - h * (2 * sums->seen[STEP] - h * with_step[STEP]);
    e->total = sums->total;
    e->weight = 2 * sums->weight; /* two differences a pixel */
}

/* The Cholesky factor of the matrix in its place; 0 when there is none. */
static int factorise(equations *e)
{
    double (*m)[PARAMETERS] = e->matrix;
    for (int i = 0; i < PARAMETERS; i++)
        for (int j = 0; j <= i; j++) {
            double sum = m[i][j];
            for (int k = 0; k < j; k++)
                sum -= m[i][k] * m[j][k];
            if (i == j && !(sum > LEAST_PIVOT * m[i][i]))
                return 0;
            m[i][j] = i == j ? sqrt(sum) : sum / m[j][j];
        }
    return 1;
}

static void solve(const equations *e, const double right[PARAMETERS], double solution[PARAMETERS])
{
    const double (*m)[PARAMETERS] = (const double (*)[PARAMETERS])e->matrix;
    for (int i = 0; i < PARAMETERS; i++) {
        double sum = right[i];
        for (int k = 0; k < i; k++)
            sum -= m[i][k] * solution[k];
        solution[i] = sum / m[i][i];
    }
    for (int i = PARAMETERS - 1; i >= 0; i--) {
        double sum = solution[i];
        for (int k = i + 1; k < PARAMETERS; k++)
            sum -= m[k][i] * solution[k];
        solution[i] = sum / m[i][i];
    }
}

/* From what is left of the pixels, as if differences that share pixels did not: errors on synthetic scenes are those. */
static double variance_of(const equations *e, int parameter)
{
    double unit[PARAMETERS] = {0}, column[PARAMETERS];
    unit[parameter] = 1;
    solve(e, unit, column);
    return e->error / e->weight * column[parameter];
}

static asj_wedge_window window_of(const asj_wedge *w, const double lengths[2], double blur)
{
    asj_wedge_window in = {w->p[X], w->p[Y], DISC * blur, ACROSS * blur, {0, 0}, {0, 0}, {0, 0}};
    for (int i = 0; i < 2; i++) {
        in.ux[i] = cos(w->p[FIRST + i]);
        in.uy[i] = sin(w->p[FIRST + i]);
        in.last[i] = fmax(fmin(lengths[i] - GUARD * blur, LONGEST), 0);
    }
    return in;
}

/* One step; 0 when there is none. *moved: px. */
static int step(equations *e, double blur, asj_wedge *w, double *moved)
{
    double change[PARAMETERS];
    if (!factorise(e))
        return 0;
    solve(e, e->right, change);
    *moved = hypot(change[X], change[Y]);
    const double largest = fmax(*moved / blur, fmax(fabs(change[FIRST]), fabs(change[SECOND])));
    for (int i = 0; i < PARAMETERS; i++)
        w->p[i] += largest > LARGEST_STEP ? change[i] * LARGEST_STEP / largest : change[i];
    return w->p[BLUR] > 0.5 * blur && w->p[BLUR] < 2 * blur;
}

/* The corner around w, which is near it, and whose step the first sums tell; 0: there is none. e: of the round before the last
 * step. */
static int find(const asj_wedge_ops *ops, const asj_frame *frame, const double lengths[2], asj_wedge *w, equations *e)
{
    const asj_wedge start = *w;
    const double blur = start.p[BLUR];
    double moved = HUGE_VAL;
    for (int round = 0; round < ROUNDS && moved > SETTLED; round++) {
        const asj_wedge_window in = window_of(w, lengths, blur);
        asj_wedge_sums sums;
        ops->add_up(frame, w, &in, &sums);
        if (!(sums.products[STEP][STEP] > 0))
            return 0;
        if (round == 0)
            w->p[STEP] = sums.seen[STEP] / sums.products[STEP][STEP];
        set_equations(&sums, w->p[STEP], e);
        if (round >= HOPEFUL && e->error > (1 - HOPELESS) * e->total)
            return 0;
        if (!step(e, blur, w, &moved) || hypot(w->p[X] - start.p[X], w->p[Y] - start.p[Y]) > FARTHEST * blur)
            return 0;
    }
    return moved <= UNSETTLED && e->error < (1 - LEAST_EXPLAINED) * e->total;
}

static void keep(const asj_wedge *w, const equations *e, int first, asj_hypothesis *hypothesis)
{
    hypothesis->x = w->p[X];
    hypothesis->y = w->p[Y];
    hypothesis->location_variance = 0.5 * (variance_of(e, X) + variance_of(e, Y)) + LEAST_ERROR * LEAST_ERROR;
    hypothesis->explained = 1 - e->error / e->total;
    for (int i = 0; i < 2; i++) {
        asj_hypothesis_branch *branch = &hypothesis->branches[i == 0 ? first : 1 - first];
        branch->angle = asj_angle_wrap(w->p[FIRST + i]);
        branch->angle_variance = variance_of(e, FIRST + i);
        branch->offset = 0;
        branch->offset_variance = hypothesis->location_variance;
    }
}

int asj_blurred_corner_is_sure(const asj_hypothesis *hypothesis)
{
    return hypothesis->explained >= SURE;
}

int asj_blurred_corner(const asj_context *context, const asj_frame *frame, asj_hypothesis *hypothesis)
{
    const asj_hypothesis_branch *a = &hypothesis->branches[0], *b = &hypothesis->branches[1];
    const double sharper = fmin(a->width, b->width), softer = fmax(a->width, b->width);
    hypothesis->explained = 0;
    if (hypothesis->branch_count != 2 || a->apart > 0 || b->apart > 0 || sharper <= ASJ_SOFT_FROM || softer > WIDEST ||
        softer > ALIKE * sharper)
        return 0;
    const int first = remainder(b->angle - a->angle, ASJ_TWO_PI) < 0; /* with the inside at positive s */
    const asj_hypothesis start = *hypothesis;
    const asj_hypothesis_branch *branches = start.branches;
    for (int whole = 1; whole >= 0 && !asj_blurred_corner_is_sure(hypothesis); whole--) {
        const double most = whole ? HUGE_VAL : SHORT * softer;
        const double lengths[2] = {fmin(branches[first].length, most), fmin(branches[1 - first].length, most)};
        asj_wedge w = {{start.x, start.y, branches[first].angle, branches[1 - first].angle,
                    sqrt(sharper * softer + 0.5 * ASJ_EDGE_SAMPLING), 0}};
        equations e;
        if (!whole && (frame->octave <= 0 || fmax(branches[0].length, branches[1].length) <= most))
            break;
        if (find(context->ops->wedge, frame, lengths, &w, &e) && (whole || e.error <= (1 - SURE) * e.total))
            keep(&w, &e, first, hypothesis);
    }
    return hypothesis->explained > 0;
}
