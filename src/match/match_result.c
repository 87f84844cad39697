/* SPDX-License-Identifier: BSD-2-Clause */
/* Chosen candidates as the caller sees them. */
#include "match_result.h"
#include "common_direction.h"
#include "geometry_candidate.h"
#include "segments.h"
#include "core/sort.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define LEAST_ALONG 0.9 /* cosine of 26 degrees, which a branch seen from the match's location may be off its own direction: a
                         * location half as far off the line as the end is away says nothing of that */

/* All but the ends of the branches. */
static void fill(const asj_match_run *run, const asj_choice *choice, asj_junction_match *m)
{
    const asj_candidate *c = &run->candidates.list[choice->candidate];
    const asj_l_junction *l1 = asj_match_run_l(run, c, 0), *l2 = asj_match_run_l(run, c, 1);
    const double *t = c->map.to;
    double at[2];
    asj_match_run_partner(run, c, 0, at);
    memset(m, 0, sizeof *m);
    m->l1 = c->i;
    m->l2 = c->j;
    m->junction1 = l1->junction;
    m->junction2 = l2->junction;
    const double affine[6] = {t[0], t[1], at[0] - t[0] * (double)l1->x - t[1] * (double)l1->y,
                              t[2], t[3], at[1] - t[2] * (double)l1->x - t[3] * (double)l1->y};
    memcpy(m->affine, affine, sizeof affine);
    m->x1 = l1->x;
    m->y1 = l1->y;
    m->x2 = (float)at[0];
    m->y2 = (float)at[1];
    m->distance = sqrtf(c->distance2);
    m->ratio = choice->ratio;
    m->similarity = c->similarity;
    m->support = c->support;
    m->probability = choice->probability;
}

/* The end of branch a (0) or b (1) that both images show, at `from` (x, y) in image 1 and `to` in image 2. Returns its kind. */
static int32_t find_end(const asj_match_run *run, const asj_around *around, const asj_junction_match *m, int32_t branch,
                        float from[2], float to[2])
{
    const asj_l_junctions *in[2] = {&run->image[0]->l_junctions, &run->image[1]->l_junctions};
    const uint32_t l[2] = {m->l1, m->l2};
    const asj_lengths *lengths[2];
    asj_matched_branch line = {.match = m};
    for (int32_t side = 0; side < 2; side++) {
        const double *u = in[side]->direction + 4 * (size_t)l[side] + 2 * branch;
        lengths[side] = &in[side]->lengths[2 * (size_t)l[side] + (size_t)branch];
        line.x[side] = (double)in[side]->l[l[side]].x;
        line.y[side] = (double)in[side]->l[l[side]].y;
        line.ux[side] = u[0];
        line.uy[side] = u[1];
    }
    const asj_common_end end = asj_find_common_end(around, &line, lengths, run->options->end_tolerance);
    from[0] = (float)(line.x[0] + end.length[0] * line.ux[0]);
    from[1] = (float)(line.y[0] + end.length[0] * line.uy[0]);
    to[0] = (float)(line.x[1] + end.length[1] * line.ux[1]);
    to[1] = (float)(line.y[1] + end.length[1] * line.uy[1]);
    return end.kind;
}

/* Turns branch a (0) or b (1), which ends there, to the direction that both images and the map give it, seen from the match's
 * locations: in image 2 the aligned one, from where the end of the edge as detected is the end that is seen. */
