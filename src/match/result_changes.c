/* SPDX-License-Identifier: BSD-2-Clause */
/* A result that another one of the same images changes, or another view of what it is in. */
#include "result_changes.h"

#include <string.h>

void asj_match_result_unstretch(asj_match_result *shown, const asj_stretch by[2])
{
    asj_own_result *r = (asj_own_result *)shown;
    r->is_known = 0; /* the judge sees stretched images */
    asj_unstretch_matches(r->matches, shown->match_count, by);
    asj_unstretch_matches(r->rejected, (size_t)shown->rejected_count, by);
    asj_unstretch_l_junctions(r->l1, shown->l_junction_count1, &by[0]);
    asj_unstretch_l_junctions(r->l2, shown->l_junction_count2, &by[1]);
    asj_unstretch_geometry(&shown->geometry, by);
    asj_match_result_sort(r);
}

static void renumber(asj_junction_match *list, size_t count, int32_t side, const uint32_t *number)
{
    for (size_t k = 0; k < count; k++) {
        uint32_t *l = side ? &list[k].l2 : &list[k].l1;
        *l = number[*l];
    }
}

asj_status asj_match_result_number(asj_context *context, asj_match_result *shown, int32_t side, double minimum_opening,
                                   const asj_junction *junctions, size_t count)
{
    asj_own_result *r = (asj_own_result *)shown;
    const size_t total = asj_decompose(junctions, count, minimum_opening, NULL, 0);
    if (total == (side ? shown->l_junction_count2 : shown->l_junction_count1))
        return ASJ_OK;
    asj_l_junction *all = asj_allocate(&r->memory, total, sizeof *all);
    uint32_t *number = asj_allocate(&context->memory, total, sizeof *number), known = 0;
    if (!all || !number) {
        asj_release(&r->memory, all);
        asj_release(&context->memory, number);
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu L-junctions", total);
    }
    asj_decompose(junctions, count, minimum_opening, all, total);
    for (uint32_t l = 0; l < total; l++)
        if (junctions[all[l].junction].octave >= 0)
            number[known++] = l;
    renumber(r->matches, shown->match_count, side, number);
    renumber(r->rejected, (size_t)shown->rejected_count, side, number);
    asj_release(&context->memory, number);
    asj_release(&r->memory, side ? r->l2 : r->l1);
    if (side) {
        shown->l_junctions2 = r->l2 = all;
        shown->l_junction_count2 = (uint32_t)total;
    } else {
        shown->l_junctions1 = r->l1 = all;
        shown->l_junction_count1 = (uint32_t)total;
    }
    return ASJ_OK;
}

asj_status asj_match_result_judge(asj_context *context, asj_match_result *shown, const float *probability)
{
    asj_own_result *r = (asj_own_result *)shown;
    uint32_t kept = 0, gone = 0;
    asj_junction_match *rejected = asj_allocate(&r->memory, shown->match_count, sizeof *rejected);
    if (!rejected)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %lu matches", (unsigned long)shown->match_count);
    for (uint32_t k = 0; k < shown->match_count; k++)
        if (probability[k] < 0) {
            rejected[gone++] = r->matches[k];
        } else {
            r->matches[kept] = r->matches[k];
            r->matches[kept++].probability = probability[k];
        }
    asj_release(&r->memory, r->rejected);
    r->rejected = rejected;
    shown->rejected = gone ? rejected : NULL;
    shown->rejected_count = gone;
    shown->matches = kept ? r->matches : NULL;
    shown->match_count = r->count = kept;
    asj_match_result_sort(r);
    return ASJ_OK;
}

/* --- matches of two results -------------------------------------------------------------------------------------------------- */

/* What becomes of both; what was there before, once it is shown. */
typedef struct joined {
    asj_junction_match *matches;
    asj_l_junction *l[2];
    asj_place *places[2];
    uint32_t count, l_count[2];
} joined;

