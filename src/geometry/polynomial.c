/* SPDX-License-Identifier: BSD-2-Clause */
/* Real roots by Bernstein coefficients (Lane and Riesenfeld, "Bounds on a polynomial", BIT 1981).
 *
 * On [0, 1] a polynomial is a mean of its Bernstein coefficients with positive weights that depend on x, so it has no more roots
 * there than its coefficients change their sign, or an even number less: none for no change, one for one change. Where there are
 * more changes the interval is halved; de Casteljau's means give the coefficients of both halves. A root that is alone is found by
 * Newton's steps kept in its interval by bisection. So are those in [-1, 0], of p(-x), and those outside of [-1, 1], of the
 * reversed polynomial, whose roots are 1 / those of p. Nothing is random, nothing depends on a start. */
#include "polynomial.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define STEPS 60
#define DEEPEST 32 /* halvings: two roots nearer than 2^-32 are taken for one that the curve only touches */
#define SAME_ROOT 1e-12
#define NOTHING 1e-15 /* of the largest coefficient, which is 1 */
#define ROOT_ERROR 1e-13

/* A piece of [0, 1] and its coefficients. */
typedef struct piece {
    double low, high;
    int32_t depth;
    double b[ASJ_POLYNOMIAL_DEGREE + 1];
} piece;

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

/* The root between `low` and `high`, where the signs differ, to within ROOT_ERROR; first looked for at x. */
static double bracketed(const double *c, int32_t degree, double low, double high, double at_low, double x)
{
    for (int32_t step = 0; step < STEPS && high - low > ROOT_ERROR; step++) {
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
        if (fabs(next - x) < ROOT_ERROR)
            return next;
        x = next;
    }
    return x;
}

/* p(x), p(-x), and both of the reversed polynomial: all roots are roots of one of them in [0, 1], or their reciprocals. */
enum { AS_IT_IS, MIRRORED, REVERSED, REVERSED_MIRRORED, FORMS };

/* c_k x^k = c_k / binomial(n, k) times the sum over i of binomial(i, k) of the i-th Bernstein polynomial: Pascal's sums, of all
 * forms side by side, which compilers turn into vectors. binomial(n, n - k) is the same. */
static void to_bernstein(const double *c, int32_t degree, double b[ASJ_POLYNOMIAL_DEGREE + 1][FORMS])
{
    double binomial = 1;
    for (int32_t k = 0; k <= degree; k++) {
        const double one = c[k] / binomial;
        b[k][AS_IT_IS] = b[degree - k][REVERSED] = one;
        b[k][MIRRORED] = k % 2 ? -one : one;
        b[degree - k][REVERSED_MIRRORED] = (degree - k) % 2 ? -one : one;
        binomial = binomial * (degree - k) / (k + 1);
    }
    for (int32_t round = 1; round <= degree; round++)
        for (int32_t k = degree; k >= round; k--)
            for (int32_t form = 0; form < FORMS; form++)
                b[k][form] += b[k - 1][form];
}

/* The piece becomes its right half. */
static void halve(piece *p, int32_t degree, piece *left)
{
    const double middle = 0.5 * (p->low + p->high);
    left->low = p->low;
    left->high = middle;
    left->depth = ++p->depth;
    left->b[0] = p->b[0];
    for (int32_t round = 1; round <= degree; round++) {
        for (int32_t k = 0; k <= degree - round; k++)
            p->b[k] = 0.5 * (p->b[k] + p->b[k + 1]);
        left->b[round] = p->b[0];
    }
    p->low = middle;
}

static int32_t sign_changes(const double *b, int32_t degree)
{
    int32_t changes = 0;
    double last = 0;
    for (int32_t k = 0; k <= degree; k++) {
        changes += last * b[k] < 0;
        last = b[k] > 0 ? 1 : b[k] < 0 ? -1 : last;
    }
    return changes;
}

/* Where a line from `first` to `last` is 0, as a part of the way. */
static double chord(double first, double last)
{
    return (first < 0) == (last < 0) || first == 0 ? 0.5 : first / (first - last);
}

/* Roots of a form in (0, 1], rising, and 0 when the polynomial begins with it. c: its coefficients. */
static int32_t roots_to_one(const double *c, int32_t degree, double (*bernstein)[FORMS], int32_t form, double *roots)
{
    piece stack[DEEPEST + 2];
    int32_t count = 0, depth = 1;
    stack[0].low = 0;
    stack[0].high = 1;
    stack[0].depth = 0;
    for (int32_t k = 0; k <= degree; k++)
        stack[0].b[k] = bernstein[k][form];
    if (stack[0].b[0] == 0)
        roots[count++] = 0;
    if (fabs(stack[0].b[degree]) < NOTHING) /* a root at 1, rounded: else it would be taken for one of those before it */
        stack[0].b[degree] = 0;
    while (depth > 0 && count < degree) {
        piece *p = &stack[depth - 1];
        const double first = p->b[0], last = p->b[degree];
        const int32_t changes = sign_changes(p->b, degree);
        if (changes > (last != 0) && p->depth < DEEPEST) {
            halve(p, degree, &stack[depth]);
            depth++;
            continue;
        }
        if (last == 0)
            roots[count++] = p->high;
        else if (changes % 2 == 1)
            roots[count++] = bracketed(c, degree, p->low, p->high, -last, p->low + (p->high - p->low) * chord(first, last));
        depth--;
    }
    return count;
}

/* Roots in [-1, 1], rising, of the polynomial c or of the reversed one; form: AS_IT_IS or REVERSED, before its mirrored one. */
static int32_t roots_inside(const double *c, int32_t degree, double (*bernstein)[FORMS], int32_t form, double *roots)
{
    double mirrored[ASJ_POLYNOMIAL_DEGREE + 1], found[ASJ_POLYNOMIAL_DEGREE + 1];
    for (int32_t k = 0; k <= degree; k++)
        mirrored[k] = k % 2 ? -c[k] : c[k];
    const int32_t below = roots_to_one(mirrored, degree, bernstein, form + 1, found);
    int32_t count = 0;
    for (int32_t k = below - 1; k >= 0; k--)
        if (found[k] > 0)
            roots[count++] = -found[k];
    const int32_t above = roots_to_one(c, degree, bernstein, form, found);
    for (int32_t k = 0; k < above && count < degree; k++)
        roots[count++] = found[k];
    return count;
}

/* A root beside 1 or -1 is found by both passes, which round it differently. */
static int is_known(const double *roots, int32_t count, double root)
{
    for (int32_t k = 0; k < count; k++)
        if (fabs(roots[k] - root) <= SAME_ROOT)
            return 1;
    return 0;
}

int32_t asj_polynomial_roots(const double *c, int32_t degree, double *roots)
{
    double scaled[ASJ_POLYNOMIAL_DEGREE + 1], reversed[ASJ_POLYNOMIAL_DEGREE + 1], found[ASJ_POLYNOMIAL_DEGREE], largest = 0;
    double bernstein[ASJ_POLYNOMIAL_DEGREE + 1][FORMS];
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
    to_bernstein(scaled, degree, bernstein);
    int32_t count = roots_inside(scaled, degree, bernstein, AS_IT_IS, roots);
    const int32_t inside = count, outside = roots_inside(reversed, degree, bernstein, REVERSED, found);
    for (int32_t k = 0; k < outside && count < degree; k++)
        if (fabs(found[k]) > 1e-9 && fabs(found[k]) < 1 && !is_known(roots, inside, 1 / found[k]))
            roots[count++] = 1 / found[k];
    return count;
}
