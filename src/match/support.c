/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, who agrees with whom: the supporters of every candidate, among those at the nearest places of image 1 and of image 2.
 *
 * Millions of pairs are looked at, a few in a hundred may agree (asj_look_at()), fewer do, and only these are stored. When the
 * guided pass brings new candidates, those known before are only compared with the new ones. */
#include "support.h"
#include "agreement.h"

#include <string.h>

#define MOST 0x1000000 /* supporters of the candidates of one side: 128 MB; eight pairs of photographs need up to 40 000 */
#define BLOCK 0x40000 /* supporters of a block of candidates, before it is known how many they are: 2 MB */

/* --- candidates by place ---------------------------------------------------------------------------------------------------- */

static uint32_t place_of(const asj_corners *corners, const asj_candidate *c, int32_t side)
{
    return corners->place[side == 1 ? c->i : c->j];
}

asj_status asj_place_index_create(asj_context *context, const asj_corners *corners, const asj_candidates *candidates, int32_t side,
                                  uint32_t least_number, asj_place_index *index)
{
    const asj_candidate *list = candidates->list;
    index->start = asj_allocate_zero(&context->memory, (size_t)corners->place_count + 2, sizeof *index->start);
    index->order = asj_allocate(&context->memory, candidates->count, sizeof *index->order);
    if (!index->start || !index->order)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for an index of %zu candidates", candidates->count);
    for (size_t k = 0; k < candidates->count; k++)
        if (list[k].number >= least_number)
            index->start[place_of(corners, &list[k], side) + 2]++;
    for (uint32_t p = 2; p < corners->place_count + 2; p++)
        index->start[p] += index->start[p - 1];
    for (size_t k = 0; k < candidates->count; k++)
        if (list[k].number >= least_number)
            index->order[index->start[place_of(corners, &list[k], side) + 1]++] = (uint32_t)k;
    return ASJ_OK;
}

void asj_place_index_free(asj_memory *memory, asj_place_index *index)
{
    asj_release(memory, index->start);
    asj_release(memory, index->order);
    index->start = index->order = NULL;
}

/* --- who may support --------------------------------------------------------------------------------------------------------- */

/* Candidates in order of place, with what asj_look_at() wants to know of them. */
typedef struct pool {
    asj_place_index index;
    asj_spots spots; /* in its order */
    float *block;
} pool;

static asj_status pool_create(asj_context *context, const asj_corners *corners, const asj_corners *others,
                              const asj_candidates *candidates, int32_t side, uint32_t least_number, pool *s)
{
    asj_status status = asj_place_index_create(context, corners, candidates, side, least_number, &s->index);
    if (status != ASJ_OK)
        return status;
    const size_t count = s->index.start[corners->place_count], room = count + ASJ_LOOK_MORE;
    s->block = asj_allocate_zero(&context->memory, room, 6 * sizeof *s->block);
    if (!s->block)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    s->spots.x = s->block;
    s->spots.y = s->block + room;
    for (size_t k = 0; k < 4; k++)
        s->spots.map[k] = s->block + (2 + k) * room;
    for (size_t m = 0; m < count; m++) {
        const asj_candidate *c = &candidates->list[s->index.order[m]];
        const asj_l_junction *l = &others->l[side == 1 ? c->j : c->i];
        s->spots.x[m] = l->x;
        s->spots.y[m] = l->y;
        for (int k = 0; k < 4; k++)
            s->spots.map[k][m] = (float)(side == 1 ? c->map.to : c->map.from)[k];
    }
    return ASJ_OK;
}

static void pool_free(asj_memory *memory, pool *s)
{
    asj_place_index_free(memory, &s->index);
    asj_release(memory, s->block);
}

/* --- who does --------------------------------------------------------------------------------------------------------------- */

/* All that the candidates of one side share. */
typedef struct search {
    const asj_match_options *options;
    const asj_ops *ops;
    const asj_corners *corners1, *corners2, *corners, *others; /* the image whose neighbour places are asked, the other one */
    const asj_candidates *candidates;
    int32_t side;
    uint32_t before;           /* candidates that were known before have such a number at most, */
    const asj_supporters *old; /* and these supporters among each other */
    pool all, fresh;
} search;

/* A candidate whose supporters are looked for. */
typedef struct subject {
    const asj_candidate *c;
    uint32_t mine, other;   /* its L-junction in the image asked, and in the other */
    double x, y;            /* px: where it stands in the image asked */
    const double *map;      /* from there to the other */
    asj_look look;          /* without what depends on the place */
} subject;

