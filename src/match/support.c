/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, who agrees with whom: the supporters of every candidate, among those at the nearest locations of image 1 and of image 2.
 *
 * Of millions of pairs a few in a hundred may agree (support_gate.c, narrow_gate.c), fewer do (agreement.c), and only these are
 * stored. When the guided pass brings new candidates, those known before are only compared with the new ones.
 *
 * In a fine pattern that repeats everything agrees with everything near. Where all are more than MOST_SUPPORTERS, these are shared
 * out equally among the candidates, and each keeps those at its nearest neighbours. (Two views of a grid with lines 16 px apart:
 * 71 000 of 129 000 have their whole share of 129.) */
#include "support.h"
#include "narrow_gate.h"
#include "core/lowest_bit.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define MOST_SUPPORTERS 0x1000000 /* 128 MB */
#define BLOCK_SUPPORTERS 0x40000  /* of a block of candidates, before it is known how many they are: 2 MB */

/* --- candidates by location ------------------------------------------------------------------------------------------------- */

static uint32_t location_of(const asj_match_run *run, const asj_candidate *c, int32_t side)
{
    return run->image[side]->l_junctions.location[asj_candidate_l(c, side)];
}

asj_status asj_location_index_create(const asj_match_run *run, int32_t side, uint32_t least_number, asj_location_index *index)
{
    asj_memory *memory = &run->context->memory;
    const asj_candidate *list = run->candidates.list;
    const size_t count = run->candidates.count;
    const uint32_t locations = run->image[side]->l_junctions.location_count;
    index->start = asj_allocate_zero(memory, (size_t)locations + 2, sizeof *index->start);
    index->order = asj_allocate(memory, count, sizeof *index->order);
    if (!index->start || !index->order)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for an index of %zu candidates", count);
    for (size_t k = 0; k < count; k++)
        if (list[k].number >= least_number)
            index->start[location_of(run, &list[k], side) + 2]++;
    for (uint32_t p = 2; p < locations + 2; p++)
        index->start[p] += index->start[p - 1];
    for (size_t k = 0; k < count; k++)
        if (list[k].number >= least_number)
            index->order[index->start[location_of(run, &list[k], side) + 1]++] = (uint32_t)k;
    return ASJ_OK;
}

void asj_location_index_free(asj_memory *memory, asj_location_index *index)
{
    asj_release_much(memory, index->start);
    asj_release_much(memory, index->order);
    index->start = index->order = NULL;
}

/* --- who may support --------------------------------------------------------------------------------------------------------- */

/* Candidates in order of location, with what asj_support_gate() wants to know of them. */
typedef struct pool {
    asj_location_index index;
    asj_gate_candidates gate; /* in its order */
    asj_narrow_maps *maps;     /* in its order, too */
    float *block;
} pool;

static asj_status pool_create(const asj_match_run *run, int32_t side, uint32_t least_number, pool *s)
{
    asj_status status = asj_location_index_create(run, side, least_number, &s->index);
    if (status != ASJ_OK)
        return status;
    const size_t count = s->index.start[run->image[side]->l_junctions.location_count], room = count + ASJ_GATE_PADDING;
    s->block = asj_allocate_zero(&run->context->memory, room, 8 * sizeof *s->block);
    s->maps = asj_allocate(&run->context->memory, count, sizeof *s->maps);
    if (!s->block || !s->maps)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    s->gate.x = s->block;
    s->gate.y = s->block + room;
    for (size_t k = 0; k < 4; k++)
        s->gate.map[k] = s->block + (2 + k) * room;
    s->gate.length[0] = s->block + 6 * room;
    s->gate.length[1] = s->block + 7 * room;
    for (size_t m = 0; m < count; m++) {
        const asj_candidate *c = &run->candidates.list[s->index.order[m]];
        const asj_l_junction *l = asj_match_run_l(run, c, 1 - side);
        s->gate.x[m] = l->x;
        s->gate.y[m] = l->y;
        for (int k = 0; k < 4; k++)
            s->gate.map[k][m] = (float)asj_candidate_map(c, side)[k];
        asj_gate_lengths(run, c, side, &s->gate.length[0][m], &s->gate.length[1][m]);
        s->maps[m] = asj_narrow_maps_of(run->candidates.list, s->index.order[m], side);
    }
    return ASJ_OK;
}

static void pool_free(asj_memory *memory, pool *s)
{
    asj_location_index_free(memory, &s->index);
    asj_release_much(memory, s->block);
    asj_release_much(memory, s->maps);
}

/* --- who does --------------------------------------------------------------------------------------------------------------- */

