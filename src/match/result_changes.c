/* SPDX-License-Identifier: BSD-2-Clause */
/* A result that another one of the same images changes, or another view of what it is in. */
#include "result_changes.h"

#include <math.h>
#include <string.h>

void asj_match_result_unstretch(asj_match_result *shown, const asj_stretch by[2])
{
    asj_own_result *r = (asj_own_result *)shown;
    for (int32_t n = 0; n < 2; n++) {
        r->known.by[n].x *= by[n].x;
        r->known.by[n].y *= by[n].y;
    }
    r->farthest /= sqrt(sqrt(by[0].x * by[0].y * by[1].x * by[1].y)); /* the mean scale */
    asj_unstretch_matches(r->matches, shown->match_count, by);
    asj_unstretch_matches(r->rejected, shown->rejected_count, by);
    asj_unstretch_l_junctions(r->l1, shown->l_junction_count1, &by[0]);
    asj_unstretch_l_junctions(r->l2, shown->l_junction_count2, &by[1]);
    asj_unstretch_geometry(&shown->geometry, by);
    asj_unstretch_fundamental(r->epipolar, by);
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
    renumber(r->rejected, shown->rejected_count, side, number);
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

asj_status asj_match_result_judge(asj_context *context, asj_match_result *shown, const float *probability,
                                  const float *of_rejected)
{
    asj_own_result *r = (asj_own_result *)shown;
    const size_t count = (size_t)shown->match_count + shown->rejected_count;
    uint32_t kept = 0, gone = 0;
    asj_junction_match *rejected = asj_allocate(&r->memory, count, sizeof *rejected);
    if (!rejected)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu matches", count);
    for (size_t k = 0; of_rejected && k < shown->rejected_count; k++)
        if (of_rejected[k] < 0)
            rejected[gone++] = r->rejected[k];
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
    asj_junction_match *matches, *rejected;
    asj_l_junction *l[2];
    asj_place *places[2];
    uint32_t count, rejected_count, l_count[2];
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

/* Appends those that are wanted, with numbers of L-junctions from `first` on. */
static void append(joined *j, asj_junction_match *list, uint32_t *to, const asj_junction_match *from, size_t count,
                   const uint8_t *wanted, const uint32_t first[2])
{
    for (size_t k = 0; k < count; k++) {
        asj_junction_match *m = &list[*to];
        if (!wanted[k])
            continue;
        *m = from[k];
        m->l1 += first[0];
        m->l2 += first[1];
        m->junction1 = j->l[0][m->l1].junction;
        m->junction2 = j->l[1][m->l2].junction;
        (*to)++;
    }
}

static void join_matches(joined *j, const asj_match_result *shown, const asj_match_result *other, const uint8_t *wanted,
                         const uint8_t *wanted_rejected, int32_t same_lists)
{
    const uint32_t first[2] = {same_lists ? 0 : shown->l_junction_count1, same_lists ? 0 : shown->l_junction_count2};
    for (uint32_t k = 0; k < shown->match_count; k++)
        j->matches[j->count++] = shown->matches[k];
    for (size_t k = 0; k < shown->rejected_count; k++)
        j->rejected[j->rejected_count++] = shown->rejected[k];
    append(j, j->matches, &j->count, other->matches, other->match_count, wanted, first);
    append(j, j->rejected, &j->rejected_count, other->rejected, other->rejected_count, wanted_rejected, first);
}

static void exchange(asj_own_result *r, joined *j)
{
    const joined before = {r->matches, r->rejected, {r->l1, r->l2}, {r->places[0], r->places[1]}, 0, 0, {0, 0}};
    asj_match_result *shown = &r->shown;
    r->matches = j->matches;
    r->rejected = j->rejected;
    r->l1 = j->l[0];
    r->l2 = j->l[1];
    memcpy(r->places, j->places, sizeof r->places);
    shown->matches = j->count ? r->matches : NULL;
    shown->match_count = r->count = j->count;
    shown->rejected = j->rejected_count ? r->rejected : NULL;
    shown->rejected_count = j->rejected_count;
    shown->l_junctions1 = j->l_count[0] ? r->l1 : NULL;
    shown->l_junctions2 = j->l_count[1] ? r->l2 : NULL;
    shown->l_junction_count1 = j->l_count[0];
    shown->l_junction_count2 = j->l_count[1];
    *j = before;
    asj_match_result_sort(r);
}

asj_status asj_match_result_join(asj_context *context, asj_match_result *shown, const asj_match_result *other,
                                 const uint8_t *wanted, const uint8_t *wanted_rejected, int32_t same_lists)
{
    asj_own_result *r = (asj_own_result *)shown;
    const size_t count = (size_t)shown->match_count + other->match_count;
    const size_t rejected = (size_t)shown->rejected_count + other->rejected_count;
    const size_t l_counts[2] = {(size_t)shown->l_junction_count1 + (same_lists ? 0 : other->l_junction_count1),
                                (size_t)shown->l_junction_count2 + (same_lists ? 0 : other->l_junction_count2)};
    joined j = {.matches = asj_allocate(&r->memory, count, sizeof *j.matches),
                .rejected = asj_allocate(&r->memory, rejected, sizeof *j.rejected)};
    asj_status status = ASJ_OK;
    for (int32_t side = 0; side < 2; side++) {
        j.l[side] = asj_allocate(&r->memory, l_counts[side], sizeof *j.l[side]);
        j.places[side] = asj_allocate(&r->memory, count, sizeof *j.places[side]);
        if (!j.matches || !j.rejected || !j.l[side] || !j.places[side])
            status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu matches", count);
    }
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++)
        join_l_junctions(&j, shown, same_lists ? NULL : other, side);
    if (status == ASJ_OK) {
        join_matches(&j, shown, other, wanted, wanted_rejected, same_lists);
        exchange(r, &j);
    }
    for (int32_t side = 0; side < 2; side++) {
        asj_release(&r->memory, j.l[side]);
        asj_release(&r->memory, j.places[side]);
    }
    asj_release(&r->memory, j.matches);
    asj_release(&r->memory, j.rejected);
    return status;
}