static subject subject_of(const search *in, const asj_candidate *c)
{
    subject n = {.c = c, .mine = in->side == 1 ? c->i : c->j, .other = in->side == 1 ? c->j : c->i};
    const double *u = in->others->direction + 4 * (size_t)n.other, tolerance = in->options->neighbour_tolerance;
    n.x = (double)in->corners->l[n.mine].x;
    n.y = (double)in->corners->l[n.mine].y;
    n.map = in->side == 1 ? c->map.to : c->map.from;
    n.look = (asj_look){.x = in->others->l[n.other].x, .y = in->others->l[n.other].y,
                        .slope = (float)(ASJ_LOOK_SLOPE * tolerance * tolerance),
                        .branch = {{(float)u[0], (float)u[1]}, {(float)u[2], (float)u[3]}}};
    return n;
}

/* Agreement in 1/ASJ_SUPPORT_ONE. (x, y) is the way in the image asked, (ex, ey) in the other. */
static uint16_t weigh(const search *in, const subject *n, const asj_candidate *d, double x, double y, double ex, double ey)
{
    const asj_way way = in->side == 1 ? (asj_way){x, y, ex, ey} : (asj_way){ex, ey, x, y};
    const float w = asj_surface_agreement(in->options, n->c, d, &way);
    const float v = asj_edges_through(in->others, n->other, n->look.edges, ex, ey)
        ? asj_edge_agreement(in->options, in->corners1, in->corners2, n->c, d, &way) : 0;
    return (uint16_t)((v > w ? v : w) * ASJ_SUPPORT_ONE);
}

/* The supporters at a place, the subject's neighbour of this number. */
static uint32_t supporters_at(const search *in, const pool *s, subject *n, uint32_t place, uint32_t neighbour, asj_supporter *list)
{
    const double x = in->corners->place_x[place] - n->x, y = in->corners->place_y[place] - n->y;
    const uint32_t end = s->index.start[place + 1];
    uint32_t count = 0;
    n->look.way_x = (float)x;
    n->look.way_y = (float)y;
    n->look.px = (float)(n->map[0] * x + n->map[1] * y);
    n->look.py = (float)(n->map[2] * x + n->map[3] * y);
    n->look.edges = asj_edges_through(in->corners, n->mine, in->others->stem[n->other] ? 0 : 3, x, y);
    for (uint32_t m = s->index.start[place]; m < end; m += ASJ_LOOK_COUNT) {
        uint64_t seen = in->ops->agreement->look_at(&n->look, &s->spots, m, end - m < ASJ_LOOK_COUNT ? end - m : ASJ_LOOK_COUNT);
        for (uint32_t at = m; seen; at++, seen >>= 1) {
            if (!(seen & 1))
                continue;
            const asj_candidate *d = &in->candidates->list[s->index.order[at]];
            const double ex = (double)s->spots.x[at] - (double)n->look.x, ey = (double)s->spots.y[at] - (double)n->look.y;
            const uint16_t weight = weigh(in, n, d, x, y, ex, ey);
            if (weight)
                list[count++] = (asj_supporter){d->number - 1, weight, (uint16_t)neighbour};
        }
    }
    return count;
}

/* All supporters of c; returns how many they are. */
static uint32_t find_supporters(const search *in, const asj_candidate *c, asj_supporter *list)
{
    const uint32_t place = place_of(in->corners, c, in->side);
    const uint32_t *neighbour = in->corners->neighbour + (size_t)place * in->corners->neighbour_limit;
    const int32_t known = c->number <= in->before;
    const pool *s = known ? &in->fresh : &in->all;
    const asj_supporter *old = known ? in->old->list + in->old->offset[c->number - 1] : NULL;
    const asj_supporter *end = known ? old + in->old->count[c->number - 1] : NULL;
    subject self = subject_of(in, c);
    uint32_t count = 0;
    for (uint32_t n = 0; n < in->corners->neighbour_count[place]; n++) {
        while (old < end && old->place == n)
            list[count++] = *old++;
        if (s->index.start[neighbour[n]] < s->index.start[neighbour[n] + 1])
            count += supporters_at(in, s, &self, neighbour[n], n, list + count);
    }
    return count;
}

/* --- blocks of candidates --------------------------------------------------------------------------------------------------- */

/* How many supporters candidates of each place can have. */
static void find_limits(const search *in, uint32_t *limits, size_t *largest)
{
    const asj_corners *corners = in->corners;
    for (uint32_t p = 0; p < corners->place_count; p++) {
        const uint32_t *neighbour = corners->neighbour + (size_t)p * corners->neighbour_limit;
        limits[p] = 0;
        for (uint32_t n = 0; n < corners->neighbour_count[p]; n++)
            limits[p] += in->all.index.start[neighbour[n] + 1] - in->all.index.start[neighbour[n]];
        *largest = limits[p] > *largest ? limits[p] : *largest;
    }
}

/* As many candidates, from `first` on, as there is room for the supporters of. Returns the end. */
static size_t take_block(const search *in, const uint32_t *limits, size_t first, size_t capacity, size_t *starts)
{
    size_t end = first;
    for (size_t used = 0; end < in->candidates->count; end++) {
        const size_t room = limits[place_of(in->corners, &in->candidates->list[end], in->side)];
        if (used + room > capacity)
            break;
        starts[end] = used;
        used += room;
    }
    return end;
}

