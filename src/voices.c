/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, who agrees with whom: every candidate listens to the candidates at the nearest places of image 1 and of image 2.
 *
 * Millions of pairs are looked at, a few in a hundred may agree (asj_look_at()), fewer do, and only these are stored. When the
 * guided pass brings new candidates, those heard before only listen to the new ones. */
#include "voices.h"
#include "agreement.h"
#include "ops.h"

#include <string.h>

#define ROOM 0x40000 /* voices of a block of candidates before it is known how many they hear: 2 MB */

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

/* --- speakers --------------------------------------------------------------------------------------------------------------- */

typedef struct speakers {
    asj_place_index index;
    asj_spots spots; /* in its order */
    float *block;
} speakers;

static asj_status speakers_create(asj_context *context, const asj_corners *corners, const asj_corners *others,
                                  const asj_candidates *candidates, int32_t side, uint32_t least_number, speakers *s)
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

static void speakers_free(asj_memory *memory, speakers *s)
{
    asj_place_index_free(memory, &s->index);
    asj_release(memory, s->block);
}

/* --- listening -------------------------------------------------------------------------------------------------------------- */

/* All that listeners share. */
typedef struct hall {
    const asj_match_options *options;
    const asj_ops *ops;
    const asj_corners *corners1, *corners2, *corners, *others; /* the image whose neighbour places are asked, the other one */
    const asj_candidates *candidates;
    int32_t side;
    uint32_t before;        /* candidates that were heard before have such a number at most */
    const asj_hearing *old; /* what they heard */
    speakers all, fresh;
} hall;

/* A candidate that listens. */
typedef struct listener {
    const asj_candidate *c;
    uint32_t mine, other;   /* its L-junction in the image asked, and in the other */
    double x, y;            /* px: where it stands in the image asked */
    const double *map;      /* from there to the other */
    asj_look look;          /* without what depends on the place */
} listener;

static listener listener_of(const hall *h, const asj_candidate *c)
{
    listener n = {.c = c, .mine = h->side == 1 ? c->i : c->j, .other = h->side == 1 ? c->j : c->i};
    const double *u = h->others->direction + 4 * (size_t)n.other, tolerance = h->options->neighbour_tolerance;
    n.x = (double)h->corners->l[n.mine].x;
    n.y = (double)h->corners->l[n.mine].y;
    n.map = h->side == 1 ? c->map.to : c->map.from;
    n.look = (asj_look){.x = h->others->l[n.other].x, .y = h->others->l[n.other].y,
                        .slope = (float)(ASJ_LOOK_SLOPE * tolerance * tolerance),
                        .branch = {{(float)u[0], (float)u[1]}, {(float)u[2], (float)u[3]}}};
    return n;
}

/* Agreement in 1/ASJ_VOICE_ONE. (x, y) is the way in the image asked, (ex, ey) in the other. */
static uint16_t weigh(const hall *h, const listener *n, const asj_candidate *d, double x, double y, double ex, double ey)
{
    const asj_way way = h->side == 1 ? (asj_way){x, y, ex, ey} : (asj_way){ex, ey, x, y};
    const float w = asj_surface_agreement(h->options, n->c, d, &way);
    const float v = asj_edges_through(h->others, n->other, n->look.edges, ex, ey)
        ? asj_edge_agreement(h->options, h->corners1, h->corners2, n->c, d, &way) : 0;
    return (uint16_t)((v > w ? v : w) * ASJ_VOICE_ONE);
}

