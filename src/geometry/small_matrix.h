/* SPDX-License-Identifier: BSD-2-Clause */
/* Matrices of a few rows, row by row in arrays of double. */
#ifndef ASJ_SRC_SMALL_MATRIX_H
#define ASJ_SRC_SMALL_MATRIX_H

#include <stdint.h>

#define ASJ_SMALL 9 /* rows at most of what is decomposed */

static inline double asj_dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void asj_cross3(const double a[3], const double b[3], double c[3])
{
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    c[0] = x;
    c[1] = y;
    c[2] = z;
}

/* M v and M' v. */
static inline void asj_apply3(const double m[9], const double v[3], double out[3])
{
    const double x = asj_dot3(m, v), y = asj_dot3(m + 3, v), z = asj_dot3(m + 6, v);
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

static inline void asj_apply3_transposed(const double m[9], const double v[3], double out[3])
{
    const double x = m[0] * v[0] + m[3] * v[1] + m[6] * v[2], y = m[1] * v[0] + m[4] * v[1] + m[7] * v[2];
    const double z = m[2] * v[0] + m[5] * v[1] + m[8] * v[2];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

/* A B, A B' and A' B; the result may be one of them. */
void asj_multiply3(const double a[9], const double b[9], double out[9]);
void asj_multiply3_transposed(const double a[9], const double b[9], double out[9]);
void asj_transposed_multiply3(const double a[9], const double b[9], double out[9]);
double asj_determinant3(const double m[9]);
/* 0 when singular: a determinant of 0 or one that is not finite. */
int32_t asj_invert3(const double m[9], double inverse[9]);
void asj_skew3(const double t[3], double out[9]);
/* Length 1; 0 when its length is 0 or not finite, and then nothing changes. */
int32_t asj_normalise3(double v[3]);

/* exp([w]x): the rotation about w by |w| (Rodrigues). And the angle of a rotation matrix, in [0, pi]. */
void asj_rotation_of(const double w[3], double rotation[9]);
double asj_rotation_angle(const double rotation[9]);

/* Its axis times its angle, which is less than half a turn. */
void asj_vector_of_rotation(const double rotation[9], double vector[3]);

/* M = U diag(s) V', det U = det V = 1, s[0] >= s[1] >= |s[2]|: for det U = 1 the last one may be negative. */
void asj_svd3(const double m[9], double u[9], double s[3], double v[9]);

/* Eigenvalues, rising, and eigenvectors (columns) of a symmetric n x n matrix, by Jacobi's rotations; n <= ASJ_SMALL. */
void asj_symmetric_eigen(const double *matrix, int32_t n, double *values, double *vectors);

/* The unit vector v of a positive semidefinite 9 x 9 matrix that makes v' A v least; 0 when there is more than one: the second
 * smallest eigenvalue is as good as 0, too. Far quicker than all of them. Of the matrix, which is overwritten, what is on and below
 * the diagonal is read. Stands in least_vector.c. */
int32_t asj_least_vector9(double *a, double *vector);

/* Solves the symmetric positive definite system A x = b in place: Cholesky's factor goes into the lower triangle of A, x into b,
 * and the logarithm of A's determinant into *log_determinant (may be NULL). 0 when A is not positive definite. */
int32_t asj_cholesky_solve(double *a, int32_t n, double *b, double *log_determinant);
/* The inverse of such a matrix, n <= ASJ_MOST_INVERTED; otherwise the same. */
#define ASJ_MOST_INVERTED 17
int32_t asj_invert_positive(const double *a, int32_t n, double *inverse, double *log_determinant);

/* Solutions of A x = 0 for a rows x 9 matrix, rows <= 8: 9 - rows orthonormal vectors of 9, one after the other. A is overwritten.
 * 0 when the rows depend on each other. */
int32_t asj_null_space9(double *a, int32_t rows, double *basis);

#endif
