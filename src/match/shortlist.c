/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, short lists: the candidates are the union of the best partners of every L-junction of either image (rank.c), guests left
 * out (guests.c), and for a geometry the less meaningful ones where there are very many (two_view.c). Ties go to the smaller index,
 * so the list depends on nothing but the input. */
#include "shortlist.h"
#include "pair_list.h"
#include "subset.h"

#include <string.h>

static void clear(asj_partner *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        list[i] = (asj_partner){ASJ_NO_PARTNER, 0};
}

static size_t count_partners(const asj_partner *list, size_t count)
{
    size_t partners = 0;
    for (size_t i = 0; i < count; i++)
        partners += list[i].score > ASJ_NO_PARTNER;
    return partners;
}

/* The union of both lists as candidates. */
static asj_status collect(asj_match_run *run, const asj_partner *rows, const asj_partner *columns)
{
    const uint32_t count1 = run->image[0]->l_junctions.count, count2 = run->image[1]->l_junctions.count;
    const size_t limit = (size_t)run->options->shortlist, most = count_partners(rows, count1 * limit) +
                                                                 count_partners(columns, count2 * limit);
    asj_pair_list list = {asj_allocate(&run->context->memory, most, sizeof *list.pairs), 0, most};
    if (!list.pairs)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", most);
    for (uint32_t n = 0; n < count1 + count2; n++) {
        const asj_partner *partners = n < count1 ? rows + n * limit : columns + (n - count1) * limit;
        for (size_t k = 0; k < limit && partners[k].score > ASJ_NO_PARTNER; k++, list.count++) {
            list.pairs[list.count][0] = n < count1 ? n : partners[k].index;
            list.pairs[list.count][1] = n < count1 ? partners[k].index : n - count1;
        }
    }
    const asj_status status = asj_pair_list_candidates(run->context, &list, count1, 0, ASJ_STAGE_DISTANCES, &run->candidates);
    asj_release_much(&run->context->memory, list.pairs);
    return status;
}

/* Are there L-junctions that are not listed? With induced patches all are. */
static int leaves_some_out(const asj_match_run *run)
{
    for (int32_t side = 0; side < 2 && run->options->patches == ASJ_PATCHES_CANONICAL; side++) {
        const asj_l_junctions *all = &run->image[side]->l_junctions;
        if (run->most_listed > 0 && all->count > run->most_listed)
            return 1;
        for (uint32_t i = 0; i < all->count; i++)
            if (asj_is_guest(all, i) && all->first_frame[i] < all->first_frame[i + 1])
                return 1;
    }
    return 0;
}

/* The best partners of those that are listed. */
static asj_status find_partners(const asj_match_run *run, asj_partner *rows, asj_partner *columns)
{
    asj_subset hosts[2];
    if (!leaves_some_out(run))
        return run->context->ops->rank->partners(run, rows, columns);
    memset(hosts, 0, sizeof hosts);
    asj_match_run among = *run;
    asj_status status = ASJ_OK;
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++) {
        status = asj_subset_create(run, side, 0, run->most_listed, &hosts[side]);
        among.image[side] = &hosts[side].features;
    }
    if (status == ASJ_OK)
        status = run->context->ops->rank->partners(&among, rows, columns);
    for (int32_t side = 0; side < 2; side++)
        asj_subset_free(&run->context->memory, &hosts[side]);
    return status;
}

asj_status asj_shortlist(asj_match_run *run)
{
    asj_memory *memory = &run->context->memory;
    const uint32_t count1 = run->image[0]->l_junctions.count, count2 = run->image[1]->l_junctions.count;
    const size_t limit = (size_t)run->options->shortlist;
    asj_partner *rows = asj_allocate(memory, count1, limit * sizeof *rows);
    asj_partner *columns = asj_allocate(memory, count2, limit * sizeof *columns);
    asj_status status;
    if (!rows || !columns) {
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the partners of %u and %u L-junctions",
                          (unsigned)count1, (unsigned)count2);
    } else {
        clear(rows, count1 * limit);
        clear(columns, count2 * limit);
        status = find_partners(run, rows, columns);
        if (status == ASJ_OK)
            status = collect(run, rows, columns);
        if (status == ASJ_OK)
            status = asj_compare_and_drop(run, &run->candidates);
    }
    asj_release(memory, rows);
    asj_release(memory, columns);
    return status;
}
