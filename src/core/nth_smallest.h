/* SPDX-License-Identifier: BSD-2-Clause */
/* The n-th smallest of many values. */
#ifndef ASJ_SRC_NTH_SMALLEST_H
#define ASJ_SRC_NTH_SMALLEST_H

#include <stddef.h>

/* 1 <= n <= count; none is NaN. Puts them into another order. */
float asj_nth_smallest(float *values, size_t count, size_t n);

#endif
