/* SPDX-License-Identifier: BSD-2-Clause */
/* The table behind the tails of sums of gamma~ (nfa_arc.c): convolution on a lattice. */
#include "nfa_fill.h"
#include "core/angle.h"

#include <math.h>

/* Half-width of the lattice that sums are made on: wider than the table, so that what is cut off does not count. */
#define ARC_HALF (16 * ASJ_NFA_PER_UNIT)

/* P(gamma~ >= z) = (2/pi) integral over 0 < x < pi/4 of Q(z / (cos x - sin x)) dx for z > 0, Q = normal upper tail, the
 * integral of distribution-updated over its tail; with cos x - sin x = sqrt(2) sin(pi/4 - x), and a = pi/4 - x. The panels
 * crowd towards a = 0, where the integrand falls to 0 within a distance of about z. */
enum { ARC_PANELS = 5, ARC_NODES = ARC_PANELS * 2 * ASJ_NFA_GAUSS };
typedef struct arc_rule {
    double inverse[ARC_NODES], weight[ARC_NODES]; /* 1 / (2 sin a), and the weight with all factors */
} arc_rule;

static void fill_arc_rule(arc_rule *rule)
{
    const double edge[ARC_PANELS + 1] = {0, 1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0 / 2, ASJ_PI / 4};
    int i = 0;
    for (int panel = 0; panel < ARC_PANELS; panel++) {
        double centre = 0.5 * (edge[panel + 1] + edge[panel]), half = 0.5 * (edge[panel + 1] - edge[panel]);
        for (int k = 0; k < 2 * ASJ_NFA_GAUSS; k++, i++) {
            rule->inverse[i] = 0.5 / sin(centre + (k & 1 ? half : -half) * asj_nfa_gauss_node[k / 2]);
            rule->weight[i] = half * asj_nfa_gauss_weight[k / 2] / ASJ_PI;
        }
    }
}

static double arc_tail(const arc_rule *rule, double z)
{
    double sum = 0;
    for (int i = 0; i < ARC_NODES; i++)
        sum += rule->weight[i] * erfc(z * rule->inverse[i]);
    return sum;
}

/* Masses of gamma~ on the lattice i * step, i >= 0 (it is symmetric). Moving every value to the nearest lattice point
 * raises the variance by step^2 / 12; the second difference takes that back, so that the error is of fourth order away from
 * 0. The atom is not moved and needs no correction. Masses stay positive. Also writes ln G(i step; 1), exact. */
static void fill_arc_masses(const arc_rule *rule, double *mass, double *table)
{
    double cell[ARC_HALF + 2], inner = 0.25;
    for (int i = 0; i <= ARC_HALF + 1; i++) {
        double outer = arc_tail(rule, (i + 0.5) * ASJ_NFA_STEP);
        cell[i] = (i ? 1 : 2) * (inner - outer);
        inner = outer;
    }
    for (int i = 0; i <= ARC_HALF; i++)
        mass[i] = cell[i] - (cell[i ? i - 1 : 1] - 2 * cell[i] + cell[i + 1]) / 24;
    mass[0] += 0.5;
    for (int i = 0; i <= ASJ_NFA_ARC_CELLS; i++)
        table[i] = log(i ? arc_tail(rule, i * ASJ_NFA_STEP) : 0.25);
}

/* Scratch for the convolution. */
typedef struct arc_scratch {
    arc_rule rule;
    double mass[ARC_HALF + 1];         /* of one gamma~ */
    double sum[ARC_HALF + 1];          /* of the sum of n of them */
    double whole[3 * ARC_HALF + 1];    /* the sum of n - 1, from -ARC_HALF, mirrored, and zeros on the right */
    double tail[ARC_HALF + 2];
} arc_scratch;

/* sum := sum * gamma~, directly (a Fourier transform has an absolute floor of 1e-16, which tails go far below). */
static void convolve_arc(arc_scratch *scratch)
{
    double *whole = scratch->whole + ARC_HALF, *sum = scratch->sum;
    for (int i = 0; i <= ARC_HALF; i++) {
        whole[i] = whole[-i] = sum[i];
        sum[i] *= scratch->mass[0];
    }
    for (int k = 1; k <= ARC_HALF; k++) {
        const double mass = scratch->mass[k], *left = whole - k, *right = whole + k;
        for (int i = 0; i <= ARC_HALF; i++)
            sum[i] += mass * (left[i] + right[i]);
    }
}

/* ln G(i step; n) = ln P(gamma~_1 + .. + gamma~_n >= i step) for all n. A tail is the trapezoid sum of the lattice density
 * without its Euler-Maclaurin term -step^2/12 f', which is a second difference of the tails over 12. At 0 stands the limit
 * from above, (1 - 2^-n) / 2. */
static void fill_arc(arc_scratch *scratch, double table[ASJ_MAX_ARC + 1][ASJ_NFA_ARC_CELLS + 1])
{
    double *tail = scratch->tail;
    fill_arc_rule(&scratch->rule);
    fill_arc_masses(&scratch->rule, scratch->mass, table[1]);
    for (int i = 0; i <= ARC_HALF; i++)
        scratch->sum[i] = scratch->mass[i];
    for (int i = 0; i <= 2 * ARC_HALF; i++)
        scratch->whole[ARC_HALF + i] = 0;
    for (int n = 2; n <= ASJ_MAX_ARC; n++) {
        convolve_arc(scratch);
        tail[ARC_HALF + 1] = 0;
        double above = 0;
        for (int i = ARC_HALF; i > 0; i--) {
            tail[i] = above + 0.5 * scratch->sum[i];
            above += scratch->sum[i];
        }
        tail[0] = 0.5 - ldexp(0.5, -n);
        table[n][0] = log(tail[0]);
        for (int i = 1; i <= ASJ_NFA_ARC_CELLS; i++)
            table[n][i] = log(tail[i] - (tail[i - 1] - 2 * tail[i] + tail[i + 1]) / 12);
    }
}

void asj_nfa_fill_arc(asj_nfa *nfa)
{
    static arc_scratch scratch; /* some 26 kB; this runs once, in the program that writes the tables */
    fill_arc(&scratch, nfa->arc);
}
