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
#include "core/angle.h"
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

#define NOTHING 4.0      /* standard deviations from where on a normal distribution is 0 or 1 */

enum { X, Y, FIRST, SECOND, BLUR, STEP, PARAMETERS };

typedef struct wedge {
    double p[PARAMETERS];
} wedge;

/* The pixels that count: a disc, and a band along each edge up to `last`. */
typedef struct window {
    double x, y, reach, across;
    double ux[2], uy[2], last[2];
} window;

/* Lower triangle of the normal matrix, then its Cholesky factor; the right-hand side; sums over the pixels. */
typedef struct equations {
    double matrix[PARAMETERS][PARAMETERS], right[PARAMETERS];
    double error, total, weight;
} equations;

static double normal(double z)
{
    return z > NOTHING ? 1 : z < -NOTHING ? 0 : 0.5 * erfc(-0.7071067811865476 * z);
}

/* Adds one edge's part of g / h at (dx, dy) from the corner, and its derivatives. (ux, uy): along the edge. */
static void add_edge(const wedge *w, int edge, double ux, double uy, double dx, double dy, double g[2], double d[2][PARAMETERS])
{
    const double b = w->p[BLUR], inverse = 1 / (b * b), t = dx * ux + dy * uy, s = dy * ux - dx * uy;
    if (fabs(s) > NOTHING * b || t < -NOTHING * b)
        return;
    const double sign = edge == 0 ? 1 : -1, bell = sign * exp(-0.5 * s * s * inverse), f = bell * normal(t / b);
    const double along = t > NOTHING * b ? 0 : bell * 0.3989422804014327 * exp(-0.5 * t * t * inverse) / b; /* df / dt */
    const double across = -f * s * inverse, wider = (f * s * s * inverse - along * t) / b, turned = along * s - across * t;
    const double n[2] = {-uy, ux}, u[2] = {ux, uy};
    for (int i = 0; i < 2; i++) {
        g[i] += f * n[i];
        d[i][X] -= (along * ux - across * uy) * n[i];
        d[i][Y] -= (along * uy + across * ux) * n[i];
        d[i][FIRST + edge] += turned * n[i] - f * u[i];
        d[i][BLUR] += wider * n[i];
    }
}

/* The window is around w. */
static void add_pixel(const asj_frame *frame, const wedge *w, const window *in, int32_t x, int32_t y, double weight, equations *to)
{
    const uint16_t *at = frame->gray + y * frame->stride + x;
    const double seen[2] = {0.5 * (at[1] - at[-1]), 0.5 * (at[frame->stride] - at[-frame->stride])};
    double g[2] = {0, 0}, d[2][PARAMETERS];
    memset(d, 0, sizeof d);
    for (int edge = 0; edge < 2; edge++)
        add_edge(w, edge, in->ux[edge], in->uy[edge], x - in->x, y - in->y, g, d);
    for (int i = 0; i < 2; i++) {
        const double left = seen[i] - w->p[STEP] * g[i];
        for (int a = 0; a < STEP; a++)
            d[i][a] *= w->p[STEP];
        d[i][STEP] = g[i];
        to->error += weight * left * left;
        to->total += weight * seen[i] * seen[i];
        to->weight += weight;
        for (int a = 0; a < PARAMETERS; a++) {
            to->right[a] += weight * d[i][a] * left;
            for (int b = 0; b <= a; b++)
                to->matrix[a][b] += weight * d[i][a] * d[i][b];
        }
    }
}

static double disc_weight(const window *in, double dx, double dy)
{
    const double rest = 1 - (dx * dx + dy * dy) / (in->reach * in->reach);
    return rest > 0 ? rest * rest : 0;
}

static double band_weight(const window *in, int edge, double dx, double dy)
{
    const double t = dx * in->ux[edge] + dy * in->uy[edge], s = (dy * in->ux[edge] - dx * in->uy[edge]) / in->across;
    return t > 0 && t < in->last[edge] && s * s < 1 ? (1 - s * s) * (1 - s * s) : 0;
}

/* Whole numbers from `from` to `to`, none at the border of an image of `size`, whose pixels have a neighbour on one side only. */
static void pixels_between(double from, double to, int32_t size, int32_t *first, int32_t *last)
{
    *first = (int32_t)ceil(fmin(fmax(from, 1), size));
    *last = (int32_t)floor(fmax(fmin(to, size - 2), 0));
}