/* Appends the supporters of candidates first .. end - 1. */
static asj_status keep(asj_context *context, const search *in, size_t first, size_t end, const asj_supporter *scratch,
                       const size_t *starts, asj_supporters *found, size_t *used, size_t *capacity)
{
    size_t total = *used + 1; /* never NULL */
    for (size_t k = first; k < end; k++)
        total += found->count[in->candidates->list[k].number - 1];
    if (total > MOST)
        return asj_fail(context, ASJ_ERROR_LIMIT, "more than %d pairs of candidates agree: options too loose", MOST);
    void *block = found->list;
    const asj_status status = asj_grow(&context->memory, &block, capacity, total, sizeof *found->list, *used);
    found->list = block;
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for %zu pairs of candidates", total);
    for (size_t k = first; k < end; k++) {
        const uint32_t n = in->candidates->list[k].number - 1;
        memcpy(found->list + *used, scratch + starts[k], found->count[n] * sizeof *scratch);
        found->offset[n] = *used;
        *used += found->count[n];
    }
    return ASJ_OK;
}

static asj_status find_all(asj_context *context, const search *in, uint32_t *limits, size_t *starts, asj_supporters *found)
{
    size_t capacity = BLOCK, used = 0, kept = 0;
    find_limits(in, limits, &capacity);
    asj_supporter *scratch = asj_allocate(&context->memory, capacity, sizeof *scratch);
    asj_status status = scratch ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu pairs of candidates", capacity);
    for (size_t first = 0, end; first < in->candidates->count && status == ASJ_OK; first = end) {
        end = take_block(in, limits, first, capacity, starts);
#pragma omp parallel for num_threads(context->threads) schedule(dynamic, 16)
        for (int64_t k = (int64_t)first; k < (int64_t)end; k++) {
            const asj_candidate *c = &in->candidates->list[k];
            found->count[c->number - 1] = find_supporters(in, c, scratch + starts[k]);
        }
        status = keep(context, in, first, end, scratch, starts, found, &used, &kept);
    }
    asj_release(&context->memory, scratch);
    return status;
}

static asj_status one_side(asj_context *context, search *in, asj_supporters *found)
{
    asj_memory *memory = &context->memory;
    const size_t count = in->candidates->count;
    uint32_t *limits = asj_allocate(memory, in->corners->place_count, sizeof *limits);
    size_t *starts = asj_allocate(memory, count, sizeof *starts);
    found->offset = asj_allocate(memory, count, sizeof *found->offset);
    found->count = asj_allocate(memory, count, sizeof *found->count);
    asj_status status = limits && starts && found->offset && found->count
        ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    if (status == ASJ_OK)
        status = pool_create(context, in->corners, in->others, in->candidates, in->side, 0, &in->all);
    if (status == ASJ_OK)
        status = pool_create(context, in->corners, in->others, in->candidates, in->side, in->before + 1, &in->fresh);
    if (status == ASJ_OK)
        status = find_all(context, in, limits, starts, found);
    pool_free(memory, &in->all);
    pool_free(memory, &in->fresh);
    asj_release(memory, limits);
    asj_release(memory, starts);
    return status;
}

static void supporters_free(asj_memory *memory, asj_supporters *found)
{
    asj_release(memory, found->offset);
    asj_release(memory, found->count);
    asj_release(memory, found->list);
    *found = (asj_supporters){NULL, NULL, NULL};
}

asj_status asj_support_extend(asj_context *context, const asj_match_options *options, const asj_view *view1,
                              const asj_view *view2, asj_candidates *candidates, asj_support *support)
{
    const asj_corners *corners[2] = {&view1->corners, &view2->corners};
    const uint32_t before = support->count;
    asj_status status = ASJ_OK;
    for (size_t k = 0; k < candidates->count; k++)
        if (candidates->list[k].number == 0)
            candidates->list[k].number = ++support->count;
    for (int32_t s = 0; s < 2 && status == ASJ_OK; s++) {
        asj_supporters old = support->side[s];
        search in = {.options = options, .ops = context->ops, .corners1 = corners[0], .corners2 = corners[1],
                     .corners = corners[s], .others = corners[1 - s], .candidates = candidates, .side = s + 1, .before = before,
                     .old = &old};
        support->side[s] = (asj_supporters){NULL, NULL, NULL};
        status = one_side(context, &in, &support->side[s]);
        supporters_free(&context->memory, &old);
    }
    return status;
}

void asj_support_free(asj_memory *memory, asj_support *support)
{
    for (int32_t s = 0; s < 2; s++)
        supporters_free(memory, &support->side[s]);
    support->count = 0;
}
