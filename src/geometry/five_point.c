/* SPDX-License-Identifier: BSD-2-Clause */
/* The essential matrix of five points (Nister, "An efficient solution to the five-point relative pose problem", PAMI 2004).
 *
 * Each pair gives one linear equation for the nine entries of E; five leave four solutions X, Y, Z, W of unit length:
 *
 *     E = x X + y Y + z Z + W.
 *
 * A matrix is essential exactly when  det E = 0  and  2 E E' E - trace(E E') E = 0: ten equations of degree three in x, y, z
 * (Nister, equations 8 and 9; the latter as (E E' - trace(E E') / 2) E = 0). In the order of monomials
 *
 *     x3 y3 x2y xy2 x2z x2 y2z y2 xyz xy | xz2 xz x yz2 yz y z3 z2 z 1
 *
 * Gauss-Jordan elimination leaves, of the rows led by x2z, x2 (e, f), y2z, y2 (g, h) and xyz, xy (i, j), that e - z f, g - z h and
 * i - z j have no monomials of degree above one in x and y: B(z) (x, y, 1)' = 0 with polynomials in z. det B(z) has degree ten; for
 * each of its real roots x and y follow from the null space of B(z).
 *
 * The elimination pivots on rows; the roots come from polynomial.c. Departure: none in the mathematics. */
#include "five_point.h"
#include "polynomial.h"
#include "small_matrix.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define WANTED 4 /* the row led by x2z */

/* Polynomials in x, y, z: of degree one [x y z 1]; of degree two [xx xy xz x yy yz y zz z 1]; of degree three as above. */
static const uint8_t square_of[4][4] = {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};
static const uint8_t cube_of[10][4] = {{0, 2, 4, 5},     {2, 3, 8, 9},     {4, 8, 10, 11},   {5, 9, 11, 12},   {3, 1, 6, 7},
                                       {8, 6, 13, 14},   {9, 7, 14, 15},   {10, 13, 16, 17}, {11, 14, 17, 18}, {12, 15, 18, 19}};

/* out += factor a b */
static void add_product11(const double a[4], const double b[4], double factor, double out[10])
{
    for (int32_t i = 0; i < 4; i++)
        for (int32_t k = 0; k < 4; k++)
            out[square_of[i][k]] += factor * a[i] * b[k];
}

static void add_product21(const double a[10], const double b[4], double out[20])
{
    for (int32_t i = 0; i < 10; i++)
        for (int32_t k = 0; k < 4; k++)
            out[cube_of[i][k]] += a[i] * b[k];
}

/* The ten equations; entry[n] is the n-th entry of E as a polynomial. */
static void equations(double entry[9][4], double rows[10][20])
{
    double square[9][10];
    memset(rows, 0, 10 * sizeof *rows);
    memset(square, 0, sizeof square);
    for (int32_t i = 0; i < 3; i++)
        for (int32_t k = 0; k <= i; k++) {
            for (int32_t j = 0; j < 3; j++)
                add_product11(entry[3 * i + j], entry[3 * k + j], 1, square[3 * i + k]);
            if (k < i)
                memcpy(square[3 * k + i], square[3 * i + k], sizeof *square);
        }
    for (int32_t n = 0; n < 10; n++) {
        const double trace = square[0][n] + square[4][n] + square[8][n];
        for (int32_t i = 0; i < 3; i++)
            square[4 * i][n] -= 0.5 * trace;
    }
    for (int32_t i = 0; i < 3; i++)
        for (int32_t k = 0; k < 3; k++)
            for (int32_t j = 0; j < 3; j++)
                add_product21(square[3 * i + j], entry[3 * j + k], rows[3 * i + k]);
    for (int32_t k = 0; k < 3; k++) { /* det E along the first row */
        const int32_t p = (k + 1) % 3, q = (k + 2) % 3;
        double minor[10] = {0};
        add_product11(entry[3 + p], entry[6 + q], 1, minor);
        add_product11(entry[3 + q], entry[6 + p], -1, minor);
        add_product21(minor, entry[k], rows[9]);
    }
}

/* Of the rows before the first one that is wanted it is enough that they have been subtracted from those behind them. */
static int32_t eliminate(double rows[10][20])
{
    for (int32_t at = 0; at < 10; at++) {
        int32_t best = at;
        for (int32_t i = at + 1; i < 10; i++)
            if (fabs(rows[i][at]) > fabs(rows[best][at]))
                best = i;
        const double lead = rows[best][at];
        if (!(fabs(lead) > 1e-14) || !isfinite(lead))
            return 0;
        for (int32_t k = at; k < 20; k++) {
            const double keep = rows[at][k];
            rows[at][k] = rows[best][k] / lead;
            if (best != at)
                rows[best][k] = keep;
        }
        for (int32_t i = at < WANTED ? at + 1 : WANTED; i < 10; i++) {
            const double factor = i == at ? 0 : rows[i][at];
            for (int32_t k = at; k < 20 && factor != 0; k++)
                rows[i][k] -= factor * rows[at][k];
        }
    }
    return 1;
}