static void add_disc(const asj_frame *frame, const wedge *w, const window *in, equations *to)
{
    int32_t left, right, top, bottom;
    pixels_between(in->x - in->reach, in->x + in->reach, frame->width, &left, &right);
    pixels_between(in->y - in->reach, in->y + in->reach, frame->height, &top, &bottom);
    for (int32_t y = top; y <= bottom; y++)
        for (int32_t x = left; x <= right; x++) {
            const double weight = disc_weight(in, x - in->x, y - in->y);
            if (weight > 0)
                add_pixel(frame, w, in, x, y, weight, to);
        }
}

/* What a band adds to the disc. It is walked by the axis that it is longer on. */
static void add_band(const asj_frame *frame, const wedge *w, const window *in, int edge, equations *to)
{
    const double ux = in->ux[edge], uy = in->uy[edge], last = in->last[edge];
    const int by_x = fabs(ux) >= fabs(uy);
    const double along = by_x ? ux : uy, start = by_x ? in->x : in->y, spread = in->across / fabs(along);
    int32_t first, end, from, until;
    if (last <= 0)
        return;
    pixels_between(start + fmin(last * along, 0) - in->across, start + fmax(last * along, 0) + in->across,
                   by_x ? frame->width : frame->height, &first, &end);
    for (int32_t i = first; i <= end; i++) {
        const double middle = by_x ? in->y + (i - in->x) * uy / ux : in->x + (i - in->y) * ux / uy;
        pixels_between(middle - spread, middle + spread, by_x ? frame->height : frame->width, &from, &until);
        for (int32_t j = from; j <= until; j++) {
            const int32_t x = by_x ? i : j, y = by_x ? j : i;
            const double weight = band_weight(in, edge, x - in->x, y - in->y) - disc_weight(in, x - in->x, y - in->y);
            if (weight > 0)
                add_pixel(frame, w, in, x, y, weight, to);
        }
    }
}

static void add_up(const asj_frame *frame, const wedge *w, const window *in, equations *to)
{
    memset(to, 0, sizeof *to);
    add_disc(frame, w, in, to);
    for (int edge = 0; edge < 2; edge++)
        add_band(frame, w, in, edge, to);
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

static window window_of(const wedge *w, const double lengths[2], double blur)
{
    window in = {w->p[X], w->p[Y], DISC * blur, ACROSS * blur, {0, 0}, {0, 0}, {0, 0}};
    for (int i = 0; i < 2; i++) {
        in.ux[i] = cos(w->p[FIRST + i]);
        in.uy[i] = sin(w->p[FIRST + i]);
        in.last[i] = fmax(fmin(lengths[i] - GUARD * blur, LONGEST), 0);
    }
    return in;
}

/* One step; 0 when there is none. *moved: px. */
static int step(equations *e, double blur, wedge *w, double *moved)
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

/* The corner around w, which is near it; 0: there is none. e: of the round before the last step. */
static int find(const asj_frame *frame, const double lengths[2], wedge *w, equations *e)
{
    const wedge start = *w;
    const double blur = start.p[BLUR];
    window in = window_of(w, lengths, blur);
    double moved = HUGE_VAL;
    add_up(frame, w, &in, e); /* with a step of nothing, it tells the step */
    if (!(e->matrix[STEP][STEP] > 0))
        return 0;
    w->p[STEP] = e->right[STEP] / e->matrix[STEP][STEP];
    for (int round = 0; round < ROUNDS && moved > SETTLED; round++) {
        add_up(frame, w, &in, e);
        if (round >= HOPEFUL && e->error > (1 - HOPELESS) * e->total)
            return 0;
        if (!step(e, blur, w, &moved) || hypot(w->p[X] - start.p[X], w->p[Y] - start.p[Y]) > FARTHEST * blur)
            return 0;
        in = window_of(w, lengths, blur);
    }
    return moved <= UNSETTLED && e->error < (1 - LEAST_EXPLAINED) * e->total;
}

static void keep(const wedge *w, const equations *e, int first, asj_hypothesis *hypothesis)
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

int asj_blurred_corner(const asj_frame *frame, asj_hypothesis *hypothesis)
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
        wedge w = {{start.x, start.y, branches[first].angle, branches[1 - first].angle,
                    sqrt(sharper * softer + 0.5 * ASJ_EDGE_SAMPLING), 0}};
        equations e;
        if (!whole && (frame->octave == 0 || fmax(branches[0].length, branches[1].length) <= most))
            break;
        if (find(frame, lengths, &w, &e) && (whole || e.error <= (1 - SURE) * e.total))
            keep(&w, &e, first, hypothesis);
    }
    return hypothesis->explained > 0;
}
