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
 *     turned(T) = sum over t <= T of Im(conj(z(t)) z(t + STEP)) / mean of |z|^2,
 *
 * in which what has hardly any contrast hardly counts. A branch that has turned by a PERIOD in all has slipped. It ends where it
 * had last turned by no more than STAYS, and its line is fitted again up to there (refine_step.c).
 *
 * Conductors that turn by 40 degrees side by side, 5, 6 and 8 px from one to the next: of the branches' length 58, 30 and 14 % was
 * more than a degree off, 31, 17 and 6 is. A circuit board loses the tenth of its junctions that was drawn across conductors. Of 26
 * photographs' junctions .4 % more repeat under zoom in the mean, of six others .2 % fewer. The branches that turn by 3 to 6 are
 * mostly right ones, long edges with another one beside them: with half a PERIOD the 26 gain another .3 %, and the six lose another
 * .5. Rendered rooms have none that slips. Not in presets that take weak corners: pairs of photographs have as many right matches
 * with it, and a quarter more wrong ones. */
#include "slip.h"
#include "edge_rows.h"

#include <math.h>

#define SAMPLES ASJ_EDGE_SAMPLES
#define STEP 3            /* px along the branch from one row to the next */
#define SMOOTH 2          /* rows, of which each z is the mean */
#define BLOCK 3           /* rows, of which each mean is one that tells the cross-section, */
#define BLOCKS 24         /* and so many of them do, from the junction on */
#define ROWS 340          /* at most; what is farther is not looked at */
#define LEAST_ROWS 10     /* in less nothing slips */
#define PERIOD (2 * ASJ_PI)
#define STAYS (ASJ_PI / 3)
#define LEAST_NORM 1e-4   /* of m' beside m: a section that does not change when it moves */

typedef struct rows {
    int32_t count;
    int32_t levels[ROWS][SAMPLES];
} rows;

/* z, times a positive number. */
typedef struct phase {
    double real, imaginary;
} phase;

static void read_rows(const asj_edge_line *line, double length, rows *r)
{
    r->count = 0;
    for (int32_t t = ASJ_EDGE_FIRST; t <= length && r->count < ROWS && asj_edge_row(line, t, r->levels[r->count]); t += STEP)
        r->count++;
}

/* m and d; 0 when there are none. */
static int find_directions(const rows *r, double m[SAMPLES], double d[SAMPLES])
{
    double means[BLOCKS * SAMPLES] = {0}, sum = 0;
    int32_t count = 0;
    for (; count < BLOCKS && (count + 1) * BLOCK <= r->count; count++)
        for (int32_t k = count * BLOCK; k < (count + 1) * BLOCK; k++)
            for (int32_t i = 0; i < SAMPLES; i++)
                means[count * SAMPLES + i] += r->levels[k][i] / (ASJ_EDGE_LEVEL * BLOCK);
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

static phase phase_at(const rows *r, int32_t first, const double m[SAMPLES], const double d[SAMPLES])
{
    phase z = {0, 0};
    for (int32_t k = first; k < first + SMOOTH; k++)
        for (int32_t i = 0; i < SAMPLES; i++) {
            z.real += r->levels[k][i] * m[i];
            z.imaginary += r->levels[k][i] * d[i];
        }
    return z;
}

double asj_slip_length(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    const asj_edge_line line = asj_edge_line_of(frame, hypothesis, branch);
    double m[SAMPLES], d[SAMPLES], turned[ROWS], square = 0, sum = 0;
    rows r;
    read_rows(&line, branch->length, &r);
    const int32_t count = r.count - SMOOTH + 1;
    if (r.count < LEAST_ROWS || !find_directions(&r, m, d))
        return branch->length;
    phase before = phase_at(&r, 0, m, d);
    for (int32_t k = 0; k < count; k++) {
        const phase z = phase_at(&r, k, m, d);
        sum += before.real * z.imaginary - before.imaginary * z.real;
        square += z.real * z.real + z.imaginary * z.imaginary;
        turned[k] = sum;
        before = z;
    }
    const double mean = square / count;
    if (!(fabs(sum) >= PERIOD * mean))
        return branch->length;
    int32_t last = count - 1;
    while (fabs(turned[last]) > STAYS * mean)
        last--;
    return fmin(ASJ_EDGE_FIRST + (last + SMOOTH / 2) * STEP, branch->length);
}
