/* SPDX-License-Identifier: BSD-2-Clause */
/* Number of false alarms of a rectangle with n samples, k of them aligned with it up to an angle of p pi:
 *
 *     NFA = 6 (N M)^(5/2) B(n, k, p),     B(n, k, p) = sum_{j=k}^{n} C(n, j) p^j (1 - p)^(n - j)
 *
 * Source: von Gioi, Jakubowicz, Morel, Randall, "LSD: A fast line segment detector with a false detection control", PAMI 32(4),
 * 2010, section 2.7. In an image of N x M independent samples with level lines of uniform direction, p is the probability that one
 * is aligned. (N M)^(5/2) counts rectangles: (N M)^2 pairs of ends, sqrt(N M) widths. The factor is the number of precisions that
 * line_segments.c tries, which the bound on false alarms needs too.
 *
 * The tail is summed from its largest term on, term by term: C(n, j + 1) / C(n, j) = (n - j) / (j + 1). Below the mean, where the
 * terms still grow, the other side is summed instead. In logarithms, as B may be far below what a double holds. */
#include "line_segments_nfa.h"

#include <math.h>

double asj_segment_log_tests(int32_t width, int32_t height)
{
    return log(ASJ_SEGMENT_PRECISIONS) + 2.5 * log((double)width * height);
}

/* ln n!: Stirling's series, which is good to 1e-10 from 8 on. */
static double log_factorial(int32_t n)
{
    static const double small[] = {1, 1, 2, 6, 24, 120, 720, 5040};
    const double x = n, half_log_two_pi = 0.91893853320467274178;
    if (n < 8)
        return log(small[n]);
    return (x + 0.5) * log(x) - x + half_log_two_pi + (1 / 12.0 - (1 / 360.0 - 1 / (1260 * x * x)) / (x * x)) / x;
}

static double log_term(int32_t n, int32_t j, double p)
{
    return log_factorial(n) - log_factorial(j) - log_factorial(n - j) + j * log(p) + (n - j) * log1p(-p);
}

/* The sum of terms j = k .. n over the term k, where they fall from the first on. */
static double upper_sum(int32_t n, int32_t k, double p)
{
    const double odds = p / (1 - p);
    double term = 1, sum = 1;
    for (int32_t j = k; j < n && term > 1e-17 * sum; j++) {
        term *= (double)(n - j) / (j + 1) * odds;
        sum += term;
    }
    return sum;
}

/* The sum of terms j = k, k - 1, .. 0 over the term k. */
static double lower_sum(int32_t n, int32_t k, double p)
{
    const double odds = (1 - p) / p;
    double term = 1, sum = 1;
    for (int32_t j = k; j > 0 && term > 1e-17 * sum; j--) {
        term *= (double)j / (n - j + 1) * odds;
        sum += term;
    }
    return sum;
}

double asj_segment_log_tail(int32_t n, int32_t k, double p)
{
    if (k <= 0)
        return 0;
    if (k > (n + 1) * p)
        return log_term(n, k, p) + log(upper_sum(n, k, p));
    const double rest = exp(log_term(n, k - 1, p)) * lower_sum(n, k - 1, p);
    return log1p(-fmin(rest, 1));
}
