/* SPDX-License-Identifier: BSD-2-Clause */
/* Products, inverses and decompositions of matrices of a few rows. See small_matrix.h. */
#include "small_matrix.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

void asj_multiply3(const double a[9], const double b[9], double out[9])
{
    double product[9];
    for (int32_t i = 0; i < 3; i++)
        for (int32_t k = 0; k < 3; k++)
            product[3 * i + k] = a[3 * i] * b[k] + a[3 * i + 1] * b[3 + k] + a[3 * i + 2] * b[6 + k];
    memcpy(out, product, sizeof product);
}

void asj_multiply3_transposed(const double a[9], const double b[9], double out[9])
{
    double product[9];
    for (int32_t i = 0; i < 3; i++)
        for (int32_t k = 0; k < 3; k++)
            product[3 * i + k] = asj_dot3(a + 3 * (ptrdiff_t)i, b + 3 * (ptrdiff_t)k);
    memcpy(out, product, sizeof product);
}

void asj_transposed_multiply3(const double a[9], const double b[9], double out[9])
{
    double product[9];
    for (int32_t i = 0; i < 3; i++)
        for (int32_t k = 0; k < 3; k++)
            product[3 * i + k] = a[i] * b[k] + a[3 + i] * b[3 + k] + a[6 + i] * b[6 + k];
    memcpy(out, product, sizeof product);
}

double asj_determinant3(const double m[9])
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

int32_t asj_invert3(const double m[9], double inverse[9])
{
    const double d = asj_determinant3(m);
    if (!(fabs(d) > 0) || !isfinite(d))
        return 0;
    const double adjoint[9] = {m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                               m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                               m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
    for (int32_t k = 0; k < 9; k++)
        inverse[k] = adjoint[k] / d;
    return 1;
}

void asj_skew3(const double t[3], double out[9])
{
    const double skew[9] = {0, -t[2], t[1], t[2], 0, -t[0], -t[1], t[0], 0};
    memcpy(out, skew, sizeof skew);
}

int32_t asj_normalise3(double v[3])
{
    const double length = sqrt(asj_dot3(v, v));
    if (!(length > 0) || !isfinite(length))
        return 0;
    for (int32_t k = 0; k < 3; k++)
        v[k] /= length;
    return 1;
}

void asj_rotation_of(const double w[3], double rotation[9])
{
    const double angle2 = asj_dot3(w, w), angle = sqrt(angle2);
    /* sin(a) / a and (1 - cos(a)) / a^2, near 0 by their series */
    const double s = angle > 1e-4 ? sin(angle) / angle : 1 - angle2 / 6;
    const double c = angle > 1e-4 ? (1 - cos(angle)) / angle2 : 0.5 - angle2 / 24;
    double k[9], k2[9];
    asj_skew3(w, k);
    asj_multiply3(k, k, k2);
    for (int32_t i = 0; i < 9; i++)
        rotation[i] = (i % 4 == 0) + s * k[i] + c * k2[i];
}

double asj_rotation_angle(const double r[9])
{
    const double axis[3] = {r[7] - r[5], r[2] - r[6], r[3] - r[1]};
    return atan2(sqrt(asj_dot3(axis, axis)), r[0] + r[4] + r[8] - 1);
}

void asj_vector_of_rotation(const double r[9], double vector[3])
{
    const double angle = asj_rotation_angle(r), factor = angle > 1e-6 ? angle / (2 * sin(angle)) : 0.5;
    vector[0] = factor * (r[7] - r[5]); /* what is antisymmetric is the axis times twice the sine of the angle */
    vector[1] = factor * (r[2] - r[6]);
    vector[2] = factor * (r[3] - r[1]);
}

/* --- decompositions ---------------------------------------------------------------------------------------------------------- */

/* One rotation of Jacobi's method in the plane of rows p and q (Golub and Van Loan, "Matrix Computations", 8.5). */
static void jacobi_rotate(double *a, int32_t n, double *vectors, int32_t p, int32_t q)
{
    const double apq = a[p * n + q];
    if (apq == 0)
        return;
    const double theta = (a[q * n + q] - a[p * n + p]) / (2 * apq);
    const double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1), s = t * c;
    for (int32_t k = 0; k < n; k++) {
        const double x = a[k * n + p], y = a[k * n + q];
        a[k * n + p] = c * x - s * y;
        a[k * n + q] = s * x + c * y;
    }
    for (int32_t k = 0; k < n; k++) {
        const double x = a[p * n + k], y = a[q * n + k];
        a[p * n + k] = c * x - s * y;
        a[q * n + k] = s * x + c * y;
    }
    for (int32_t k = 0; k < n; k++) {
        const double x = vectors[k * n + p], y = vectors[k * n + q];
        vectors[k * n + p] = c * x - s * y;
        vectors[k * n + q] = s * x + c * y;
    }
}

