/* SPDX-License-Identifier: BSD-2-Clause */
/* Tails of sums of gamma, the junction-ness of a pixel (nfa.c): the saddlepoint approximation, and tables for few terms. */
#include "nfa_tables.h"
#include "core/angle.h"

#include <float.h>
#include <math.h>

#define RATE_FROZEN 2 /* cells below which the correction is held, see rate_at() */

static const double root_half = 0.70710678118654752440;
static const double root_pi = 1.77245385090551602730;

/* ln Phi(-r), Phi the standard normal distribution function. Beyond 30, where erfc comes near its underflow, the asymptotic
 * series Phi(-r) = phi(r)/r (1 - 1/r^2 + 3/r^4 - ..), here good to 2e-14 relative. Never below -DBL_MAX. */
static double log_normal_tail(double r)
{
    if (r < 30)
        return log(0.5 * erfc(r * root_half));
    double q = 1 / (r * r);
    double series = 1 - q * (1 - 3 * q * (1 - 5 * q * (1 - 7 * q * (1 - 9 * q))));
    return fmax(-0.5 * r * r - log(r) + log(series / sqrt(2 * ASJ_PI)), -DBL_MAX);
}

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

static double hermite(double f0, double d0, double f1, double d1, double h, double p)
{
    double q = 1 - p;
    return f0 * q * q * (1 + 2 * p) + f1 * p * p * (1 + 2 * q) + h * p * q * (d0 * q - d1 * p);
}

/* ln F(t; n) by the formula of Lugannani and Rice in Barndorff-Nielsen's form (Adv. Appl. Prob. 12, 1980; J. R. Statist. Soc.
 * B 52, 1990): with x = t/n and kappa'(s) = x,
 *
 *     ln F = ln Phi(-r),  r = W + ln(V / W) / W,  W = sign(s) sqrt(2 n (s x - kappa(s))),  V = s sqrt(n kappa''(s)).
 *
 * W = sqrt(n) w and V = sqrt(n) v, where w and v depend on x only; hence r = sqrt(n) w + c / sqrt(n), c = ln(v / w) / w. Both w
 * and c are smooth, through the mean too, and are interpolated in u = sqrt(x) by cubic Hermite polynomials: near x = 0,
 * w = -sqrt(2 ln 2) + 1.80 u + .. is smooth in u but not in x. There, below RATE_FROZEN cells, c would grow like -ln u (the
 * approximation knows nothing of the atom at 0) and r would no more rise with u; c is held, and the caller bounds the result
 * by P(S > 0). Beyond the table w goes on along its tangent in x and c is held: ln F still behaves as -t^2/(2n). */
static void rate_at(const asj_nfa_rate *rate, double x, double *root, double *correction)
{
    double u = sqrt(x) * ASJ_NFA_PER_UNIT;
    if (!(u < ASJ_NFA_RATE_CELLS)) {
        const asj_nfa_rate *end = rate + ASJ_NFA_RATE_CELLS;
        double last = (double)ASJ_NFA_RATE_CELLS / ASJ_NFA_PER_UNIT;
        *root = end->root + (x - last * last) * end->root_slope / (2 * last);
        *correction = end->correction;
        return;
    }
    int i = (int)u;
    double p = u - i, h = 1.0 / ASJ_NFA_PER_UNIT;
    const asj_nfa_rate *at = rate + i;
    *root = hermite(at[0].root, at[0].root_slope, at[1].root, at[1].root_slope, h, p);
    if (i < RATE_FROZEN)
        *correction = rate[RATE_FROZEN].correction;
    else
        *correction = hermite(at[0].correction, at[0].correction_slope, at[1].correction, at[1].correction_slope, h, p);
}

static double saddlepoint(const asj_nfa *nfa, double t, int32_t n)
{
    double root, correction, many = sqrt((double)n);
    rate_at(nfa->rate, t / n, &root, &correction);
    double r = many * root + correction / many, tail = log_normal_tail(r);
    return r < 0 ? fmin(tail, log1p(-ldexp(1, -n))) : tail;
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

/* Where each value comes from: one term, closed form; up to ASJ_NFA_DIRECT terms, the table, and beyond its end the saddlepoint
 * shifted to meet it; else the saddlepoint, which is within 0.002 decades of the exact value for n = 7, 0.001 from n = 14,
 * less for more (for fewer: 0.0026 at n = 5, 0.025 at n = 2, hence the tables). Where the logarithm overflows, -DBL_MAX. A
 * t that is not a number, or n < 1, is no event: 0, the least significant value. */
double asj_nfa_log_sector_tail(const asj_nfa *nfa, double t, int32_t n)
{
    const double end = ASJ_NFA_STEP * ASJ_NFA_SECTOR_CELLS;
    if (!(t > 0) || n < 1)
        return 0;
    if (n == 1)
        return fmax(log(2) + 2 * log_normal_tail(t * root_half), -DBL_MAX);
    if (n > ASJ_NFA_DIRECT)
        return saddlepoint(nfa, t, n);
    if (t < end)
        return asj_nfa_interpolate(nfa->sector[n], t);
    return fmax(nfa->sector[n][ASJ_NFA_SECTOR_CELLS] + (saddlepoint(nfa, t, n) - saddlepoint(nfa, end, n)), -DBL_MAX);
}

asj_status asj_nfa_fill_sector(asj_memory *memory, asj_nfa *nfa)
{
    quadrature *rule = asj_allocate(memory, 1, sizeof *rule);
    if (!rule)
        return ASJ_ERROR_MEMORY;
    fill_quadrature(rule);
    fill_rate(rule, nfa->rate);
    fill_sector(nfa->sector);
    asj_release(memory, rule);
    return ASJ_OK;
}
