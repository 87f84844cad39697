/* SPDX-License-Identifier: BSD-2-Clause */
/* Tails, thresholds and numbers of tests of src/detect/nfa.c against check values, naive evaluations and a simulation. */
#include "detect/gradient.h"
#include "detect/nfa.h"
#include "detect/nfa_tables.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

/* The saddlepoint's stated error, and that of the interpolated tables together with the six printed digits of the check
 * values, in decades. */
static const double saddlepoint_error = 2e-3, table_error = 6e-5;

/* ---- the tables ------------------------------------------------------------------------------------------------------------ */

typedef struct fixture {
    const asj_nfa *nfa;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    f.nfa = asj_nfa_tables();
    *state = &f;
    return 0;
}

static void check_near(const char *what, double n, double x, double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%s(%g; %g) = %.9g, expected %.9g within %g", what, x, n, value, expected, tolerance);
}

static double sector(const fixture *f, double t, int32_t n)
{
    return asj_nfa_log_sector_tail(f->nfa, t, n) / log(10);
}

static double arc(const fixture *f, double s, int32_t n)
{
    return asj_nfa_log_arc_tail(f->nfa, s, n) / log(10);
}

/* ---- check values ------------------------------------------------------------------------------------------------------- */

typedef struct check {
    int32_t n;
    double x, log10_tail;
} check;

static void test_constants(void **state)
{
    (void)state;
    double mean = 2 * (sqrt(2) - 1) / sqrt(2 * pi), square = 1 - 2 / pi;
    check_near("mean", 1, 0, ASJ_GAMMA_MEAN, mean, 1e-14);
    check_near("sd", 1, 0, ASJ_GAMMA_SD, sqrt(square - mean * mean), 1e-14);
}

static void test_one_term(void **state)
{
    const asj_nfa *nfa = ((fixture *)*state)->nfa;
    static const double sectors[][2] = {{0.5, 0.261851746783}, {1, 0.114960183589}, {2, 0.0123715202693}, {4, 1.09406022765e-5}};
    static const double arcs[][2] = {{0.25, 0.133212852273}, {0.5, 0.0784082640769}, {1, 0.0261308354578}, {2, 0.00189403798830},
                                     {3, 6.56203478166e-5}};
    for (size_t i = 0; i < sizeof sectors / sizeof *sectors; i++)
        check_near("F", 1, sectors[i][0], exp(asj_nfa_log_sector_tail(nfa, sectors[i][0], 1)) / sectors[i][1], 1, 1e-11);
    for (size_t i = 0; i < sizeof arcs / sizeof *arcs; i++)
        check_near("G", 1, arcs[i][0], exp(asj_nfa_log_arc_tail(nfa, arcs[i][0], 1)) / arcs[i][1], 1, 1e-11);
}