static void sort_eigen(const double *a, int32_t n, const double *turned, double *values, double *vectors)
{
    int32_t order[ASJ_SMALL];
    for (int32_t i = 0; i < n; i++) {
        int32_t k = i;
        for (; k > 0 && a[order[k - 1] * (n + 1)] > a[i * (n + 1)]; k--)
            order[k] = order[k - 1];
        order[k] = i;
    }
    for (int32_t k = 0; k < n; k++) {
        values[k] = a[order[k] * (n + 1)];
        for (int32_t i = 0; i < n; i++)
            vectors[i * n + k] = turned[i * n + order[k]];
    }
}

void asj_symmetric_eigen(const double *matrix, int32_t n, double *values, double *vectors)
{
    double a[ASJ_SMALL * ASJ_SMALL], turned[ASJ_SMALL * ASJ_SMALL];
    double size = 0;
    memcpy(a, matrix, (size_t)(n * n) * sizeof *a);
    for (int32_t k = 0; k < n * n; k++) {
        turned[k] = k % (n + 1) == 0;
        size += a[k] * a[k];
    }
    for (int32_t sweep = 0; sweep < 30; sweep++) { /* six to ten suffice */
        double off = 0;
        for (int32_t p = 0; p < n; p++)
            for (int32_t q = p + 1; q < n; q++)
                off += a[p * n + q] * a[p * n + q];
        if (!(off > 1e-30 * size))
            break;
        for (int32_t p = 0; p < n; p++)
            for (int32_t q = p + 1; q < n; q++)
                jacobi_rotate(a, n, turned, p, q);
    }
    sort_eigen(a, n, turned, values, vectors);
}

/* Any unit vector at right angles to v. */
static void beside(const double v[3], double out[3])
{
    const double axis[3] = {fabs(v[0]) < 0.6, fabs(v[0]) >= 0.6, 0};
    asj_cross3(v, axis, out);
    asj_normalise3(out);
}

void asj_svd3(const double m[9], double u[9], double s[3], double v[9])
{
    double square[9], values[3], vectors[9], columns[3][3], left[3][3];
    asj_transposed_multiply3(m, m, square);
    asj_symmetric_eigen(square, 3, values, vectors);
    for (int32_t k = 0; k < 2; k++)
        for (int32_t i = 0; i < 3; i++)
            columns[k][i] = vectors[3 * i + 2 - k];
    asj_cross3(columns[0], columns[1], columns[2]);
    for (int32_t k = 0; k < 3; k++) {
        asj_apply3(m, columns[k], left[k]);
        s[k] = sqrt(asj_dot3(left[k], left[k]));
    }
    if (!asj_normalise3(left[0])) {
        left[0][0] = 1;
        left[0][1] = left[0][2] = 0;
    }
    /* What is left of the second after the first: all of it but rounding. */
    const double along = asj_dot3(left[0], left[1]);
    for (int32_t i = 0; i < 3; i++)
        left[1][i] -= along * left[0][i];
    if (!(s[1] > 1e-14 * s[0]) || !asj_normalise3(left[1]))
        beside(left[0], left[1]);
    double third[3];
    asj_cross3(left[0], left[1], third);
    s[2] = asj_dot3(third, left[2]);
    for (int32_t k = 0; k < 3; k++)
        for (int32_t i = 0; i < 3; i++) {
            u[3 * i + k] = k < 2 ? left[k][i] : third[i];
            v[3 * i + k] = columns[k][i];
        }
}