/* All that the candidates of one side share. */
typedef struct search {
    const asj_match_run *run;
    int32_t side;
    const asj_l_junctions *asked, *others; /* of the image whose neighbour locations are asked, and of the other one */
    uint32_t before;           /* candidates that were known before have such a number at most, */
    const asj_supporters *old; /* and these supporters among each other */
    size_t room;               /* for the supporters of all candidates */
    uint32_t share;            /* of a candidate, where all are more: UINT32_MAX until that is known */
    pool all, fresh;
} search;

/* A candidate whose supporters are looked for. */
typedef struct subject {
    const asj_candidate *c;
    uint32_t mine, other;   /* its L-junction in the image asked, and in the other */
    double x, y;            /* px: where it stands in the image asked */
    const double *map;      /* from there to the other */
    double cover;           /* part of the way that branches of an edge cover */
    asj_gate_query query;   /* these two without what depends on the location */
    asj_narrow_query narrow;
} subject;

static subject subject_of(const search *in, const asj_candidate *c)
{
    subject n = {.c = c, .mine = asj_candidate_l(c, in->side), .other = asj_candidate_l(c, 1 - in->side)};
    const double *u = in->others->direction + 4 * (size_t)n.other, tolerance = in->run->options->neighbour_tolerance;
    n.x = (double)in->asked->l[n.mine].x;
    n.y = (double)in->asked->l[n.mine].y;
    n.map = asj_candidate_map(c, in->side);
    n.query = (asj_gate_query){.x = in->others->l[n.other].x, .y = in->others->l[n.other].y,
                               .slope = (float)(ASJ_GATE_SLOPE * tolerance * tolerance),
                               .branch = {{(float)u[0], (float)u[1]}, {(float)u[2], (float)u[3]}}};
    for (uint32_t t = 0; t < 2; t++)
        n.query.length[t] = (float)in->others->lengths[2 * (size_t)n.other + t].length[0];
    n.cover = ASJ_GATE_COVER * fmax(1 - in->run->options->end_tolerance, 0);
    n.query.cover = (float)(n.cover * n.cover);
    n.narrow = asj_narrow_query_of(in->run->options, c, in->side);
    return n;
}

/* Agreement in 1/ASJ_SUPPORT_ONE. (x, y) is the way in the image asked, (ex, ey) in the other. */
static uint16_t weigh(const search *in, const subject *n, const asj_narrow_maps *maps, double x, double y, double ex, double ey)
{
    const uint32_t may = asj_narrow_gate(&n->query, &n->narrow, maps, (float)ex, (float)ey);
    if (!may)
        return 0;
    const asj_candidate *d = &in->run->candidates.list[maps->candidate];
    const asj_way way = in->side == 0 ? (asj_way){x, y, ex, ey} : (asj_way){ex, ey, x, y};
    const float w = may & ASJ_NARROW_SURFACE ? asj_surface_agreement(in->run->options, n->c, d, &way) : 0;
    const float v = may & ASJ_NARROW_EDGE && asj_edges_through(in->others, n->other, n->query.edges, ex, ey)
        ? asj_edge_agreement(in->run, n->c, d, &way) : 0;
    return (uint16_t)((v > w ? v : w) * ASJ_SUPPORT_ONE);
}

/* Where location is asked, (x, y) from the subject. */
static void turn_to(const search *in, subject *n, double x, double y)
{
    n->query.way_x = (float)x;
    n->query.way_y = (float)y;
    n->query.px = (float)(n->map[0] * x + n->map[1] * y);
    n->query.py = (float)(n->map[2] * x + n->map[3] * y);
    n->query.edges = asj_edges_through(in->asked, n->mine, in->others->t_junction[n->other] ? 0 : 3, x, y);
    if (!n->query.edges)
        return;
    const double needed = n->cover * sqrt(x * x + y * y);
    for (uint32_t t = 0; t < 2; t++)
        n->query.least[t] = (float)(needed - (double)in->asked->lengths[2 * (size_t)n->mine + t].length[0]);
}