/* What is heard from a place, the listener's neighbour of this number. */
static uint32_t hear_place(const hall *h, const speakers *s, listener *n, uint32_t place, uint32_t neighbour, asj_voice *voices)
{
    const double x = h->corners->place_x[place] - n->x, y = h->corners->place_y[place] - n->y;
    const uint32_t end = s->index.start[place + 1];
    uint32_t count = 0;
    n->look.way_x = (float)x;
    n->look.way_y = (float)y;
    n->look.px = (float)(n->map[0] * x + n->map[1] * y);
    n->look.py = (float)(n->map[2] * x + n->map[3] * y);
    n->look.edges = asj_edges_through(h->corners, n->mine, h->others->stem[n->other] ? 0 : 3, x, y);
    for (uint32_t m = s->index.start[place]; m < end; m += ASJ_LOOK_COUNT) {
        uint64_t seen = h->ops->look_at(&n->look, &s->spots, m, end - m < ASJ_LOOK_COUNT ? end - m : ASJ_LOOK_COUNT);
        for (uint32_t at = m; seen; at++, seen >>= 1) {
            if (!(seen & 1))
                continue;
            const asj_candidate *d = &h->candidates->list[s->index.order[at]];
            const double ex = (double)s->spots.x[at] - (double)n->look.x, ey = (double)s->spots.y[at] - (double)n->look.y;
            const uint16_t weight = weigh(h, n, d, x, y, ex, ey);
            if (weight)
                voices[count++] = (asj_voice){d->number - 1, weight, (uint16_t)neighbour};
        }
    }
    return count;
}

/* All that c hears; returns how many they are. */
static uint32_t hear(const hall *h, const asj_candidate *c, asj_voice *voices)
{
    const uint32_t place = place_of(h->corners, c, h->side);
    const uint32_t *neighbour = h->corners->neighbour + (size_t)place * h->corners->neighbour_limit;
    const int32_t known = c->number <= h->before;
    const speakers *s = known ? &h->fresh : &h->all;
    const asj_voice *old = known ? h->old->voices + h->old->offset[c->number - 1] : NULL;
    const asj_voice *end = known ? old + h->old->heard[c->number - 1] : NULL;
    listener self = listener_of(h, c);
    uint32_t count = 0;
    for (uint32_t n = 0; n < h->corners->neighbour_count[place]; n++) {
        while (old < end && old->place == n)
            voices[count++] = *old++;
        if (s->index.start[neighbour[n]] < s->index.start[neighbour[n] + 1])
            count += hear_place(h, s, &self, neighbour[n], n, voices + count);
    }
    return count;
}

/* --- blocks of candidates --------------------------------------------------------------------------------------------------- */

/* How many candidates can be heard from each place. */
static void find_rooms(const hall *h, uint32_t *rooms, size_t *largest)
{
    const asj_corners *corners = h->corners;
    for (uint32_t p = 0; p < corners->place_count; p++) {
        const uint32_t *neighbour = corners->neighbour + (size_t)p * corners->neighbour_limit;
        rooms[p] = 0;
        for (uint32_t n = 0; n < corners->neighbour_count[p]; n++)
            rooms[p] += h->all.index.start[neighbour[n] + 1] - h->all.index.start[neighbour[n]];
        *largest = rooms[p] > *largest ? rooms[p] : *largest;
    }
}

/* Room for a block of candidates to listen in: those from `first` on. Returns its end. */
static size_t seat(const hall *h, const uint32_t *rooms, size_t first, size_t capacity, size_t *seats)
{
    size_t end = first;
    for (size_t used = 0; end < h->candidates->count; end++) {
        const size_t room = rooms[place_of(h->corners, &h->candidates->list[end], h->side)];
        if (used + room > capacity)
            break;
        seats[end] = used;
        used += room;
    }
    return end;
}

/* Appends what candidates first .. end - 1 heard. */
static asj_status keep(asj_context *context, const hall *h, size_t first, size_t end, const asj_voice *scratch, const size_t *seats,
                       asj_hearing *hearing, size_t *used, size_t *capacity)
{
    size_t total = *used + 1; /* never NULL */
    for (size_t k = first; k < end; k++)
        total += hearing->heard[h->candidates->list[k].number - 1];
    void *block = hearing->voices;
    const asj_status status = asj_grow(&context->memory, &block, capacity, total, sizeof *hearing->voices, *used);
    hearing->voices = block;
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for %zu pairs of candidates", total);
    for (size_t k = first; k < end; k++) {
        const uint32_t n = h->candidates->list[k].number - 1;
        memcpy(hearing->voices + *used, scratch + seats[k], hearing->heard[n] * sizeof *scratch);
        hearing->offset[n] = *used;
        *used += hearing->heard[n];
    }
    return ASJ_OK;
}