/* `other` NULL: nothing of it. */
static void join_l_junctions(joined *j, const asj_match_result *shown, const asj_match_result *other, int32_t side)
{
    const asj_match_result *const from[2] = {shown, other};
    uint32_t first_junction = 0;
    for (int32_t n = 0; n < 2 && from[n]; n++) {
        const asj_l_junction *l = side ? from[n]->l_junctions2 : from[n]->l_junctions1;
        const uint32_t count = side ? from[n]->l_junction_count2 : from[n]->l_junction_count1;
        uint32_t next = first_junction;
        for (uint32_t k = 0; k < count; k++) {
            asj_l_junction *made = &j->l[side][j->l_count[side]++];
            *made = l[k];
            made->junction += first_junction;
            next = made->junction >= next ? made->junction + 1 : next;
        }
        first_junction = next;
    }
}

static void join_matches(joined *j, const asj_match_result *shown, const asj_match_result *other, const uint8_t *wanted,
                         int32_t same_lists)
{
    const uint32_t first1 = same_lists ? 0 : shown->l_junction_count1, first2 = same_lists ? 0 : shown->l_junction_count2;
    for (uint32_t k = 0; k < shown->match_count; k++)
        j->matches[j->count++] = shown->matches[k];
    for (uint32_t k = 0; k < other->match_count; k++) {
        asj_junction_match *m = &j->matches[j->count];
        if (!wanted[k])
            continue;
        *m = other->matches[k];
        m->l1 += first1;
        m->l2 += first2;
        m->junction1 = j->l[0][m->l1].junction;
        m->junction2 = j->l[1][m->l2].junction;
        j->count++;
    }
}

static void exchange(asj_own_result *r, joined *j)
{
    const joined before = {r->matches, {r->l1, r->l2}, {r->places[0], r->places[1]}, 0, {0, 0}};
    asj_match_result *shown = &r->shown;
    r->matches = j->matches;
    r->l1 = j->l[0];
    r->l2 = j->l[1];
    memcpy(r->places, j->places, sizeof r->places);
    shown->matches = j->count ? r->matches : NULL;
    shown->match_count = r->count = j->count;
    shown->l_junctions1 = j->l_count[0] ? r->l1 : NULL;
    shown->l_junctions2 = j->l_count[1] ? r->l2 : NULL;
    shown->l_junction_count1 = j->l_count[0];
    shown->l_junction_count2 = j->l_count[1];
    *j = before;
    asj_match_result_sort(r);
}

asj_status asj_match_result_join(asj_context *context, asj_match_result *shown, const asj_match_result *other,
                                 const uint8_t *wanted, int32_t same_lists)
{
    asj_own_result *r = (asj_own_result *)shown;
    const size_t count = (size_t)shown->match_count + other->match_count;
    const size_t l_counts[2] = {(size_t)shown->l_junction_count1 + (same_lists ? 0 : other->l_junction_count1),
                                (size_t)shown->l_junction_count2 + (same_lists ? 0 : other->l_junction_count2)};
    joined j = {.matches = asj_allocate(&r->memory, count, sizeof *j.matches)};
    asj_status status = ASJ_OK;
    for (int32_t side = 0; side < 2; side++) {
        j.l[side] = asj_allocate(&r->memory, l_counts[side], sizeof *j.l[side]);
        j.places[side] = asj_allocate(&r->memory, count, sizeof *j.places[side]);
        if (!j.matches || !j.l[side] || !j.places[side])
            status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu matches", count);
    }
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++)
        join_l_junctions(&j, shown, same_lists ? NULL : other, side);
    if (status == ASJ_OK) {
        join_matches(&j, shown, other, wanted, same_lists);
        exchange(r, &j);
    }
    for (int32_t side = 0; side < 2; side++) {
        asj_release(&r->memory, j.l[side]);
        asj_release(&r->memory, j.places[side]);
    }
    asj_release(&r->memory, j.matches);
    return status;
}
