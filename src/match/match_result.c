/* SPDX-License-Identifier: BSD-2-Clause */
/* Chosen candidates as the caller sees them. */
#include "match_result.h"
#include "segments.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct result {
    asj_match_result shown; /* first, so that the caller's pointer is ours */
    asj_memory memory;
    asj_junction_match *matches, *rejected;
    asj_l_junction *l1, *l2;
    asj_place *places; /* of `count` matches */
    uint32_t count;
} result;

/* Where the aligned map puts the junction of image 1. When image 1 was the one that moved, the map takes its moved
 * location to the other's: q = p2 - A (p1 + move - p1). */
static void refined_location(const asj_candidate *c, const asj_l_junction *l2, double *x, double *y)
{
    *x = (double)l2->x + c->move2[0] - (c->map.to[0] * c->move1[0] + c->map.to[1] * c->move1[1]);
    *y = (double)l2->y + c->move2[1] - (c->map.to[2] * c->move1[0] + c->map.to[3] * c->move1[1]);
}

static void fill(const asj_match_run *run, const asj_choice *choice, asj_junction_match *m)
{
    const asj_candidate *c = &run->candidates.list[choice->candidate];
    const asj_l_junction *l1 = asj_match_run_l(run, c, 0), *l2 = asj_match_run_l(run, c, 1);
    const double *u1 = run->image[0]->l_junctions.direction + 4 * (size_t)c->i;
    const double *u2 = run->image[1]->l_junctions.direction + 4 * (size_t)c->j, *t = c->map.to;
    const asj_common_end a = asj_find_common_end(run, c, 0), b = asj_find_common_end(run, c, 1);
    double x, y;
    refined_location(c, l2, &x, &y);
    memset(m, 0, sizeof *m);
    m->l1 = c->i;
    m->l2 = c->j;
    m->junction1 = l1->junction;
    m->junction2 = l2->junction;
    const double affine[6] = {t[0], t[1], x - t[0] * (double)l1->x - t[1] * (double)l1->y,
                              t[2], t[3], y - t[2] * (double)l1->x - t[3] * (double)l1->y};
    memcpy(m->affine, affine, sizeof affine);
    m->x1 = l1->x;
    m->y1 = l1->y;
    m->x2 = (float)x;
    m->y2 = (float)y;
    m->ax1 = (float)((double)l1->x + a.length1 * u1[0]);
    m->ay1 = (float)((double)l1->y + a.length1 * u1[1]);
    m->bx1 = (float)((double)l1->x + b.length1 * u1[2]);
    m->by1 = (float)((double)l1->y + b.length1 * u1[3]);
    m->ax2 = (float)(x + a.length2 * u2[0]);
    m->ay2 = (float)(y + a.length2 * u2[1]);
    m->bx2 = (float)(x + b.length2 * u2[2]);
    m->by2 = (float)(y + b.length2 * u2[3]);
    m->end_a = a.kind;
    m->end_b = b.kind;
    m->distance = sqrtf(c->distance2);
    m->ratio = choice->ratio;
    m->similarity = c->similarity;
    m->support = c->support;
    m->probability = choice->probability;
}

static int by_distance(const void *left, const void *right)
{
    const asj_junction_match *p = left, *q = right;
    if (p->distance != q->distance)
        return p->distance < q->distance ? -1 : 1;
    if (p->l1 != q->l1)
        return p->l1 < q->l1 ? -1 : 1;
    return p->l2 < q->l2 ? -1 : p->l2 > q->l2;
}

static asj_l_junction *copy(asj_memory *memory, const asj_l_junctions *l_junctions)
{
    asj_l_junction *l = asj_allocate(memory, l_junctions->count, sizeof *l);
    if (l && l_junctions->count)
        memcpy(l, l_junctions->l, l_junctions->count * sizeof *l);
    return l;
}

/* Choices as matches, smallest distance first; NULL without memory. */
static asj_junction_match *list_of(const asj_match_run *run, asj_memory *memory, const asj_choices *choices)
{
    asj_junction_match *list = asj_allocate(memory, choices->count, sizeof *list);
    for (size_t n = 0; list && n < choices->count; n++)
        fill(run, &choices->list[n], &list[n]);
    if (list && choices->count > 1)
        qsort(list, choices->count, sizeof *list, by_distance);
    return list;
}

asj_match_result *asj_match_result_create(const asj_match_run *run)
{
    asj_memory memory = {.allocator = run->context->memory.allocator};
    const asj_l_junctions *in1 = &run->image[0]->l_junctions, *in2 = &run->image[1]->l_junctions;
    const size_t count = run->choices.count;
    result *r = asj_allocate_zero(&memory, 1, sizeof *r);
    if (!r)
        return NULL;
    r->memory = memory;
    r->matches = list_of(run, &memory, &run->choices);
    r->rejected = list_of(run, &memory, &run->rejected);
    r->l1 = copy(&memory, in1);
    r->l2 = copy(&memory, in2);
    asj_match_result *shown = &r->shown;
    r->places = asj_allocate(&memory, count, sizeof *r->places);
    if (!r->matches || !r->rejected || !r->l1 || !r->l2 || !r->places) {
        asj_match_result_free(&shown);
        return NULL;
    }
    r->count = (uint32_t)count;
    asj_places_sort(r->places, r->matches, r->count);
    shown->rejected = run->rejected.count ? r->rejected : NULL;
    shown->rejected_count = run->rejected.count;
    shown->matches = count ? r->matches : NULL;
    shown->match_count = (uint32_t)count;
    shown->l_junctions1 = in1->count ? r->l1 : NULL;
    shown->l_junctions2 = in2->count ? r->l2 : NULL;
    shown->l_junction_count1 = in1->count;
    shown->l_junction_count2 = in2->count;
    shown->geometry = run->geometry;
    shown->own = (uint64_t)(uintptr_t)r;
    return shown;
}

const asj_place *asj_match_result_places(const asj_match_result *shown, uint32_t *count)
{
    const result *r = (const result *)shown;
    if (shown->own != (uint64_t)(uintptr_t)r || shown->matches != r->matches || shown->match_count > r->count)
        return NULL;
    *count = r->count;
    return r->places;
}

void asj_match_result_free(asj_match_result **pointer)
{
    if (!pointer || !*pointer)
        return;
    result *r = (result *)*pointer;
    asj_memory memory = r->memory;
    asj_release(&memory, r->matches);
    asj_release(&memory, r->rejected);
    asj_release(&memory, r->l1);
    asj_release(&memory, r->l2);
    asj_release(&memory, r->places);
    asj_release(&memory, r);
    *pointer = NULL;
}