/* The supporters at a location, the subject's neighbour of this number; `most` of them. */
static uint32_t supporters_at(const search *in, const pool *s, subject *n, uint32_t location, uint32_t neighbour,
                              asj_supporter *list, uint32_t most)
{
    const double x = in->asked->location_x[location] - n->x, y = in->asked->location_y[location] - n->y;
    const uint32_t end = s->index.start[location + 1];
    uint32_t count = 0;
    turn_to(in, n, x, y);
    for (uint32_t m = s->index.start[location]; m < end && count < most; m += ASJ_GATE_COUNT) {
        const uint32_t some = end - m < ASJ_GATE_COUNT ? end - m : ASJ_GATE_COUNT;
        uint64_t passed = in->run->context->ops->gate->pass(&n->query, &s->gate, m, some);
        for (; passed && count < most; passed &= passed - 1) {
            const uint32_t at = m + asj_lowest_bit(passed);
            const double ex = (double)s->gate.x[at] - (double)n->query.x, ey = (double)s->gate.y[at] - (double)n->query.y;
            const uint16_t weight = weigh(in, n, &s->maps[at], x, y, ex, ey);
            if (weight)
                list[count++] = (asj_supporter){in->run->candidates.list[s->maps[at].candidate].number - 1, weight,
                                                (uint16_t)neighbour};
        }
    }
    return count;
}

/* The supporters of c, those at the nearest locations first; returns how many they are. */
static uint32_t find_supporters(const search *in, const asj_candidate *c, asj_supporter *list)
{
    const uint32_t location = location_of(in->run, c, in->side);
    const uint32_t *neighbour = in->asked->neighbour + (size_t)location * in->asked->neighbour_limit;
    const int32_t known = c->number <= in->before;
    const pool *s = known ? &in->fresh : &in->all;
    const asj_supporter *old = known ? in->old->list + in->old->offset[c->number - 1] : NULL;
    const asj_supporter *end = known ? old + in->old->count[c->number - 1] : NULL;
    subject self = subject_of(in, c);
    uint32_t count = 0;
    for (uint32_t n = 0; n < in->asked->neighbour_count[location] && count < in->share; n++) {
        while (old < end && old->neighbour == n && count < in->share)
            list[count++] = *old++;
        if (s->index.start[neighbour[n]] < s->index.start[neighbour[n] + 1])
            count += supporters_at(in, s, &self, neighbour[n], n, list + count, in->share - count);
    }
    return count;
}

/* --- blocks of candidates --------------------------------------------------------------------------------------------------- */

/* Room for the supporters of a block of candidates, before it is known how many they are. */
typedef struct block {
    uint32_t *limits;  /* of each location: how many supporters a candidate there can have */
    size_t *starts;    /* of each candidate: where its supporters begin in `list` */
    asj_supporter *list;
    size_t capacity;   /* of the list */
    size_t used, kept; /* supporters of all blocks up to now, and the room for them */
} block;

static void find_limits(const search *in, block *b)
{
    const asj_l_junctions *asked = in->asked;
    b->capacity = BLOCK_SUPPORTERS;
    for (uint32_t p = 0; p < asked->location_count; p++) {
        const uint32_t *neighbour = asked->neighbour + (size_t)p * asked->neighbour_limit;
        b->limits[p] = 0;
        for (uint32_t n = 0; n < asked->neighbour_count[p]; n++)
            b->limits[p] += in->all.index.start[neighbour[n] + 1] - in->all.index.start[neighbour[n]];
        b->limits[p] = b->limits[p] < in->share ? b->limits[p] : in->share;
        b->capacity = b->limits[p] > b->capacity ? b->limits[p] : b->capacity;
    }
}

/* The order in which supporters are looked for: by location, so that one after the other has the same neighbours and finds them in
 * the cache. */
static const asj_candidate *in_order(const search *in, size_t k)
{
    return &in->run->candidates.list[in->all.index.order[k]];
}

/* As many candidates in this order, from `first` on, as there is room for the supporters of. Returns the end. */
static size_t take_block(const search *in, size_t first, block *b)
{
    size_t end = first;
    for (size_t used = 0; end < in->run->candidates.count; end++) {
        const size_t room = b->limits[location_of(in->run, in_order(in, end), in->side)];
        if (used + room > b->capacity)
            break;
        b->starts[end] = used;
        used += room;
    }
    return end;
}

/* Appends the supporters of candidates first .. end - 1 in this order. ASJ_ERROR_LIMIT: there is no room, and nobody has a share
 * yet. */
static asj_status keep(const search *in, size_t first, size_t end, block *b, asj_supporters *found)
{
    size_t total = b->used + 1; /* never NULL */
    for (size_t k = first; k < end; k++)
        total += found->count[in_order(in, k)->number - 1];
    if (total > in->room && in->share == UINT32_MAX)
        return ASJ_ERROR_LIMIT;
    void *memory = found->list;
    const asj_status status = asj_grow_within(&in->run->context->memory, &memory, &b->kept, total, in->room, sizeof *found->list,
                                              b->used);
    found->list = memory;
    if (status != ASJ_OK)
        return asj_fail(in->run->context, status, "no memory for %zu pairs of candidates", total);
    for (size_t k = first; k < end; k++) {
        const uint32_t n = in_order(in, k)->number - 1;
        memcpy(found->list + b->used, b->list + b->starts[k], found->count[n] * sizeof *b->list);
        found->offset[n] = b->used;
        b->used += found->count[n];
    }
    return ASJ_OK;
}

