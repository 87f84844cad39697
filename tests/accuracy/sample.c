/* SPDX-License-Identifier: BSD-2-Clause */
#include "sample.h"

#include <math.h>
#include <stdlib.h>

void sample_add(sample *s, double value)
{
    if (s->count == s->capacity) {
        const size_t capacity = s->capacity ? 2 * s->capacity : 256;
        double *grown = realloc(s->values, capacity * sizeof *grown);
        if (!grown) {
            s->failed = 1;
            return;
        }
        s->values = grown;
        s->capacity = capacity;
    }
    s->values[s->count++] = value;
}

void sample_free(sample *s)
{
    free(s->values);
    s->values = NULL;
    s->count = s->capacity = 0;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double sample_quantile(sample *s, double fraction)
{
    if (s->count == 0)
        return NAN;
    qsort(s->values, s->count, sizeof *s->values, compare);
    const double position = fraction * (double)(s->count - 1);
    const size_t below = (size_t)position;
    const size_t above = below + 1 < s->count ? below + 1 : below;
    return s->values[below] + (position - (double)below) * (s->values[above] - s->values[below]);
}

double sample_mad(sample *s)
{
    const double median = sample_quantile(s, 0.5);
    sample deviations = {NULL, 0, 0, 0};
    for (size_t i = 0; i < s->count; i++)
        sample_add(&deviations, fabs(s->values[i] - median));
    const double result = deviations.failed ? NAN : sample_quantile(&deviations, 0.5);
    sample_free(&deviations);
    return result;
}

double sample_share_within(const sample *s, double limit)
{
    size_t within = 0;
    for (size_t i = 0; i < s->count; i++)
        within += fabs(s->values[i]) <= limit;
    return s->count ? (double)within / (double)s->count : NAN;
}
