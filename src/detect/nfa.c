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
#include "nfa_tables.h"
#include "core/angle.h"

#include <float.h>
#include <math.h>

/* ---- thresholds, numbers of tests ---- */

/* To a relative 1e-14 and not below 1e-9, where `high` always passes. HUGE_VAL when there is none: log_p below -DBL_MAX, or not a
 * number. */
double asj_nfa_arc_threshold(const asj_nfa *nfa, double log_p, int32_t n)
{
    const double least = 1e-9;
    double low = 0, high = least;
    if (!(log_p >= -DBL_MAX))
        return HUGE_VAL;
    while (!(asj_nfa_log_arc_tail(nfa, high, n) <= log_p)) {
        low = high;
        high *= 2;
        if (high > DBL_MAX / 4)
            return HUGE_VAL;
    }
    if (high <= least)
        return high;
    while (high - low > 1e-14 * high) {
        double middle = 0.5 * (low + high);
        if (asj_nfa_log_arc_tail(nfa, middle, n) <= log_p)
            high = middle;
        else
            low = middle;
    }
    return high;
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
        double product = branches < 1 ? 0 : 1, orientations = floor(2 * ASJ_PI * r);
        for (int32_t m = 0; m < branches && product > 0; m++)
            product *= orientations * fmax(0, 1 - 2 * m * (tau / r) / ASJ_PI) / (m + 1);
        sum += product;
    }
    return width < 1 || height < 1 || !(sum > 0) ? -HUGE_VAL : log((double)width) + log((double)height) + log(sum);
}

const asj_nfa *asj_nfa_tables(void)
{
    return &asj_nfa_stored;
}
