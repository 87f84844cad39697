/* SPDX-License-Identifier: BSD-2-Clause */
/* Real roots by the derivative's roots.
 *
 * Between two neighbouring roots of p' the polynomial p rises or falls all the way, so there is one root where the signs at both
 * ends differ, and none where they are equal. So: the roots in [-1, 1] of the derivative of order n - 1, which is a line, then
 * those of the one before it, up to p. The roots outside [-1, 1] are 1 / those of the reversed polynomial. Each is found by
 * Newton's steps kept in its interval by bisection. Nothing is random, nothing depends on a start. */
#include "polynomial.h"

#include <math.h>

#define STEPS 60

static double value(const double *c, int32_t degree, double x)
{
    double sum = c[degree];
    for (int32_t k = degree - 1; k >= 0; k--)
        sum = sum * x + c[k];
    return sum;
}

static double slope(const double *c, int32_t degree, double x)
{
    double sum = degree * c[degree];
    for (int32_t k = degree - 1; k >= 1; k--)
        sum = sum * x + k * c[k];
    return sum;
}

/* The root between `low` and `high`, where the signs differ, to within `error`. */
static double bracketed(const double *c, int32_t degree, double low, double high, double at_low, double error)
{
    double x = 0.5 * (low + high);
    for (int32_t step = 0; step < STEPS && high - low > error; step++) {
        const double y = value(c, degree, x);
        if (y == 0)
            return x;
        if ((y > 0) == (at_low > 0))
            low = x;
        else
            high = x;
        const double newton = x - y / slope(c, degree, x);
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
    double derived[ASJ_POLYNOMIAL_DEGREE + 1], turns[ASJ_POLYNOMIAL_DEGREE + 2];
    int32_t count = 0;
    for (int32_t n = 1; n <= degree; n++) { /* the derivative of order degree - n, a polynomial of degree n */
        const int32_t order = degree - n;
        for (int32_t k = 0; k <= n; k++) {
            derived[k] = c[k + order];
            for (int32_t j = 1; j <= order; j++)
                derived[k] *= k + j;
        }
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
                roots[count++] = bracketed(derived, n, turns[k], turns[k + 1], low, n < degree ? 1e-9 : 1e-15);
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
