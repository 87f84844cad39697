/* SPDX-License-Identifier: BSD-2-Clause */
/* Null distributions of the a-contrario tests, tails of their n-fold sums in the log domain, numbers of tests.
 *
 * Equation names are those of Xue et al., "Anisotropic-Scale Junction Detection and Matching for Indoor Images"; ACJ is Xia,
 * Delon, Gousseau, "Accurate junction detection and characterization in natural images", IJCV 2014. Logarithms are natural.
 *
 * gamma  (acj-distribution) = R max(|cos D| - |sin D|, 0), R Rayleigh(1), D uniform. That is sqrt(2) min(|A|, |B|) with
 *        probability 1/2, A and B independent standard normal, else 0. Atom 1/2 at 0; for z > 0 density
 *        (1/sqrt(pi)) exp(-z^2/4) erfc(z/2) and tail erfc(z/2)^2 / 2; mean 2 (sqrt(2) - 1) / sqrt(2 pi), variance
 *        1 - 2/pi - mean^2.
 * gamma~ (distribution-updated) = W max(|cos D| - |sin D|, 0), W standard normal. Symmetric, atom 1/2 at 0, and a density
 *        that is logarithmically infinite at 0: only its tail is used here.
 *
 * What is departed from: the paper (acj-distribution-conv) calls F a distribution function and convolves it numerically. F is
 * the upper tail, and one minus a distribution function cancels to 0 where it matters (the paper's "F = 0 for t > J/2" is
 * that). Here tails are sums of positive terms, or the saddlepoint approximation. The central limit theorem is nowhere used:
 * it is wrong by 4 to 18 powers of ten at the tails that decide. */
#include "nfa.h"

#include <float.h>
#include <math.h>

static const double pi = 3.14159265358979323846;
static const double root_half = 0.70710678118654752440;
static const double root_pi = 1.77245385090551602730;

enum {
    PER_UNIT = 32,             /* nodes per unit of every table: a power of two, so that finding a cell is exact */
    DIRECT = 6,                /* sums of up to this many gamma have a table; longer ones use the saddlepoint */
    SECTOR_CELLS = 16 * PER_UNIT,
    RATE_CELLS = 4 * PER_UNIT, /* saddlepoint: in u = sqrt(t / n) */
    RATE_FROZEN = 2,           /* cells below which the correction is held, see rate_at() */
    ARC_CELLS = 12 * PER_UNIT, /* sums of gamma~ */
    ARC_HALF = 16 * PER_UNIT   /* half-width of the lattice they are made on: wider, so that what is cut off does not count */
};
static const double step = 1.0 / PER_UNIT;

/* A node of the saddlepoint table and its derivatives with respect to u; see rate_at(). */
typedef struct rate_node {
    double root, root_slope, correction, correction_slope;
} rate_node;

struct asj_nfa {
    rate_node rate[RATE_CELLS + 1];
    double sector[DIRECT + 1][SECTOR_CELLS + 1]; /* ln F(i step; n); the first entry is the limit t -> 0 from above */
    double arc[ASJ_NFA_MAX_ARC + 1][ARC_CELLS + 1]; /* ln G(i step; n), likewise */
};

/* Gauss-Legendre, 16 points: positive half of the nodes on [-1, 1], weights (Abramowitz and Stegun, table 25.4). */
enum { GAUSS = 8 };
static const double gauss_node[GAUSS] = {0.095012509837637441, 0.28160355077925892, 0.45801677765722737, 0.61787624440264377,
                                         0.755404408355003,    0.86563120238783176, 0.9445750230732326,  0.98940093499164994};
static const double gauss_weight[GAUSS] = {0.18945061045506864, 0.18260341504492364, 0.16915651939500265, 0.14959598881657671,
                                           0.12462897125553407, 0.095158511682492605, 0.062253523938647456, 0.027152459411754176};

/* ln Phi(-r), Phi the standard normal distribution function. Beyond 30, where erfc comes near its underflow, the asymptotic
 * series Phi(-r) = phi(r)/r (1 - 1/r^2 + 3/r^4 - ..), here good to 2e-14 relative. Never below -DBL_MAX. */
