/* SPDX-License-Identifier: BSD-2-Clause */
/* A growing list of numbers and its order statistics. */
#ifndef ASJ_TESTS_ACCURACY_SAMPLE_H
#define ASJ_TESTS_ACCURACY_SAMPLE_H

#include <stddef.h>

typedef struct sample {
    double *values;
    size_t count, capacity;
    int failed; /* out of memory: the figures are then worth nothing */
} sample;

void sample_add(sample *s, double value);
void sample_free(sample *s);

/* Quantile 0 .. 1, linear between order statistics; NaN when empty. Sorts the list. */
double sample_quantile(sample *s, double fraction);

/* Median absolute deviation from the median; NaN when empty. */
double sample_mad(sample *s);

/* Share of the values with |value| <= limit; NaN when empty. */
double sample_share_within(const sample *s, double limit);

#endif
