/* SPDX-License-Identifier: BSD-2-Clause */
/* Quickselect (Hoare 1961, "Algorithm 65: Find") about the median of three; what is left after so many divisions is sorted, so that
 * no order takes long. */
#include "nth_smallest.h"
#include "sort.h"

#define FEW 16       /* values that are sorted at once */
#define DIVISIONS 64 /* each leaves half, as a rule */

static int rising(const void *left, const void *right)
{
    const float p = *(const float *)left, q = *(const float *)right;
    return p < q ? -1 : p > q;
}

static float middle_of(float a, float b, float c)
{
    const float low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

float asj_nth_smallest(float *values, size_t count, size_t n)
{
    float *first = values, *last = values + count; /* the n-th is one of these */
    for (int left = DIVISIONS; last - first > FEW && left > 0; left--) {
        const float pivot = middle_of(first[0], first[(last - first) / 2], last[-1]);
        float *low = first, *high = last;
        while (low < high) {
            while (*low < pivot)
                low++;
            do
                high--;
            while (*high > pivot);
            if (low >= high)
                break;
            const float swap = *low;
            *low++ = *high;
            *high = swap;
        }
        /* none before `low` is above the pivot, none from it on is below */
        if ((size_t)(low - values) >= n)
            last = low;
        else
            first = low;
    }
    asj_sort(first, (size_t)(last - first), sizeof *first, rising);
    return values[n - 1];
}
