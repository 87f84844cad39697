/* SPDX-License-Identifier: BSD-2-Clause */
/* The tables behind the tails of sums of gamma (nfa_sector.c): cumulants for the saddlepoint approximation, tails of few terms. */
#include "nfa_fill.h"
#include "core/angle.h"

#include <math.h>

static const double root_pi = 1.77245385090551602730;

/* ---- saddlepoint ---- */

/* The density of gamma, without its atom, as a quadrature rule. */
enum { PANELS = 17, QUADRATURE = PANELS * 2 * ASJ_NFA_GAUSS };
typedef struct quadrature {
    double z[QUADRATURE], mass[QUADRATURE];
} quadrature;

static double gamma_density(double z)
{
    return exp(-0.25 * z * z) * erfc(0.5 * z) / root_pi;
}

static void fill_quadrature(quadrature *rule)
{
    static const double edge[PANELS + 1] = {0, 0.125, 0.25, 0.5, 1, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26};
    int i = 0;
    for (int panel = 0; panel < PANELS; panel++) {
        double centre = 0.5 * (edge[panel + 1] + edge[panel]), half = 0.5 * (edge[panel + 1] - edge[panel]);
        for (int k = 0; k < 2 * ASJ_NFA_GAUSS; k++, i++) {
            rule->z[i] = centre + (k & 1 ? half : -half) * asj_nfa_gauss_node[k / 2];
            rule->mass[i] = half * asj_nfa_gauss_weight[k / 2] * gamma_density(rule->z[i]);
        }
    }
}

/* kappa(s) = ln E exp(s gamma) and its first three derivatives. */
static void cumulants(const quadrature *rule, double s, double kappa[4])
{
    double m0 = 0.5, m1 = 0, m2 = 0, m3 = 0;
    for (int i = 0; i < QUADRATURE; i++) {
        double z = rule->z[i], term = rule->mass[i] * exp(s * z);
        m0 += term;
        m1 += term * z;
        m2 += term * z * z;
        m3 += term * z * z * z;
    }
    m1 /= m0;
    m2 /= m0;
    m3 /= m0;
    kappa[0] = log(m0);
    kappa[1] = m1;
    kappa[2] = m2 - m1 * m1;
    kappa[3] = m3 - 3 * m1 * m2 + 2 * m1 * m1 * m1;
}

/* The table behind rate_at(): for each u solve kappa'(s) = u^2 by Newton's method, starting from the neighbour to the left.
 * No node falls on the mean (u = 0.5749), where w = 0 and the quotients below would be 0/0. */
static void fill_rate(const quadrature *rule, asj_nfa_rate *rate)
{
    double s = -sqrt(2 / root_pi) * ASJ_NFA_PER_UNIT, kappa[4];
    rate[0] = (asj_nfa_rate){-sqrt(2 * log(2)), 2 * sqrt(2 / root_pi) / sqrt(2 * log(2)), 0, 0};
    for (int i = 1; i <= ASJ_NFA_RATE_CELLS; i++) {
        double u = (double)i / ASJ_NFA_PER_UNIT, next = (double)(i + 1) / ASJ_NFA_PER_UNIT, x = u * u, move;
        int left = 50;
        do {
            cumulants(rule, s, kappa);
            move = (x - kappa[1]) / kappa[2];
            s += move;
        } while (fabs(move) > 1e-9 * (1 + fabs(s)) && --left);
        cumulants(rule, s, kappa);
        double w = copysign(sqrt(2 * (s * x - kappa[0])), s), v = s * sqrt(kappa[2]);
        double w_slope = 2 * u * s / w, v_slope = 2 * u * (1 / s + 0.5 * kappa[3] / kappa[2]) / kappa[2] * v;
        rate[i].root = w;
        rate[i].root_slope = w_slope;
        rate[i].correction = log(v / w) / w;
        rate[i].correction_slope = (v_slope / v - w_slope / w - log(v / w) * w_slope / w) / w;
        s += (next * next - x) / kappa[2];
    }
}

/* ---- tables for few terms ---- */

/* The integral of f(i) = a[i] b[cells - i] over `cells` cells of width 1, all weights positive: Gregory's rule of fourth
 * order, closed Newton-Cotes rules where that has no room. */
static double integrate_product(const double *a, const double *b, int cells)
{
    static const double gregory[3] = {3.0 / 8, 7.0 / 6, 23.0 / 24};
    static const double cotes[6][6] = {
        {0, 0, 0, 0, 0, 0},
        {1.0 / 2, 1.0 / 2, 0, 0, 0, 0},
        {1.0 / 3, 4.0 / 3, 1.0 / 3, 0, 0, 0},
        {3.0 / 8, 9.0 / 8, 9.0 / 8, 3.0 / 8, 0, 0},
        {14.0 / 45, 64.0 / 45, 24.0 / 45, 64.0 / 45, 14.0 / 45, 0},
        {95.0 / 288, 375.0 / 288, 250.0 / 288, 250.0 / 288, 375.0 / 288, 95.0 / 288},
    };
    double sum = 0;
    if (cells < 6) {
        for (int i = 0; i <= cells; i++)
            sum += cotes[cells][i] * a[i] * b[cells - i];
        return sum;
    }
    for (int i = 0; i < 3; i++)
        sum += gregory[i] * (a[i] * b[cells - i] + a[cells - i] * b[i]);
    for (int i = 3; i <= cells - 3; i++)
        sum += a[i] * b[cells - i];
    return sum;
}

/* F(t; n) = P(gamma >= t) + F(t; n-1) / 2 + integral over 0 < z < t of F(t - z; n-1) p(z) dz: acj-distribution-conv with
 * the last term split off, atom and density apart. Only positive terms are added, so that the relative error stays small
 * however small F is. */
static void fill_sector(double table[ASJ_NFA_DIRECT + 1][ASJ_NFA_SECTOR_CELLS + 1])
{
    double density[ASJ_NFA_SECTOR_CELLS + 1];
    for (int i = 0; i <= ASJ_NFA_SECTOR_CELLS; i++) {
        double q = erfc(0.5 * ASJ_NFA_STEP * i);
        density[i] = gamma_density(ASJ_NFA_STEP * i);
        table[1][i] = 0.5 * q * q;
    }
    for (int n = 2; n <= ASJ_NFA_DIRECT; n++)
        for (int i = 0; i <= ASJ_NFA_SECTOR_CELLS; i++)
            table[n][i] = table[1][i] + 0.5 * table[n - 1][i] + ASJ_NFA_STEP * integrate_product(density, table[n - 1], i);
    for (int n = 1; n <= ASJ_NFA_DIRECT; n++)
        for (int i = 0; i <= ASJ_NFA_SECTOR_CELLS; i++)
            table[n][i] = log(table[n][i]);
}

void asj_nfa_fill_sector(asj_nfa *nfa)
{
    quadrature rule;
    fill_quadrature(&rule);
    fill_rate(&rule, nfa->rate);
    fill_sector(nfa->sector);
}
