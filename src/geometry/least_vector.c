/* SPDX-License-Identifier: BSD-2-Clause */
/* The vector of the smallest eigenvalue of a symmetric 9 x 9 matrix, by inverse iteration: A = P L D L' P' with the largest pivot
 * first (Golub and Van Loan, "Matrix Computations", 4.2.8), on and below the diagonal. D falls, so its last entry tells of the
 * smallest eigenvalue and the one before it of the second. Equations are solved column by column, so that no sum waits for another
 * one. */
#include "small_matrix.h"

#include <math.h>

#define ROUNDS 4
#define NOTHING 1e-12 /* of the first pivot */
#define LEAST 1e-15

static void swap(double *a, double *b)
{
    const double keep = *a;
    *a = *b;
    *b = keep;
}

/* Rows and columns k and m > k of the matrix change places, and rows k and m of the columns of L that are known. */
static void exchange(double *a, double column[9][9], int32_t k, int32_t m)
{
    for (int32_t j = 0; j < k; j++) {
        swap(&a[9 * k + j], &a[9 * m + j]);
        swap(&column[j][k], &column[j][m]);
    }
    swap(&a[10 * k], &a[10 * m]);
    for (int32_t j = k + 1; j < m; j++)
        swap(&a[9 * j + k], &a[9 * m + j]);
    for (int32_t j = m + 1; j < 9; j++)
        swap(&a[9 * j + k], &a[9 * j + m]);
}

/* column[k]: what L has below its ones. 0 when the last pivot but one is as good as 0. */
static int32_t factor(double *a, int32_t order[9], double d[9], double column[9][9])
{
    for (int32_t k = 0; k < 9; k++)
        order[k] = k;
    for (int32_t k = 0; k < 9; k++) {
        int32_t best = k;
        for (int32_t i = k + 1; i < 9; i++)
            best = a[10 * i] > a[10 * best] ? i : best;
        if (best != k) {
            const int32_t keep = order[k];
            order[k] = order[best];
            order[best] = keep;
            exchange(a, column, k, best);
        }
        d[k] = a[10 * k];
        if (k < 8 && (!(d[k] > NOTHING * d[0]) || !isfinite(d[k])))
            return 0;
        for (int32_t i = 0; i < 9; i++)
            column[k][i] = i > k ? a[9 * i + k] : 0;
        for (int32_t i = k + 1; i < 9; i++) {
            const double times = column[k][i] / d[k];
            for (int32_t j = 0; j < 9; j++) /* of which those up to i count */
                a[9 * i + j] -= times * column[k][j];
        }
        for (int32_t i = 0; i < 9 && k < 8; i++)
            column[k][i] /= d[k];
    }
    return 1;
}

int32_t asj_least_vector9(double *a, double *vector)
{
    int32_t order[9];
    double d[9], column[9][9], row[9][9], x[9] = {0, 0, 0, 0, 0, 0, 0, 0, 1}, size = 0;
    if (!factor(a, order, d, column))
        return 0;
    d[8] = fmax(d[8], LEAST * d[0]);
    for (int32_t i = 0; i < 9; i++)
        for (int32_t k = 0; k < 9; k++)
            row[i][k] = column[k][i];
    /* From L'^-1 e9, which is the solution where there is an exact one. */
    for (int32_t round = 0; round < ROUNDS; round++) {
        for (int32_t k = 0; k < 8 && round > 0; k++) {
            const double known = x[k];
            for (int32_t i = 0; i < 9; i++)
                x[i] -= column[k][i] * known;
        }
        for (int32_t i = 0; i < 9 && round > 0; i++)
            x[i] /= d[i];
        for (int32_t k = 8; k > 0; k--) {
            const double known = x[k];
            for (int32_t i = 0; i < 9; i++)
                x[i] -= row[k][i] * known;
        }
    }
    for (int32_t i = 0; i < 9; i++)
        size += x[i] * x[i];
    for (int32_t i = 0; i < 9; i++)
        vector[order[i]] = x[i] / sqrt(size);
    return isfinite(size) != 0;
}