static asj_status listen(asj_context *context, const hall *h, uint32_t *rooms, size_t *seats, asj_hearing *hearing)
{
    size_t capacity = ROOM, used = 0, kept = 0;
    find_rooms(h, rooms, &capacity);
    asj_voice *scratch = asj_allocate(&context->memory, capacity, sizeof *scratch);
    asj_status status = scratch ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu pairs of candidates", capacity);
    for (size_t first = 0, end; first < h->candidates->count && status == ASJ_OK; first = end) {
        end = seat(h, rooms, first, capacity, seats);
#pragma omp parallel for num_threads(context->threads) schedule(dynamic, 16)
        for (int64_t k = (int64_t)first; k < (int64_t)end; k++) {
            const asj_candidate *c = &h->candidates->list[k];
            hearing->heard[c->number - 1] = hear(h, c, scratch + seats[k]);
        }
        status = keep(context, h, first, end, scratch, seats, hearing, &used, &kept);
    }
    asj_release(&context->memory, scratch);
    return status;
}

static asj_status one_side(asj_context *context, hall *h, asj_hearing *hearing)
{
    asj_memory *memory = &context->memory;
    const size_t count = h->candidates->count;
    uint32_t *rooms = asj_allocate(memory, h->corners->place_count, sizeof *rooms);
    size_t *seats = asj_allocate(memory, count, sizeof *seats);
    hearing->offset = asj_allocate(memory, count, sizeof *hearing->offset);
    hearing->heard = asj_allocate(memory, count, sizeof *hearing->heard);
    asj_status status = rooms && seats && hearing->offset && hearing->heard
        ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    if (status == ASJ_OK)
        status = speakers_create(context, h->corners, h->others, h->candidates, h->side, 0, &h->all);
    if (status == ASJ_OK)
        status = speakers_create(context, h->corners, h->others, h->candidates, h->side, h->before + 1, &h->fresh);
    if (status == ASJ_OK)
        status = listen(context, h, rooms, seats, hearing);
    speakers_free(memory, &h->all);
    speakers_free(memory, &h->fresh);
    asj_release(memory, rooms);
    asj_release(memory, seats);
    return status;
}

static void hearing_free(asj_memory *memory, asj_hearing *hearing)
{
    asj_release(memory, hearing->offset);
    asj_release(memory, hearing->heard);
    asj_release(memory, hearing->voices);
    *hearing = (asj_hearing){NULL, NULL, NULL};
}

asj_status asj_voices_extend(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                             asj_candidates *candidates, asj_voices *voices)
{
    const asj_corners *corners[2] = {&view1->corners, &view2->corners};
    const uint32_t before = voices->count;
    asj_status status = ASJ_OK;
    for (size_t k = 0; k < candidates->count; k++)
        if (candidates->list[k].number == 0)
            candidates->list[k].number = ++voices->count;
    for (int32_t s = 0; s < 2 && status == ASJ_OK; s++) {
        asj_hearing old = voices->side[s];
        hall h = {.options = options, .ops = context->ops, .corners1 = corners[0], .corners2 = corners[1], .corners = corners[s],
                  .others = corners[1 - s], .candidates = candidates, .side = s + 1, .before = before, .old = &old};
        voices->side[s] = (asj_hearing){NULL, NULL, NULL};
        status = one_side(context, &h, &voices->side[s]);
        hearing_free(&context->memory, &old);
    }
    return status;
}

void asj_voices_free(asj_memory *memory, asj_voices *voices)
{
    for (int32_t s = 0; s < 2; s++)
        hearing_free(memory, &voices->side[s]);
    voices->count = 0;
}
