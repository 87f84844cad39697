/* SPDX-License-Identifier: BSD-2-Clause */
/* Lists of candidates in order: by L-junction of image 1, then of image 2. */
#include "candidate.h"
#include "core/sort.h"
#include "core/watch.h"

#include <string.h>

#define ROWS 4096 /* that are merged before the caller is asked again */

/* Below 0: p comes before q. */
static int compare(const asj_candidate *p, const asj_candidate *q)
{
    if (p->i != q->i)
        return p->i < q->i ? -1 : 1;
    return p->j < q->j ? -1 : p->j > q->j;
}

static int by_pair(const void *left, const void *right)
{
    return compare(left, right);
}

void asj_candidates_sort(asj_candidates *candidates)
{
    asj_sort(candidates->list, candidates->count, sizeof *candidates->list, by_pair);
}

asj_status asj_candidates_merge(asj_context *context, asj_candidates *candidates, asj_candidates *others, int32_t stage)
{
    const size_t most = candidates->count + others->count, count = others->count;
    const int32_t in_place = others->capacity >= most && most > 0;
    asj_candidates all = {in_place ? others->list : asj_allocate(&context->memory, most, sizeof *all.list), 0, most};
    if (!all.list)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", most);
    /* behind the room for the others: what is written never overtakes what is read */
    asj_candidate *added = others->list;
    if (in_place)
        added = memmove(all.list + candidates->count, all.list, count * sizeof *all.list);
    asj_watch watch;
    asj_watch_start(&watch, context, stage);
    size_t k = 0, n = 0;
    while ((k < candidates->count || n < count) && (all.count % ROWS != 0 || !asj_watch_stops(&watch, NULL))) {
        const int order = k == candidates->count ? 1 : n == count ? -1 : compare(&candidates->list[k], &added[n]);
        all.list[all.count++] = order <= 0 ? candidates->list[k] : added[n];
        k += order <= 0;
        n += order >= 0;
    }
    const asj_status status = asj_watch_end(&watch);
    if (in_place)
        *others = (asj_candidates){NULL, 0, 0};
    asj_release_much(&context->memory, status == ASJ_OK ? candidates->list : all.list);
    if (status == ASJ_OK)
        *candidates = all;
    return status;
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
    const asj_status status = asj_grow_within(&context->memory, &list, &candidates->capacity, count, count + count / 8, size,
                                              candidates->count);
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for %zu candidates", count);
    candidates->list = list;
    if (fresh->count)
        memcpy(candidates->list + candidates->count, fresh->list, fresh->count * size);
    candidates->count = count;
    return ASJ_OK;
}
