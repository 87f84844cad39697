/* SPDX-License-Identifier: BSD-2-Clause */
/* Pairs are counted and put together by their first number; what is then sorted by the second is short. */
#include "pair_list.h"
#include "core/sort.h"
#include "core/watch.h"

#include <string.h>

asj_status asj_pair_list_add(asj_context *context, asj_pair_list *list, uint32_t i, uint32_t j)
{
    const size_t count = list->count + 1;
    void *pairs = list->pairs;
    const asj_status status = asj_grow(&context->memory, &pairs, &list->capacity, count, sizeof *list->pairs, list->count);
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for %zu pairs", count);
    list->pairs = pairs;
    list->pairs[list->count][0] = i;
    list->pairs[list->count][1] = j;
    list->count = count;
    return ASJ_OK;
}

static int rising(const void *a, const void *b)
{
    const uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return (p > q) - (p < q);
}

/* The second numbers, those of one first number together: of i from first[i] to first[i + 1] - 1. */
static void put_together(const asj_pair_list *list, uint32_t count, size_t *first, uint32_t *second)
{
    for (size_t n = 0; n < list->count; n++)
        first[list->pairs[n][0] + 2]++;
    for (size_t i = 0; i < count; i++)
        first[i + 2] += first[i + 1];
    for (size_t n = 0; n < list->count; n++)
        second[first[list->pairs[n][0] + 1]++] = list->pairs[n][1];
}

/* Sorts those of one first number; returns how many different ones are left, in front. */
static size_t sort_one(uint32_t *second, size_t count)
{
    size_t kept = 0;
    asj_sort(second, count, sizeof *second, rising);
    for (size_t n = 0; n < count; n++)
        if (n == 0 || second[n] != second[kept - 1])
            second[kept++] = second[n];
    return kept;
}

/* Each pair once: those of i are from first[i] to first[i + 1] - 1 then, too. */
static asj_status sort_all(asj_context *context, uint32_t count, size_t *first, uint32_t *second, int32_t stage)
{
    asj_watch watch;
    size_t kept = 0, begin = 0;
    asj_watch_start(&watch, context, stage);
    for (uint32_t i = 0; i < count && !asj_watch_stops(&watch, NULL); i++) {
        const size_t end = first[i + 1], of_one = sort_one(second + begin, end - begin);
        memmove(second + kept, second + begin, of_one * sizeof *second);
        begin = end;
        first[i + 1] = kept += of_one;
    }
    return asj_watch_end(&watch);
}

static asj_status fill(asj_context *context, uint32_t count, const size_t *first, const uint32_t *second, int32_t stage,
                       asj_candidates *candidates)
{
    asj_watch watch;
    asj_watch_start(&watch, context, stage);
    for (uint32_t i = 0; i < count && !asj_watch_stops(&watch, NULL); i++)
        for (size_t n = first[i]; n < first[i + 1]; n++) {
            asj_candidate *c = &candidates->list[candidates->count++];
            memset(c, 0, sizeof *c);
            c->i = i;
            c->j = second[n];
        }
    return asj_watch_end(&watch);
}

/* Room for each pair and as many more, and the pairs in it. */
static asj_status make(asj_context *context, uint32_t count, const size_t *first, const uint32_t *second, size_t more,
                       int32_t stage, asj_candidates *candidates)
{
    const size_t most = first[count] + more;
    *candidates = (asj_candidates){asj_allocate(&context->memory, most, sizeof *candidates->list), 0, most};
    return candidates->list ? fill(context, count, first, second, stage, candidates)
                            : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", most);
}

asj_status asj_pair_list_candidates(asj_context *context, const asj_pair_list *list, uint32_t count, size_t more, int32_t stage,
                                    asj_candidates *candidates)
{
    asj_memory *memory = &context->memory;
    size_t *first = asj_allocate_zero(memory, (size_t)count + 2, sizeof *first);
    uint32_t *second = asj_allocate(memory, list->count, sizeof *second);
    asj_status status = ASJ_OK;
    *candidates = (asj_candidates){NULL, 0, 0};
    if (!first || !second)
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu pairs", list->count);
    if (status == ASJ_OK) {
        put_together(list, count, first, second);
        status = sort_all(context, count, first, second, stage);
    }
    if (status == ASJ_OK)
        status = make(context, count, first, second, more, stage, candidates);
    asj_release(memory, first);
    asj_release(memory, second);
    if (status != ASJ_OK) {
        asj_release(memory, candidates->list);
        *candidates = (asj_candidates){NULL, 0, 0};
    }
    return status;
}