/* Exact values: direct convolution of positive masses on lattices of two widths, extrapolated. */
static void test_sector_values(void **state)
{
    static const check values[] = {
        {2, 1, -0.572529},   {2, 4, -3.099326},   {4, 4, -1.808373},   {5, 2, -0.473878},  {5, 5, -2.078484},
        {5, 10, -6.451936},  {10, 5, -0.835511},  {10, 10, -3.373237}, {10, 20, -11.8828}, {14, 10, -2.164048},
        {14, 15, -5.021225}, {14, 20, -8.731552}, {14, 30, -18.32258}, {20, 15, -3.10137}, {28, 40, -16.3568},
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        check_near("log10 F", values[i].n, values[i].x, sector(*state, values[i].x, values[i].n), values[i].log10_tail,
                   values[i].n <= 5 ? table_error : saddlepoint_error);
}

/* F(J/2; J): the paper holds that it is 0. Printed to the last digit or two. */
static void test_long_sums(void **state)
{
    static const check values[] = {{10, 5, -0.84},    {30, 15, -1.38},  {60, 30, -2.11},
                                   {200, 100, -5.2}, {1000, 500, -22}, {3000, 1500, -63.6}};
    static const double digit[] = {0.005, 0.005, 0.005, 0.05, 0.5, 0.05};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        check_near("log10 F", values[i].n, values[i].x, sector(*state, values[i].x, values[i].n), values[i].log10_tail, digit[i]);
}

static void test_arc_values(void **state)
{
    static const check values[] = {
        {1, 1, -1.582847},    {2, 1, -1.274242}, {2, 2, -2.248605}, {3, 2, -1.962285},   {4, 2, -1.760541},
        {5, 1, -0.897061},    {5, 2, -1.607617}, {5, 3, -2.425557}, {5, 3.34, -2.723272}, {5, 5, -4.298712},
        {5, 10, -10.04626},   {6, 3, -2.245191}, {7, 3, -2.096696}, {7, 6, -4.655033},
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        check_near("log10 G", values[i].n, values[i].x, arc(*state, values[i].x, values[i].n), values[i].log10_tail, table_error);
}

static void test_arc_thresholds(void **state)
{
    static const double expected[] = {2.64, 3.02, 3.34, 3.62, 3.86, 4.10}; /* next higher point of a lattice of 0.02 */
    for (int32_t n = 2; n <= 7; n++) {
        double s = asj_nfa_arc_threshold(((fixture *)*state)->nfa, -log(906), n);
        check_near("threshold", n, 906, s, expected[n - 2] - 0.01, 0.011);
    }
}

static uint32_t radii_from(int first, int last)
{
    uint32_t bits = 0;
    for (int r = first; r <= last; r++)
        bits |= (uint32_t)1 << r;
    return bits;
}

static void test_junction_tests(void **state)
{
    static const double expected[3][5] = {{19.762, 22.891, 25.574, 27.886, 29.845},
                                          {20.041, 23.356, 26.235, 28.764, 30.974},
                                          {17.235, 20.364, 23.047, 25.359, 27.318}};
    (void)state;
    for (int32_t m = 1; m <= 5; m++) {
        check_near("ln #J", m, 0, asj_nfa_log_junction_tests(1052, 780, radii_from(3, 12), 2, m), expected[0][m - 1], 6e-4);
        check_near("ln #J", m, 1, asj_nfa_log_junction_tests(1052, 780, radii_from(4, 14), 2, m), expected[1][m - 1], 6e-4);
        check_near("ln #J", m, 2, asj_nfa_log_junction_tests(256, 256, radii_from(3, 12), 2, m), expected[2][m - 1], 6e-4);
    }
    check_near("ln #J", 1, 3, asj_nfa_log_junction_tests(1, 1, 1u << 31, 2, 1), log(194), 1e-12);
    assert_true(asj_nfa_log_junction_tests(10, 10, 1u << 3, 2, 4) == -HUGE_VAL); /* 1 - 6 (2/3) / pi < 0 */
    assert_true(isfinite(asj_nfa_log_junction_tests(10, 10, 1u << 3, 2, 3)));
    assert_true(asj_nfa_log_junction_tests(10, 10, 1, 2, 1) == -HUGE_VAL);
    assert_true(asj_nfa_log_junction_tests(10, 10, 0, 2, 1) == -HUGE_VAL);
    assert_true(asj_nfa_log_junction_tests(10, 10, 1u << 3, 2, 0) == -HUGE_VAL);
    assert_true(asj_nfa_log_junction_tests(0, 10, 1u << 3, 2, 1) == -HUGE_VAL);
}

/* ---- naive evaluation ---------------------------------------------------------------------------------------------------- */

enum { NAIVE = 4096 };

/* Tail at x of the sum of n variables, each rounded to the lattice -cells .. cells: the definition, term by term. */
static double naive_tail(const double *mass, int cells, int n, double x, double width)
{
    static double sum[2 * NAIVE + 1], next[2 * NAIVE + 1];
    int size = 2 * cells + 1, at = (int)lround(x / width) + cells;
    memcpy(sum, mass, (size_t)size * sizeof *sum);
    for (int term = 2; term <= n; term++) {
        for (int i = 0; i < size; i++) {
            next[i] = 0;
            for (int k = 0; k < size; k++) {
                int left = i - (k - cells);
                if (mass[k] > 0 && left >= 0 && left < size)
                    next[i] += mass[k] * sum[left];
            }
        }
        memcpy(sum, next, (size_t)size * sizeof *sum);
    }
    double tail = 0.5 * sum[at];
    for (int i = at + 1; i < size; i++)
        tail += sum[i];
    return tail;
}

static double gamma_tail(double z)
{
    return 0.5 * erfc(0.5 * z) * erfc(0.5 * z);
}

static void gamma_masses(double *mass, int cells, double width)
{
    for (int i = 0; i < cells; i++)
        mass[i] = 0;
    mass[cells] = 1 - gamma_tail(0.5 * width);
    for (int i = 1; i <= cells; i++)
        mass[cells + i] = gamma_tail((i - 0.5) * width) - gamma_tail((i + 0.5) * width);
}

/* The paper's density (distribution-updated), midpoint rule in y and in the cell; what is left to 1 goes to 0. */
static void arc_masses(double *mass, int cells, double width)
{
    double rest = 1;
    for (int i = 1; i <= cells; i++) {
        double z = i * width, density = 0;
        for (int k = 0; k < 500; k++) {
            double y = (k + 0.5) / 500;
            density += exp(-z * z / (2 * y * y)) / (y * sqrt(2 - y * y)) / 500;
        }
        mass[cells + i] = mass[cells - i] = density * sqrt(2 / (pi * pi * pi)) * width;
        rest -= 2 * mass[cells + i];
    }
    mass[cells] = rest;
}

/* log10 of a tail from lattices of width 2 w and w; the leading error goes with the square of the width. */
static double naive_log10(void (*masses)(double *, int, double), int n, double x, double width, double range)
{
    static double mass[2 * NAIVE + 1];
    double tail[2];
    for (int i = 0; i < 2; i++) {
        double w = i ? width : 2 * width;
        int cells = (int)lround(range / w);
        masses(mass, cells, w);
        tail[i] = naive_tail(mass, cells, n, x, w);
    }
    return log10((4 * tail[1] - tail[0]) / 3);
}

/* The naive lattices themselves are good to about 1e-4 decades. */
static void test_sector_naive(void **state)
{
    static const check points[] = {{2, 0.24, 0}, {2, 3, 0}, {3, 0.6, 0}, {3, 6, 0},  {6, 1.8, 0}, {6, 9, 0},
                                   {7, 1.2, 0},  {7, 4.2, 0}, {7, 12, 0}, {9, 3, 0}, {12, 9, 0}};
    for (size_t i = 0; i < sizeof points / sizeof *points; i++)
        check_near("log10 F, naive", points[i].n, points[i].x, sector(*state, points[i].x, points[i].n),
                   naive_log10(gamma_masses, points[i].n, points[i].x, 0.02, 18), 1e-4 + (points[i].n > 6 ? saddlepoint_error : 0));
}

/* 1e-3 is the required accuracy of G. */
static void test_arc_naive(void **state)
{
    static const check points[] = {{2, 0.6, 0}, {2, 3, 0}, {3, 0.3, 0}, {4, 4.2, 0},
                                   {5, 1.5, 0}, {6, 6, 0}, {7, 0.6, 0}, {7, 11.7, 0}};
    for (size_t i = 0; i < sizeof points / sizeof *points; i++)
        check_near("log10 G, naive", points[i].n, points[i].x, arc(*state, points[i].x, points[i].n),
                   naive_log10(arc_masses, points[i].n, points[i].x, 0.015, 18), 1e-3);
}

/* ---- simulation ---------------------------------------------------------------------------------------------------------- */

/* Uniform on (0, 1): xorshift64* (Vigna, ACM TOMS 42, 2016). */
static double uniform(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return ((double)((*seed * UINT64_C(2685821657736338717)) >> 11) + 0.5) / 9007199254740992.0;
}

/* Sums of n terms, straight from the null hypothesis. Within 4.5 standard errors: one wrong alarm in 10000 such tests. */
static void simulate(const fixture *f, int is_arc, int32_t n, double x, uint64_t seed)
{
    const int trials = 200000;
    int hits = 0;
    for (int i = 0; i < trials; i++) {
        double sum = 0;
        for (int32_t k = 0; k < n; k++) {
            double rayleigh = sqrt(-2 * log(uniform(&seed))), normal = rayleigh * cos(2 * pi * uniform(&seed));
            double angle = 2 * pi * uniform(&seed);
            sum += (is_arc ? normal : rayleigh) * fmax(fabs(cos(angle)) - fabs(sin(angle)), 0);
        }
        hits += sum >= x;
    }
    double p = exp(is_arc ? asj_nfa_log_arc_tail(f->nfa, x, n) : asj_nfa_log_sector_tail(f->nfa, x, n));
    check_near(is_arc ? "simulated G" : "simulated F", n, x, (double)hits / trials, p, 4.5 * sqrt(p * (1 - p) / trials));
}

static void test_simulation(void **state)
{
    simulate(*state, 0, 1, 1, 1);
    simulate(*state, 0, 3, 0.5, 2);
    simulate(*state, 0, 5, 2.5, 3);
    simulate(*state, 0, 9, 5, 4);
    simulate(*state, 0, 14, 3, 5);
    simulate(*state, 1, 1, 0.5, 6);
    simulate(*state, 1, 3, 1, 7);
    simulate(*state, 1, 5, 2, 8);
    simulate(*state, 1, 7, 1, 9);
}

/* ---- shape --------------------------------------------------------------------------------------------------------------- */

typedef double tail_function(const asj_nfa *nfa, double x, int32_t n);

static void check_falling(const char *what, tail_function *tail, const asj_nfa *nfa, int32_t n, double dx, double end)
{
    double last = tail(nfa, 0, n);
    for (int i = 1; i * dx < end; i++) {
        double value = tail(nfa, i * dx, n);
        if (!(value <= last))
            fail_msg("%s rises at x = %g, n = %d: %.17g after %.17g", what, i * dx, (int)n, value, last);
        last = value;
    }
}

static void test_monotone(void **state)
{
    static const int32_t some[] = {44, 75, 120, 360, 1000, 5000};
    const asj_nfa *nfa = ((fixture *)*state)->nfa;
    for (int32_t n = 1; n <= 40; n++) {
        check_falling("F", asj_nfa_log_sector_tail, nfa, n, 1e-3, 5 * n + 20);
        check_falling("F", asj_nfa_log_sector_tail, nfa, n, 1e-6, 0.02); /* next to the atom */
    }
    for (size_t i = 0; i < sizeof some / sizeof *some; i++)
        check_falling("F", asj_nfa_log_sector_tail, nfa, some[i], 1e-4 * some[i], 20.0 * some[i]);
    for (int32_t n = 1; n <= ASJ_MAX_ARC; n++)
        check_falling("G", asj_nfa_log_arc_tail, nfa, n, 1e-3, 30);
}

/* One more term can only raise a sum of gamma. */
static void test_monotone_in_n(void **state)
{
    for (double t = 0.1; t < 30; t += 0.1)
        for (int32_t n = 1; n < 60; n++)
            if (sector(*state, t, n) > sector(*state, t, n + 1))
                fail_msg("F(%g; %d) > F(%g; %d)", t, (int)n, t, (int)n + 1);
}

/* No jump where tables end, nor where the normal tail turns to its series (30 = t / sqrt(2) for one term): a small step changes
 * the logarithm by no more than the slope there allows, which is about t/n for F. */
static void test_seams(void **state)
{
    const double d = 1e-7;
    for (int32_t n = 2; n <= 7; n++) {
        check_near("seam", n, 16, sector(*state, 16 + d, n), sector(*state, 16 - d, n), 10 * d);
        check_near("seam", n, 12, arc(*state, 12 + d, n), arc(*state, 12 - d, n), 10 * d);
    }
    double t = 30 * sqrt(2);
    check_near("seam", 1, t, sector(*state, t + d, 1), sector(*state, t - d, 1), 50 * d);
    check_near("seam", 100, 1600, sector(*state, 1600 + d, 100), sector(*state, 1600 - d, 100), 20 * d);
}

static void test_atom(void **state)
{
    for (int32_t n = 1; n <= 7; n++) {
        assert_true(asj_nfa_log_sector_tail(((fixture *)*state)->nfa, 0, n) == 0);
        check_near("F at 0+", n, 0, pow(10, arc(*state, 1e-12, n)), (1 - pow(2, -n)) / 2, 1e-9);
        if (n <= 6)
            check_near("F at 0+", n, 0, pow(10, sector(*state, 1e-12, n)), 1 - pow(2, -n), 1e-9);
    }
    for (int32_t n = 7; n <= 60; n++) {
        double p = pow(10, sector(*state, 1e-12, n)), exact = 1 - pow(2, -n);
        assert_true(p <= exact);
        check_near("F at 0+", n, 0, p, exact, saddlepoint_error * log(10));
    }
}

/* Stored nodes are the tails at their places, to the last digits of two machines' libm, and reach beyond the largest sum. */
static void test_stored_tails(void **state)
{
    const asj_nfa *nfa = ((fixture *)*state)->nfa;
    for (int32_t n = 1; n <= ASJ_NFA_TAIL_TERMS; n++) {
        const double *tail = asj_nfa_tail(nfa, n);
        const int32_t length = asj_nfa_tail_length(n);
        assert_true(tail >= nfa->tails && tail + length <= nfa->tails + ASJ_NFA_TAILS);
        assert_true((double)(length - 2) / ASJ_TAIL_STEPS > n * ASJ_GRADIENT_LIMIT);
        for (int32_t i = 0; i < length; i++) {
            const double exact = asj_nfa_log_sector_tail(nfa, (double)i / ASJ_TAIL_STEPS, n);
            check_near("stored tail", n, (double)i / ASJ_TAIL_STEPS, tail[i], exact, 1e-12 * (1 + fabs(exact)));
        }
    }
    assert_null(asj_nfa_tail(nfa, ASJ_NFA_TAIL_TERMS + 1));
}

static void test_thresholds_invert(void **state)
{
    static const double logs[] = {-1e-3, -0.1, -1, -7, -20, -100, -1000, -1e6};
    const asj_nfa *nfa = ((fixture *)*state)->nfa;
    for (size_t k = 0; k < sizeof logs / sizeof *logs; k++)
        for (int32_t n = 1; n <= ASJ_MAX_ARC; n++) {
            double s = asj_nfa_arc_threshold(nfa, logs[k], n);
            assert_true(s > 0);
            assert_true(asj_nfa_log_arc_tail(nfa, s, n) <= logs[k]);
            assert_true(asj_nfa_log_arc_tail(nfa, s * (1 - 1e-9) - 1e-9, n) > logs[k]);
        }
    assert_true(asj_nfa_arc_threshold(nfa, 0, 5) > 0);
    assert_true(asj_nfa_arc_threshold(nfa, 0, 5) < 1e-6);
    assert_true(asj_nfa_arc_threshold(nfa, -HUGE_VAL, 5) == HUGE_VAL);
    assert_true(asj_nfa_arc_threshold(nfa, (double)NAN, 5) == HUGE_VAL);
}

static void test_extremes(void **state)
{
    static const double absurd[] = {1e3, 1e6, 1e100, 1e155, 1e300, DBL_MAX, HUGE_VAL};
    static const int32_t terms[] = {1, 2, 4, 6, 7, 100, 5000, INT32_MAX};
    const asj_nfa *nfa = ((fixture *)*state)->nfa;
    for (size_t k = 0; k < sizeof absurd / sizeof *absurd; k++) {
        for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
            double value = asj_nfa_log_sector_tail(nfa, absurd[k], terms[i]);
            assert_true(isfinite(value));
            assert_true(value <= 0);
        }
        for (int32_t n = 1; n <= ASJ_MAX_ARC; n++)
            assert_true(isfinite(asj_nfa_log_arc_tail(nfa, absurd[k], n)) && asj_nfa_log_arc_tail(nfa, absurd[k], n) < -100);
    }
    /* ln F and ln G are -x^2/(2n) to leading order. */
    for (int32_t n = 1; n <= ASJ_MAX_ARC; n++)
        check_near("asymptote", n, 1e50, asj_nfa_log_arc_tail(nfa, 1e50, n) / (-1e100 / (2.0 * n)), 1, 0.02);
    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        double leading = -1e100 / (2.0 * terms[i]);
        check_near("asymptote", terms[i], 1e50, asj_nfa_log_sector_tail(nfa, 1e50, terms[i]) / leading, 1, 0.02);
    }
    assert_true(asj_nfa_log_sector_tail(nfa, -1, 5) == 0);
    assert_true(asj_nfa_log_sector_tail(nfa, (double)NAN, 5) == 0);
    assert_true(asj_nfa_log_sector_tail(nfa, 1, 0) == 0);
    assert_true(asj_nfa_log_arc_tail(nfa, 0, 5) == 0);
    assert_true(asj_nfa_log_arc_tail(nfa, (double)NAN, 5) == 0);
    assert_true(asj_nfa_log_arc_tail(nfa, 1, ASJ_MAX_ARC + 1) == 0);
    assert_true(asj_nfa_log_sector_tail(nfa, 5000 * ASJ_GAMMA_MEAN, 5000) > log(0.49));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constants),      cmocka_unit_test(test_one_term),        cmocka_unit_test(test_sector_values),
        cmocka_unit_test(test_long_sums),      cmocka_unit_test(test_arc_values),      cmocka_unit_test(test_arc_thresholds),
        cmocka_unit_test(test_junction_tests), cmocka_unit_test(test_sector_naive),    cmocka_unit_test(test_arc_naive),
        cmocka_unit_test(test_simulation),     cmocka_unit_test(test_monotone),        cmocka_unit_test(test_monotone_in_n),
        cmocka_unit_test(test_seams),          cmocka_unit_test(test_atom),            cmocka_unit_test(test_thresholds_invert),
        cmocka_unit_test(test_extremes),       cmocka_unit_test(test_stored_tails),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
