/* SPDX-License-Identifier: BSD-2-Clause */
/* The k nearest of many points, by insertion: k is small, and most points are farther than the last of the list. */
#include "nearest.h"

void asj_nearest_insert(asj_nearest *list, uint32_t index, double square)
{
    uint32_t k = list->count;
    while (k > 0 && (list->square[k - 1] > square || (list->square[k - 1] == square && list->index[k - 1] > index)))
        k--;
    if (k == list->limit)
        return;
    list->count += list->count < list->limit;
    for (uint32_t m = list->count - 1; m > k; m--) {
        list->square[m] = list->square[m - 1];
        list->index[m] = list->index[m - 1];
    }
    list->square[k] = square;
    list->index[k] = index;
}