/* Row n of B(z): e - z f, lowest power first: [0] of x (degree 3), [1] of y (3), [2] of 1 (4). */
static void row_of_b(const double e[20], const double f[20], double b[3][5])
{
    static const int32_t first[3] = {10, 13, 16}, degree[3] = {2, 2, 3};
    for (int32_t c = 0; c < 3; c++) {
        const int32_t n = degree[c];
        for (int32_t k = 0; k < 5; k++) {
            const double of_e = k <= n ? e[first[c] + n - k] : 0;
            const double of_f = k >= 1 && k <= n + 1 ? f[first[c] + n - (k - 1)] : 0;
            b[c][k] = of_e - of_f;
        }
    }
}

/* out += factor a b, of degrees m and n. */
static void add_product(const double *a, int32_t m, const double *b, int32_t n, double factor, double *out)
{
    for (int32_t i = 0; i <= m; i++)
        for (int32_t k = 0; k <= n; k++)
            out[i + k] += factor * a[i] * b[k];
}

/* det B, degree 10, along the last column. */
static void determinant(double b[3][3][5], double out[11])
{
    memset(out, 0, 11 * sizeof *out);
    for (int32_t r = 0; r < 3; r++) {
        const int32_t p = (r + 1) % 3, q = (r + 2) % 3;
        double minor[7] = {0};
        add_product(b[p][0], 3, b[q][1], 3, 1, minor);
        add_product(b[p][1], 3, b[q][0], 3, -1, minor);
        add_product(minor, 6, b[r][2], 4, 1, out);
    }
}

/* x and y for a root z: the longest of the cross products of two rows of B(z). */
static int32_t solve_xy(double b[3][3][5], double z, double xy[2])
{
    double at[3][3], best[3] = {0, 0, 0}, most = 0;
    for (int32_t r = 0; r < 3; r++)
        for (int32_t c = 0; c < 3; c++) {
            at[r][c] = b[r][c][4];
            for (int32_t k = 3; k >= 0; k--)
                at[r][c] = at[r][c] * z + b[r][c][k];
        }
    for (int32_t r = 0; r < 3; r++) {
        double v[3];
        asj_cross3(at[r], at[(r + 1) % 3], v);
        const double length2 = asj_dot3(v, v);
        if (length2 > most) {
            most = length2;
            memcpy(best, v, sizeof best);
        }
    }
    if (!(fabs(best[2]) > 1e-12 * sqrt(most)) || !isfinite(most))
        return 0;
    xy[0] = best[0] / best[2];
    xy[1] = best[1] / best[2];
    return 1;
}

/* Is E, of norm sqrt(2), essential to within rounding? Singular values 1, 1, 0: trace((E E')^2) = 2 and det E = 0. Where roots
 * nearly coincide, x and y are not. */
static int32_t is_essential(const double e[9])
{
    double square[9], sum = 0;
    asj_multiply3_transposed(e, e, square);
    for (int32_t k = 0; k < 9; k++)
        sum += square[k] * square[k];
    return fabs(sum - 2) < 1e-4 && fabs(asj_determinant3(e)) < 1e-4;
}

int32_t asj_five_point(const asj_ray_pair pairs[5], double essential[ASJ_FIVE_POINT_SOLUTIONS][9])
{
    double linear[5 * 9], basis[4 * 9], entry[9][4], rows[10][20], b[3][3][5], polynomial[11], roots[10];
    for (int32_t k = 0; k < 5; k++) {
        const asj_ray_pair *p = &pairs[k];
        const double row[9] = {p->x2 * p->x1, p->x2 * p->y1, p->x2, p->y2 * p->x1, p->y2 * p->y1, p->y2, p->x1, p->y1, 1};
        memcpy(linear + 9 * (ptrdiff_t)k, row, sizeof row);
    }
    if (!asj_null_space9(linear, 5, basis))
        return 0;
    for (int32_t n = 0; n < 9; n++)
        for (int32_t k = 0; k < 4; k++)
            entry[n][k] = basis[9 * k + n];
    equations(entry, rows);
    if (!eliminate(rows))
        return 0;
    for (int32_t r = 0; r < 3; r++)
        row_of_b(rows[4 + 2 * r], rows[5 + 2 * r], b[r]);
    determinant(b, polynomial);
    const int32_t count = asj_polynomial_roots(polynomial, 10, roots);
    int32_t found = 0;
    for (int32_t k = 0; k < count; k++) {
        double xy[2], size = 0, *e = essential[found];
        if (!solve_xy(b, roots[k], xy))
            continue;
        for (int32_t n = 0; n < 9; n++) {
            e[n] = xy[0] * entry[n][0] + xy[1] * entry[n][1] + roots[k] * entry[n][2] + entry[n][3];
            size += e[n] * e[n];
        }
        if (!(size > 0) || !isfinite(size))
            continue;
        for (int32_t n = 0; n < 9; n++)
            e[n] *= sqrt(2 / size);
        found += is_essential(e);
    }
    return found;
}