typedef struct job {
    const search *in;
    const block *b;
    asj_supporters *found;
    asj_watch *watch;
    size_t first;
} job;

static void find_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end && !asj_watch_stops(j->watch, part); n++) {
        const size_t k = j->first + (size_t)n;
        const asj_candidate *c = in_order(j->in, k);
        j->found->count[c->number - 1] = find_supporters(j->in, c, j->b->list + j->b->starts[k]);
    }
}

static asj_status find_all(const search *in, block *b, asj_supporters *found)
{
    find_limits(in, b);
    b->used = 0;
    asj_release_much(&in->run->context->memory, b->list);
    b->list = asj_allocate(&in->run->context->memory, b->capacity, sizeof *b->list);
    if (!b->list)
        return asj_fail(in->run->context, ASJ_ERROR_MEMORY, "no memory for %zu pairs of candidates", b->capacity);
    asj_status status = ASJ_OK;
    asj_watch watch;
    asj_watch_start(&watch, in->run->context, ASJ_STAGE_ASSIGN);
    for (size_t first = 0, end; first < in->run->candidates.count && status == ASJ_OK; first = end) {
        end = take_block(in, first, b);
        const job j = {in, b, found, &watch, first};
        asj_parallel(in->run->context, in->run->context->threads, (int64_t)(end - first), 16, find_some, &j);
        status = asj_watch_end(&watch);
        if (status == ASJ_OK)
            status = keep(in, first, end, b, found);
    }
    return status;
}

static asj_status one_side(search *in, asj_supporters *found)
{
    const asj_match_run *run = in->run;
    asj_memory *memory = &run->context->memory;
    const size_t count = run->candidates.count;
    block b = {.limits = asj_allocate(memory, in->asked->location_count, sizeof *b.limits),
               .starts = asj_allocate(memory, count, sizeof *b.starts)};
    found->offset = asj_allocate(memory, count, sizeof *found->offset);
    found->count = asj_allocate(memory, count, sizeof *found->count);
    asj_status status = b.limits && b.starts && found->offset && found->count
        ? ASJ_OK : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    if (status == ASJ_OK)
        status = pool_create(run, in->side, 0, &in->all);
    if (status == ASJ_OK)
        status = pool_create(run, in->side, in->before + 1, &in->fresh);
    if (status == ASJ_OK)
        status = find_all(in, &b, found);
    if (status == ASJ_ERROR_LIMIT) {
        in->share = in->room > count ? (uint32_t)(in->room / count) : 1;
        status = find_all(in, &b, found);
    }
    pool_free(memory, &in->all);
    pool_free(memory, &in->fresh);
    asj_release_much(memory, b.limits);
    asj_release_much(memory, b.starts);
    asj_release_much(memory, b.list);
    return status;
}

static void supporters_free(asj_memory *memory, asj_supporters *found)
{
    asj_release_much(memory, found->offset);
    asj_release_much(memory, found->count);
    asj_release_much(memory, found->list);
    *found = (asj_supporters){NULL, NULL, NULL};
}

asj_status asj_support_find_within(asj_match_run *run, size_t most)
{
    asj_support *support = &run->support;
    const uint32_t before = support->count;
    asj_status status = ASJ_OK;
    if (run->options->neighbours == 0)
        return ASJ_OK;
    for (size_t k = 0; k < run->candidates.count; k++)
        if (run->candidates.list[k].number == 0)
            run->candidates.list[k].number = ++support->count;
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++) {
        asj_supporters old = support->side[side];
        search in = {.run = run, .side = side, .asked = &run->image[side]->l_junctions,
                     .others = &run->image[1 - side]->l_junctions, .before = before, .old = &old,
                     .room = most, .share = UINT32_MAX};
        support->side[side] = (asj_supporters){NULL, NULL, NULL};
        status = one_side(&in, &support->side[side]);
        supporters_free(&run->context->memory, &old);
    }
    return status;
}

asj_status asj_support_find(asj_match_run *run)
{
    return asj_support_find_within(run, MOST_SUPPORTERS);
}

void asj_support_free(asj_memory *memory, asj_support *support)
{
    for (int32_t side = 0; side < 2; side++)
        supporters_free(memory, &support->side[side]);
    support->count = 0;
}
