/* SPDX-License-Identifier: BSD-2-Clause */
/* Lists of candidates in order: by L-junction of image 1, then of image 2. */
#include "candidate.h"
#include "core/sort.h"

#include <string.h>

static int by_pair(const void *left, const void *right)
{
    const asj_candidate *p = left, *q = right;
    if (p->i != q->i)
        return p->i < q->i ? -1 : 1;
    return p->j < q->j ? -1 : p->j > q->j;
}

void asj_candidates_sort(asj_candidates *candidates)
{
    if (candidates->count > 1)
        asj_sort(candidates->list, candidates->count, sizeof *candidates->list, by_pair);
    size_t kept = 0;
    for (size_t k = 0; k < candidates->count; k++)
        if (kept == 0 || by_pair(&candidates->list[k], &candidates->list[kept - 1]) != 0)
            candidates->list[kept++] = candidates->list[k];
    candidates->count = kept;
}

const asj_candidate *asj_candidates_find(const asj_candidates *candidates, uint32_t i, uint32_t j)
{
    const asj_candidate *list = candidates->list;
    size_t low = 0, high = candidates->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (list[middle].i < i || (list[middle].i == i && list[middle].j < j))
            low = middle + 1;
        else
            high = middle;
    }
    return low < candidates->count && list[low].i == i && list[low].j == j ? &list[low] : NULL;
}

asj_status asj_candidates_append(asj_context *context, asj_candidates *candidates, const asj_candidates *fresh)
{
    void *list = candidates->list;
    const size_t count = candidates->count + fresh->count, size = sizeof *candidates->list;
    const asj_status status = asj_grow(&context->memory, &list, &candidates->capacity, count, size, candidates->count);
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for %zu candidates", count);
    candidates->list = list;
    if (fresh->count)
        memcpy(candidates->list + candidates->count, fresh->list, fresh->count * size);
    candidates->count = count;
    return ASJ_OK;
}