static void turn(const asj_match_run *run, const asj_junction_match *m, int32_t branch, float from[2], float to[2])
{
    const double map[4] = {m->affine[0], m->affine[1], m->affine[3], m->affine[4]}, at1[2] = {(double)m->x1, (double)m->y1};
    const double at2[2] = {(double)m->x2, (double)m->y2};
    const double sd[2] = {(double)run->image[0]->l_junctions.direction_sd[2 * (size_t)m->l1 + (size_t)branch],
                          (double)run->image[1]->l_junctions.direction_sd[2 * (size_t)m->l2 + (size_t)branch]};
    double ends[2][2];
    for (int32_t k = 0; k < 2; k++) {
        ends[0][k] = (double)from[k] - at1[k];
        ends[1][k] = (double)to[k] - at2[k];
    }
    const double *u = run->image[1]->l_junctions.direction + 4 * (size_t)m->l2 + 2 * branch;
    if (ends[1][0] * u[0] + ends[1][1] * u[1] < LEAST_ALONG * sqrt(ends[1][0] * ends[1][0] + ends[1][1] * ends[1][1]) ||
        !asj_common_direction(map, sd, ends))
        return;
    for (int32_t k = 0; k < 2; k++) {
        from[k] = (float)(at1[k] + ends[0][k]);
        to[k] = (float)(at2[k] + ends[1][k]);
    }
}

static void fill_ends(const asj_match_run *run, const asj_around *around, asj_junction_match *m)
{
    float from[4], to[4];
    m->end_a = find_end(run, around, m, 0, from, to);
    m->end_b = find_end(run, around, m, 1, from + 2, to + 2);
    turn(run, m, 0, from, to);
    turn(run, m, 1, from + 2, to + 2);
    m->ax1 = from[0];
    m->ay1 = from[1];
    m->bx1 = from[2];
    m->by1 = from[3];
    m->ax2 = to[0];
    m->ay2 = to[1];
    m->bx2 = to[2];
    m->by2 = to[3];
}

