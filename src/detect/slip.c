/* SPDX-License-Identifier: BSD-2-Clause */
/* Branches that slip from one edge to the next (not in the paper).
 *
 * Where many edges lie beside each other, conductors of a board, slats, lines of print, books, a line that crosses them at a degree
 * or two has one of them in its strip nearly everywhere. The scan follows it far, the strip along it is meaningful, and the tilt of
 * its gradients (tilt.c) is within what a weak edge may have. But the edge does not stay where it is: with m the cross-section of
 * what is along the branch (edge_rows.c) and v the tangent of the angle, the grey levels across it are
 *
 *     g(t, s) = a(t) m(s - v t).
 *
 * With d the direction of m' at right angles to m, both of norm one, and
 *
 *     z(t) = <g(t), m> + i <g(t), d>,
 *
 * z turns about zero in one direction then, once for each period of what is crossed. Where one edge is followed z stays near the
 * real axis: a change of sign, a crossing of checkerboard tiles, takes it through zero, noise takes it back and forth, and a bent
 * edge turns it by less than half a turn before it is lost. So along the branch
 *
 *     turned(T) = sum over t <= T of Im(conj(z(t)) z(t + STEP)) / max(|z(t) z(t + STEP)|, mean of |z|^2),
 *
 * the sine of each step, in which what has hardly any contrast hardly counts, and what turns by more than FASTEST, a cable across
 * the edge, noise, not at all. A branch that has turned by SLIPPED in all has left its edge. It ends where it had last turned by no
 * more than STAYS, and its line is fitted again up to there (refine_step.c).
 *
 * Conductors that turn by 40 degrees side by side (test_slip.c), 5 px from one to the next: of the branches' length .59 is more
 * than a degree off without this, .26 with it. Rendered rooms have next to none that slips. Not in presets that take weak corners,
 * where it costs a few right matches (tests/accuracy/tried/detection.md, "Branches that slip"). */
#include "slip.h"

#include <math.h>

#define SAMPLES ASJ_EDGE_SAMPLES
#define STEP 3            /* px along the branch from one row to the next */
#define SMOOTH 2          /* rows, of which each z is the mean */
#define BLOCK 3           /* rows, of which each mean is one that tells the cross-section, */
#define BLOCKS 24         /* and so many of them do, from the junction on */
#define ROWS 340          /* at most; what is farther is not looked at */
#define LEAST_ROWS 10     /* in less nothing slips */
#define SLIPPED (1.5 * ASJ_PI) /* three quarters of a period: nearer to the next edge like it than to its own. With less long
                                * edges with another one beside them become shorter */
#define STAYS (ASJ_PI / 3)
#define FASTEST 0.6       /* sine of a step: a period of 5 px at 6 degrees takes 16 of them. What turns faster lies across */
#define LEAST_NORM 1e-4   /* of m' beside m: a section that does not change when it moves */

typedef struct rows {
    int32_t count;
    int32_t levels[SAMPLES][ROWS + ASJ_EDGE_BATCH]; /* of row k at [..][k] */
} rows;

/* z, times a positive number that is the same along the branch. */
typedef struct phase {
    double real, imaginary;
} phase;

static void read_rows(const asj_edge_ops *ops, const asj_edge_line *line, double length, rows *r)
{
    const int32_t there = ((int32_t)length - ASJ_EDGE_FIRST) / STEP + 1;
    r->count = ops->rows(line, ASJ_EDGE_FIRST, STEP, there < ROWS ? there : ROWS, r->levels[0], ROWS + ASJ_EDGE_BATCH);
}

/* m and d; 0 when there are none. */
static int find_directions(const rows *r, double m[SAMPLES], double d[SAMPLES])
{
    double means[BLOCKS * SAMPLES] = {0}, sum = 0;
    int32_t count = 0;
    for (; count < BLOCKS && (count + 1) * BLOCK <= r->count; count++)
        for (int32_t i = 0; i < SAMPLES; i++)
            for (int32_t k = count * BLOCK; k < (count + 1) * BLOCK; k++)
                means[count * SAMPLES + i] += r->levels[i][k] / (ASJ_EDGE_LEVEL * BLOCK);
    if (!asj_edge_section(means, count, m))
        return 0;
    for (int32_t i = 0; i < SAMPLES; i++) {
        const int32_t before = i > 0 ? i - 1 : i, after = i < SAMPLES - 1 ? i + 1 : i;
        sum += d[i] = (m[after] - m[before]) / (after - before);
    }
    for (int32_t i = 0; i < SAMPLES; i++)
        d[i] -= sum / SAMPLES;
    const double along = asj_edge_product(d, m);
    for (int32_t i = 0; i < SAMPLES; i++)
        d[i] -= along * m[i];
    const double norm = sqrt(asj_edge_product(d, d));
    for (int32_t i = 0; i < SAMPLES; i++)
        d[i] /= norm > LEAST_NORM ? norm : 1;
    return norm > LEAST_NORM;
}

/* z along the branch; returns the mean of |z|^2. */
static double find_phases(const rows *r, const double m[SAMPLES], const double d[SAMPLES], phase z[ROWS], int32_t count)
{
    double real[ROWS], imaginary[ROWS], sum = 0;
    asj_edge_parts(r->levels[0], ROWS + ASJ_EDGE_BATCH, r->count, m, real);
    asj_edge_parts(r->levels[0], ROWS + ASJ_EDGE_BATCH, r->count, d, imaginary);
    for (int32_t k = 0; k < count; k++) {
        z[k] = (phase){0, 0};
        for (int32_t i = k; i < k + SMOOTH; i++) {
            z[k].real += real[i];
            z[k].imaginary += imaginary[i];
        }
        sum += z[k].real * z[k].real + z[k].imaginary * z[k].imaginary;
    }
    return sum / count;
}

/* How far z turns from one row to the next. */
static double step_of(const phase *from, const phase *to, double mean)
{
    const double along = from->real * to->real + from->imaginary * to->imaginary;
    const double across = from->real * to->imaginary - from->imaginary * to->real;
    const double sizes = sqrt(along * along + across * across);
    return along > 0 && fabs(across) <= FASTEST * sizes ? across / fmax(sizes, mean) : 0;
}

double asj_slip_length(const asj_edge_ops *ops, const asj_frame *frame, const asj_hypothesis *hypothesis,
                       const asj_hypothesis_branch *branch)
{
    const asj_edge_line line = asj_edge_line_of(frame, hypothesis, branch);
    double m[SAMPLES], d[SAMPLES], turned[ROWS] = {0};
    phase z[ROWS];
    rows r;
    if (!(branch->length >= ASJ_EDGE_FIRST + (LEAST_ROWS - 1) * STEP))
        return branch->length;
    read_rows(ops, &line, branch->length, &r);
    const int32_t count = r.count - SMOOTH + 1;
    if (r.count < LEAST_ROWS || !find_directions(&r, m, d))
        return branch->length;
    const double mean = find_phases(&r, m, d, z, count);
    for (int32_t k = 1; k < count && mean > 0; k++)
        turned[k] = turned[k - 1] + step_of(&z[k - 1], &z[k], mean);
    int32_t last = count - 1;
    if (fabs(turned[last]) < SLIPPED)
        return branch->length;
    while (fabs(turned[last]) > STAYS)
        last--;
    return fmin(ASJ_EDGE_FIRST + (last + SMOOTH / 2) * STEP, branch->length);
}