int32_t asj_cholesky_solve(double *a, int32_t n, double *b, double *log_determinant)
{
    double sum = 0;
    for (int32_t i = 0; i < n; i++)
        for (int32_t k = 0; k <= i; k++) {
            double value = a[i * n + k];
            for (int32_t j = 0; j < k; j++)
                value -= a[i * n + j] * a[k * n + j];
            if (i == k) {
                if (!(value > 0) || !isfinite(value))
                    return 0;
                a[i * n + i] = sqrt(value);
                sum += log(value);
            } else {
                a[i * n + k] = value / a[k * n + k];
            }
        }
    for (int32_t i = 0; i < n; i++) {
        for (int32_t k = 0; k < i; k++)
            b[i] -= a[i * n + k] * b[k];
        b[i] /= a[i * n + i];
    }
    for (int32_t i = n - 1; i >= 0; i--) {
        for (int32_t k = i + 1; k < n; k++)
            b[i] -= a[k * n + i] * b[k];
        b[i] /= a[i * n + i];
    }
    if (log_determinant)
        *log_determinant = sum;
    return 1;
}

int32_t asj_invert_positive(const double *a, int32_t n, double *inverse, double *log_determinant)
{
    for (int32_t p = 0; p < n; p++) {
        double copy[ASJ_MOST_INVERTED * ASJ_MOST_INVERTED], column[ASJ_MOST_INVERTED] = {0};
        memcpy(copy, a, (size_t)(n * n) * sizeof *copy);
        column[p] = 1;
        if (!asj_cholesky_solve(copy, n, column, log_determinant))
            return 0;
        for (int32_t k = 0; k < n; k++)
            inverse[k * n + p] = column[k];
    }
    return 1;
}

/* Brings the largest of what is left to row and column `at`; 0 when all of it is nothing. */
static int32_t pivot9(double *a, int32_t rows, int32_t at, int32_t *column)
{
    int32_t row = at, best = at;
    double largest = 0;
    for (int32_t i = at; i < rows; i++)
        for (int32_t k = at; k < 9; k++)
            if (fabs(a[9 * i + column[k]]) > largest) {
                largest = fabs(a[9 * i + column[k]]);
                row = i;
                best = k;
            }
    if (!(largest > 1e-12) || !isfinite(largest))
        return 0;
    const int32_t swap = column[at];
    column[at] = column[best];
    column[best] = swap;
    for (int32_t k = 0; k < 9; k++) {
        const double keep = a[9 * at + k];
        a[9 * at + k] = a[9 * row + k];
        a[9 * row + k] = keep;
    }
    return 1;
}

int32_t asj_null_space9(double *a, int32_t rows, double *basis)
{
    int32_t column[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    for (int32_t at = 0; at < rows; at++) {
        if (!pivot9(a, rows, at, column))
            return 0;
        for (int32_t i = 0; i < rows; i++) {
            const double factor = i == at ? 0 : a[9 * i + column[at]] / a[9 * at + column[at]];
            for (int32_t k = 0; k < 9 && factor != 0; k++)
                a[9 * i + k] -= factor * a[9 * at + k];
        }
    }
    for (int32_t f = 0; f < 9 - rows; f++) {
        double *v = basis + 9 * (ptrdiff_t)f;
        memset(v, 0, 9 * sizeof *v);
        v[column[rows + f]] = 1;
        for (int32_t i = 0; i < rows; i++)
            v[column[i]] = -a[9 * i + column[rows + f]] / a[9 * i + column[i]];
        for (int32_t g = 0; g <= f; g++) { /* Gram-Schmidt; then its length */
            const double *w = basis + 9 * (ptrdiff_t)g;
            double along = 0;
            for (int32_t k = 0; k < 9; k++)
                along += v[k] * w[k];
            for (int32_t k = 0; k < 9; k++)
                v[k] = g < f ? v[k] - along * w[k] : v[k] / sqrt(along);
        }
    }
    return 1;
}