static asj_l_junction *copy(asj_memory *memory, const asj_l_junctions *l_junctions)
{
    asj_l_junction *l = asj_allocate(memory, l_junctions->count, sizeof *l);
    if (l && l_junctions->count)
        memcpy(l, l_junctions->l, l_junctions->count * sizeof *l);
    return l;
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

static void sort(asj_junction_match *matches, size_t count)
{
    if (count > 1)
        asj_sort(matches, count, sizeof *matches, by_distance);
}

/* Choices as matches, smallest distance first; NULL without memory. */
static asj_junction_match *list_of(const asj_match_run *run, asj_memory *memory, const asj_choices *choices)
{
    asj_junction_match *list = asj_allocate(memory, choices->count, sizeof *list);
    for (size_t n = 0; list && n < choices->count; n++)
        fill(run, &choices->list[n], &list[n]);
    if (list)
        sort(list, choices->count);
    return list;
}

/* The ends of all, as the chosen matches see them. */
static asj_status find_ends(const asj_match_run *run, asj_own_result *r)
{
    const asj_around all = {r->matches, r->count, {r->places[0], r->places[1]}, r->count,
                            run->has_epipolar ? run->epipolar : NULL};
    const asj_around *around = run->options->neighbours > 0 ? &all : NULL;
    asj_watch watch;
    asj_watch_start(&watch, run->context, ASJ_STAGE_ASSIGN);
    for (uint32_t k = 0; k < r->count && !asj_watch_stops(&watch, NULL); k++)
        fill_ends(run, around, &r->matches[k]);
    for (size_t k = 0; k < run->rejected.count && !asj_watch_stops(&watch, NULL); k++)
        fill_ends(run, around, &r->rejected[k]);
    return asj_watch_end(&watch);
}

/* What the caller sees of it. */
static void show(const asj_match_run *run, asj_own_result *r)
{
    const asj_l_junctions *in1 = &run->image[0]->l_junctions, *in2 = &run->image[1]->l_junctions;
    asj_match_result *shown = &r->shown;
    shown->rejected = run->rejected.count ? r->rejected : NULL;
    shown->rejected_count = (uint32_t)run->rejected.count;
    shown->matches = r->count ? r->matches : NULL;
    shown->match_count = r->count;
    shown->l_junctions1 = in1->count ? r->l1 : NULL;
    shown->l_junctions2 = in2->count ? r->l2 : NULL;
    shown->l_junction_count1 = in1->count;
    shown->l_junction_count2 = in2->count;
    shown->geometry = run->geometry;
    shown->stretch[0] = shown->stretch[1] = 1;
    shown->origin = (uint64_t)(uintptr_t)r;
}

asj_status asj_match_result_create(const asj_match_run *run, asj_match_result **shown)
{
    asj_memory memory = {.allocator = run->context->memory.allocator};
    const size_t count = run->choices.count;
    asj_own_result *r = asj_allocate_zero(&memory, 1, sizeof *r);
    if (!r)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for a result");
    *shown = &r->shown;
    r->memory = memory;
    r->count = (uint32_t)count;
    r->matches = list_of(run, &memory, &run->choices);
    r->rejected = list_of(run, &memory, &run->rejected);
    r->l1 = copy(&memory, &run->image[0]->l_junctions);
    r->l2 = copy(&memory, &run->image[1]->l_junctions);
    for (int32_t side = 0; side < 2; side++)
        r->places[side] = asj_allocate(&memory, count, sizeof *r->places[side]);
    if (!r->matches || !r->rejected || !r->l1 || !r->l2 || !r->places[0] || !r->places[1]) {
        asj_match_result_free(shown);
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu matches", count);
    }
    for (int32_t side = 0; side < 2; side++)
        asj_places_sort(r->places[side], r->matches, r->count, side);
    r->end_tolerance = run->options->end_tolerance;
    r->farthest = asj_farthest_from_line(run);
    r->has_epipolar = run->has_epipolar;
    memcpy(r->epipolar, run->epipolar, sizeof r->epipolar);
    r->hopeless = run->hopeless;
    r->is_known = run->geometry.status == ASJ_GEOMETRY_ACCEPTED;
    if (r->is_known)
        r->known = (asj_known_geometry){run->judge, {{1, 1}, {1, 1}}, run->lines_hold};
    const asj_status status = find_ends(run, r);
    if (status == ASJ_OK)
        show(run, r);
    else
        asj_match_result_free(shown);
    return status;
}

void asj_match_result_sort(asj_own_result *r)
{
    sort(r->matches, r->count);
    sort(r->rejected, r->shown.rejected_count);
    for (int32_t side = 0; side < 2; side++)
        asj_places_sort(r->places[side], r->matches, r->count, side);
}

/* One that asj_match_result_create() has made, still where it was. */
static int is_own(const asj_match_result *shown)
{
    return shown->origin == (uint64_t)(uintptr_t)shown;
}

asj_around asj_match_result_around(const asj_match_result *shown)
{
    const asj_own_result *r = (const asj_own_result *)shown;
    asj_around around = {shown->matches, shown->match_count, {NULL, NULL}, 0, NULL};
    if (is_own(shown) && shown->matches == r->matches && shown->match_count <= r->count) {
        around.places[0] = r->places[0];
        around.places[1] = r->places[1];
        around.place_count = r->count;
        around.epipolar = r->has_epipolar ? r->epipolar : NULL;
    }
    return around;
}

const asj_known_geometry *asj_match_result_geometry(const asj_match_result *shown)
{
    const asj_own_result *r = (const asj_own_result *)shown;
    return r->is_known ? &r->known : NULL;
}

double asj_match_result_end_tolerance(const asj_match_result *shown)
{
    asj_match_options options;
    if (is_own(shown))
        return ((const asj_own_result *)shown)->end_tolerance;
    asj_match_options_init(&options);
    return options.end_tolerance;
}

double asj_match_result_farthest(const asj_match_result *shown)
{
    return ((const asj_own_result *)shown)->farthest;
}

int32_t asj_match_result_is_hopeless(const asj_match_result *shown)
{
    return ((const asj_own_result *)shown)->hopeless;
}

void asj_match_result_free(asj_match_result **pointer)
{
    if (!pointer || !*pointer)
        return;
    asj_own_result *r = (asj_own_result *)*pointer;
    asj_memory memory = r->memory;
    asj_release(&memory, r->matches);
    asj_release(&memory, r->rejected);
    asj_release(&memory, r->l1);
    asj_release(&memory, r->l2);
    asj_release(&memory, r->places[0]);
    asj_release(&memory, r->places[1]);
    asj_release(&memory, r);
    *pointer = NULL;
}