static double log_normal_tail(double r)
{
    if (r < 30)
        return log(0.5 * erfc(r * root_half));
    double q = 1 / (r * r);
    double series = 1 - q * (1 - 3 * q * (1 - 5 * q * (1 - 7 * q * (1 - 9 * q))));
    return fmax(-0.5 * r * r - log(r) + log(series / sqrt(2 * pi)), -DBL_MAX);
}

/* Linear in a table of ln P against i * step, so that it falls wherever the table falls. The error, step^2/8 |(ln P)''| at
 * most, is below 6e-5 decades, save next to the infinite density of gamma~
 * at 0: there 3e-3 decades in the first cell of G, 6e-4 in the second, 6e-5 from s = 0.25 on. */
static double interpolate(const double *table, double x)
{
    double place = x * PER_UNIT;
    int cell = (int)place;
    return table[cell] + (table[cell + 1] - table[cell]) * (place - cell);
}

/* ---- sums of gamma: saddlepoint --------------------------------------------------------------------------------- */

/* The density of gamma, without its atom, as a quadrature rule. */
enum { PANELS = 17, QUADRATURE = PANELS * 2 * GAUSS };
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
        for (int k = 0; k < 2 * GAUSS; k++, i++) {
            rule->z[i] = centre + (k & 1 ? half : -half) * gauss_node[k / 2];
            rule->mass[i] = half * gauss_weight[k / 2] * gamma_density(rule->z[i]);
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
static void fill_rate(const quadrature *rule, rate_node *rate)
{
    double s = -sqrt(2 / root_pi) * PER_UNIT, kappa[4];
    rate[0] = (rate_node){-sqrt(2 * log(2)), 2 * sqrt(2 / root_pi) / sqrt(2 * log(2)), 0, 0};
    for (int i = 1; i <= RATE_CELLS; i++) {
        double u = (double)i / PER_UNIT, next = (double)(i + 1) / PER_UNIT, x = u * u, move;
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
static void rate_at(const rate_node *rate, double x, double *root, double *correction)
{
    double u = sqrt(x) * PER_UNIT;
    if (!(u < RATE_CELLS)) {
        const rate_node *end = rate + RATE_CELLS;
        double last = (double)RATE_CELLS / PER_UNIT;
        *root = end->root + (x - last * last) * end->root_slope / (2 * last);
        *correction = end->correction;
        return;
    }
    int i = (int)u;
    double p = u - i, h = 1.0 / PER_UNIT;
    const rate_node *at = rate + i;
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

/* ---- sums of gamma: tables for few terms ------------------------------------------------------------------------ */

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
static void fill_sector(double table[DIRECT + 1][SECTOR_CELLS + 1])
{
    double density[SECTOR_CELLS + 1];
    for (int i = 0; i <= SECTOR_CELLS; i++) {
        double q = erfc(0.5 * step * i);
        density[i] = gamma_density(step * i);
        table[1][i] = 0.5 * q * q;
    }
    for (int n = 2; n <= DIRECT; n++)
        for (int i = 0; i <= SECTOR_CELLS; i++)
            table[n][i] = table[1][i] + 0.5 * table[n - 1][i] + step * integrate_product(density, table[n - 1], i);
    for (int n = 1; n <= DIRECT; n++)
        for (int i = 0; i <= SECTOR_CELLS; i++)
            table[n][i] = log(table[n][i]);
}

/* Where each value comes from: one term, closed form; up to DIRECT terms, the table, and beyond its end the saddlepoint
 * shifted to meet it; else the saddlepoint, which is within 0.002 decades of the exact value for n = 7, 0.001 from n = 14,
 * less for more (for fewer: 0.0026 at n = 5, 0.025 at n = 2, hence the tables). Where the logarithm overflows, -DBL_MAX. A
 * t that is not a number, or n < 1, is no event: 0, the least significant value. */
double asj_nfa_log_sector_tail(const asj_nfa *nfa, double t, int32_t n)
{
    const double end = step * SECTOR_CELLS;
    if (!(t > 0) || n < 1)
        return 0;
    if (n == 1)
        return fmax(log(2) + 2 * log_normal_tail(t * root_half), -DBL_MAX);
    if (n > DIRECT)
        return saddlepoint(nfa, t, n);
    if (t < end)
        return interpolate(nfa->sector[n], t);
    return fmax(nfa->sector[n][SECTOR_CELLS] + (saddlepoint(nfa, t, n) - saddlepoint(nfa, end, n)), -DBL_MAX);
}

/* ---- sums of gamma~ --------------------------------------------------------------------------------------------- */

/* P(gamma~ >= z) = (2/pi) integral over 0 < x < pi/4 of Q(z / (cos x - sin x)) dx for z > 0, Q = normal upper tail, the
 * integral of distribution-updated over its tail; with cos x - sin x = sqrt(2) sin(pi/4 - x), and a = pi/4 - x. The panels
 * crowd towards a = 0, where the integrand falls to 0 within a distance of about z. */
enum { ARC_PANELS = 5, ARC_NODES = ARC_PANELS * 2 * GAUSS };
typedef struct arc_rule {
    double inverse[ARC_NODES], weight[ARC_NODES]; /* 1 / (2 sin a), and the weight with all factors */
} arc_rule;

static void fill_arc_rule(arc_rule *rule)
{
    const double edge[ARC_PANELS + 1] = {0, 1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0 / 2, pi / 4};
    int i = 0;
    for (int panel = 0; panel < ARC_PANELS; panel++) {
        double centre = 0.5 * (edge[panel + 1] + edge[panel]), half = 0.5 * (edge[panel + 1] - edge[panel]);
        for (int k = 0; k < 2 * GAUSS; k++, i++) {
            rule->inverse[i] = 0.5 / sin(centre + (k & 1 ? half : -half) * gauss_node[k / 2]);
            rule->weight[i] = half * gauss_weight[k / 2] / pi;
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
        double outer = arc_tail(rule, (i + 0.5) * step);
        cell[i] = (i ? 1 : 2) * (inner - outer);
        inner = outer;
    }
    for (int i = 0; i <= ARC_HALF; i++)
        mass[i] = cell[i] - (cell[i ? i - 1 : 1] - 2 * cell[i] + cell[i + 1]) / 24;
    mass[0] += 0.5;
    for (int i = 0; i <= ARC_CELLS; i++)
        table[i] = log(i ? arc_tail(rule, i * step) : 0.25);
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
static void fill_arc(arc_scratch *scratch, double table[ASJ_NFA_MAX_ARC + 1][ARC_CELLS + 1])
{
    double *tail = scratch->tail;
    fill_arc_rule(&scratch->rule);
    fill_arc_masses(&scratch->rule, scratch->mass, table[1]);
    for (int i = 0; i <= ARC_HALF; i++)
        scratch->sum[i] = scratch->mass[i];
    for (int i = 0; i <= 2 * ARC_HALF; i++)
        scratch->whole[ARC_HALF + i] = 0;
    for (int n = 2; n <= ASJ_NFA_MAX_ARC; n++) {
        convolve_arc(scratch);
        tail[ARC_HALF + 1] = 0;
        double above = 0;
        for (int i = ARC_HALF; i > 0; i--) {
            tail[i] = above + 0.5 * scratch->sum[i];
            above += scratch->sum[i];
        }
        tail[0] = 0.5 - ldexp(0.5, -n);
        table[n][0] = log(tail[0]);
        for (int i = 1; i <= ARC_CELLS; i++)
            table[n][i] = log(tail[i] - (tail[i - 1] - 2 * tail[i] + tail[i + 1]) / 12);
    }
}

/* Beyond the table a parabola goes on from it: the tail of the sum behaves as exp(-s^2/(2n)). Not below -DBL_MAX. 0
 * for s <= 0, which is no event, for an s that is not a number, and for n out of range. */
double asj_nfa_log_arc_tail(const asj_nfa *nfa, double s, int32_t n)
{
    const double end = step * ARC_CELLS;
    if (!(s > 0) || n < 1 || n > ASJ_NFA_MAX_ARC)
        return 0;
    const double *table = nfa->arc[n];
    if (s < end)
        return interpolate(table, s);
    double beyond = s - end, slope = (table[ARC_CELLS] - table[ARC_CELLS - 1]) / step;
    return fmax(table[ARC_CELLS] + beyond * (slope - beyond / (2 * n)), -DBL_MAX);
}

/* ---- thresholds, numbers of tests ------------------------------------------------------------------------------- */

/* The least x > 0, to a relative 1e-14 and not below 1e-9, with tail(x) <= log_p: bisection, keeping tail(high) <= log_p.
 * HUGE_VAL when there is none: log_p below -DBL_MAX, or not a number. */
static double invert(double (*tail)(const asj_nfa *, double, int32_t), const asj_nfa *nfa, double log_p, int32_t n)
{
    const double least = 1e-9;
    double low = 0, high = least;
    if (!(log_p >= -DBL_MAX))
        return HUGE_VAL;
    while (!(tail(nfa, high, n) <= log_p)) {
        low = high;
        high *= 2;
        if (high > DBL_MAX / 4)
            return HUGE_VAL;
    }
    if (high <= least)
        return high;
    while (high - low > 1e-14 * high) {
        double middle = 0.5 * (low + high);
        if (tail(nfa, middle, n) <= log_p)
            high = middle;
        else
            low = middle;
    }
    return high;
}

double asj_nfa_sector_threshold(const asj_nfa *nfa, double log_p, int32_t n)
{
    return log_p >= 0 ? 0 : invert(asj_nfa_log_sector_tail, nfa, log_p, n);
}

double asj_nfa_arc_threshold(const asj_nfa *nfa, double log_p, int32_t n)
{
    return invert(asj_nfa_log_arc_tail, nfa, log_p, n);
}

/* #J(M) = pixels * sum over r of (1/M!) prod_{m=0}^{M-1} K max(0, 1 - 2 m Delta / pi), K = floor(2 pi r), Delta = tau / r:
 * the number of tests of ACJ. K orientations for each branch, the order of the branches does not count, and the m-th branch
 * keeps clear, by one sector to either side (2 Delta of pi), of the m branches already there. Bit 0 of `radii` means nothing. */
double asj_nfa_log_junction_tests(int32_t width, int32_t height, uint32_t radii, double tau, int32_t branches)
{
    double sum = 0;
    for (int r = 1; r < 32; r++) {
        if (!(radii >> r & 1))
            continue;
        double product = branches < 1 ? 0 : 1, orientations = floor(2 * pi * r);
        for (int32_t m = 0; m < branches && product > 0; m++)
            product *= orientations * fmax(0, 1 - 2 * m * (tau / r) / pi) / (m + 1);
        sum += product;
    }
    return width < 1 || height < 1 || !(sum > 0) ? -HUGE_VAL : log((double)width) + log((double)height) + log(sum);
}

/* ---- life ------------------------------------------------------------------------------------------------------- */

asj_status asj_nfa_create(asj_memory *memory, asj_nfa **nfa)
{
    *nfa = NULL;
    asj_nfa *made = asj_allocate_zero(memory, 1, sizeof *made);
    quadrature *rule = asj_allocate(memory, 1, sizeof *rule);
    arc_scratch *scratch = asj_allocate(memory, 1, sizeof *scratch);
    if (made && rule && scratch) {
        fill_quadrature(rule);
        fill_rate(rule, made->rate);
        fill_sector(made->sector);
        fill_arc(scratch, made->arc);
        *nfa = made;
    } else {
        asj_release(memory, made);
    }
    asj_release(memory, scratch);
    asj_release(memory, rule);
    return *nfa ? ASJ_OK : ASJ_ERROR_MEMORY;
}

asj_status asj_nfa_open(asj_context *context)
{
    asj_nfa *nfa;
    if (asj_nfa_create(&context->memory, &nfa) != ASJ_OK)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the tables of the null model");
    context->null_model = (asj_kept){nfa, asj_release}; /* one block */
    return ASJ_OK;
}

void asj_nfa_free(asj_memory *memory, asj_nfa **nfa)
{
    if (!nfa)
        return;
    asj_release(memory, *nfa);
    *nfa = NULL;
}
