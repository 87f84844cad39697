/* SPDX-License-Identifier: BSD-2-Clause */
/* Real roots by the derivative's roots.
 *
 * Between two neighbouring roots of p' the polynomial p rises or falls all the way, so there is one root where the signs at both
 * ends differ, and none where they are equal. So: the roots in [-1, 1] of the derivative of order n - 1, which is a line, then
 * those of the one before it, up to p. The roots outside [-1, 1] are 1 / those of the reversed polynomial. Each is found by
 * Newton's steps kept in its interval by bisection. Nothing is random, nothing depends on a start. */
#include "polynomial.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define STEPS 60
#define TURN_ERROR 1e-5 /* of where a derivative is 0: only what lies between counts */
#define ROOT_ERROR 1e-13

static double value(const double *c, int32_t degree, double x)
{
    double sum = c[degree];
    for (int32_t k = degree - 1; k >= 0; k--)
        sum = sum * x + c[k];
    return sum;
}

/* The value, and the slope. */
static double value_and_slope(const double *c, int32_t degree, double x, double *slope)
{
    double sum = c[degree], along = 0;
    for (int32_t k = degree - 1; k >= 0; k--) {
        along = along * x + sum;
        sum = sum * x + c[k];
    }
    *slope = along;
    return sum;
}

/* The root between `low` and `high`, where the signs differ, to within `error`. */
static double bracketed(const double *c, int32_t degree, double low, double high, double at_low, double error)
{
    double x = 0.5 * (low + high);
    for (int32_t step = 0; step < STEPS && high - low > error; step++) {
        double slope;
        const double y = value_and_slope(c, degree, x, &slope);
        if (y == 0)
            return x;
        if ((y > 0) == (at_low > 0))
            low = x;
        else
            high = x;
        const double newton = x - y / slope;
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        if (fabs(next - x) < error)
            return next;
        x = next;
    }
    return x;
}

/* Roots in [-1, 1], rising. */
static int32_t roots_inside(const double *c, int32_t degree, double *roots)
{
    double all[ASJ_POLYNOMIAL_DEGREE + 1][ASJ_POLYNOMIAL_DEGREE + 1], turns[ASJ_POLYNOMIAL_DEGREE + 2];
    int32_t count = 0;
    memcpy(all[degree], c, (size_t)(degree + 1) * sizeof *c);
    for (int32_t n = degree - 1; n >= 1; n--)
        for (int32_t k = 0; k <= n; k++)
            all[n][k] = (k + 1) * all[n + 1][k + 1];
    for (int32_t n = 1; n <= degree; n++) { /* the derivative of order degree - n, a polynomial of degree n */
        const double *derived = all[n];
        turns[0] = -1;
        for (int32_t k = 0; k < count; k++)
            turns[k + 1] = roots[k];
        turns[count + 1] = 1;
        const int32_t intervals = count + 1;
        double low = value(derived, n, -1);
        count = 0;
        for (int32_t k = 0; k < intervals; k++) {
            const double high = value(derived, n, turns[k + 1]);
            if ((low > 0 && high <= 0) || (low < 0 && high >= 0))
                roots[count++] = bracketed(derived, n, turns[k], turns[k + 1], low, n < degree ? TURN_ERROR : ROOT_ERROR);
            low = high;
        }
    }
    return count;
}

int32_t asj_polynomial_roots(const double *c, int32_t degree, double *roots)
{
    double scaled[ASJ_POLYNOMIAL_DEGREE + 1], reversed[ASJ_POLYNOMIAL_DEGREE + 1], found[ASJ_POLYNOMIAL_DEGREE], largest = 0;
    for (int32_t k = 0; k <= degree; k++)
        largest = fmax(largest, fabs(c[k]));
    if (!(largest > 0) || !isfinite(largest))
        return 0;
    for (int32_t k = 0; k <= degree; k++) {
        if (!isfinite(c[k]))
            return 0;
        scaled[k] = c[k] / largest;
        reversed[degree - k] = scaled[k];
    }
    int32_t count = roots_inside(scaled, degree, roots);
    const int32_t outside = roots_inside(reversed, degree, found);
    for (int32_t k = 0; k < outside && count < degree; k++)
        if (fabs(found[k]) > 1e-9 && fabs(found[k]) < 1)
            roots[count++] = 1 / found[k];
    return count;
}
