/* SPDX-License-Identifier: BSD-2-Clause */
/* Tails of sums of gamma, the junction-ness of a pixel (nfa.c): the saddlepoint approximation, and tables. */
#include "nfa_tables.h"
#include "core/angle.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#define RATE_FROZEN 2 /* cells below which the correction is held, see rate_at() */

static const double root_half = 0.70710678118654752440;

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

/* No gamma is above ASJ_GRADIENT_LIMIT = 3.5, but for rounding; the last node is for interpolation. */
int32_t asj_nfa_tail_length(int32_t n)
{
    return n * 36 * ASJ_TAIL_STEPS / 10 + 3;
}

const double *asj_nfa_tail(const asj_nfa *nfa, int32_t n)
{
    const double *tail = nfa->tails;
    if (n > ASJ_NFA_TAIL_TERMS)
        return NULL;
    for (int32_t terms = 1; terms < n; terms++)
        tail += asj_nfa_tail_length(terms);
    return tail;
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
