/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_POLYNOMIAL_H
#define ASJ_SRC_POLYNOMIAL_H

#include <stdint.h>

#define ASJ_POLYNOMIAL_DEGREE 10

/* Real roots of c[0] + c[1] x + ... + c[degree] x^degree, each once, in no order; degree <= ASJ_POLYNOMIAL_DEGREE. Returns how
 * many; a root that the curve only touches may be missed. 0 for numbers that are not finite. */
int32_t asj_polynomial_roots(const double *c, int32_t degree, double *roots);

#endif
