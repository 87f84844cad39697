/* SPDX-License-Identifier: BSD-2-Clause */
#include "nth_smallest.h"
#include "sort.h"

static int rising(const void *left, const void *right)
{
    const float p = *(const float *)left, q = *(const float *)right;
    return p < q ? -1 : p > q;
}

float asj_nth_smallest(float *values, size_t count, size_t n)
{
    asj_sort(values, count, sizeof *values, rising);
    return values[n - 1];
}
