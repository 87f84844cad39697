/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_find_segments(): the straight edges of an image, each once.
 *
 * An edge has a branch from each of its ends, and one from every corner on it (a window frame where bars meet it, a row of tiles).
 * Branches are taken one after the other, the longest first; one that is of the same edge as one before joins it (one_edge.c).
 * Where ends have moved they may reach others, so all is done again until none has. Before all that the two branches of an edge of
 * the graph (asj_edge) that end at each other's junctions are one: side by side with another edge, each might join that instead.
 * The paper has no such step: its results are branches. */
#include "one_edge.h"
#include "segment_cells.h"
#include "core/context.h"
#include "core/most_junctions.h"
#include "core/watch.h"

#include <asj/segments.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What stands behind the public struct. */
typedef struct own_list {
    asj_segment_list list; /* first: the public pointer is this one */
    asj_memory memory;     /* the allocator; lists outlive their context */
    asj_segment *segments;
    uint32_t *of_branches;
} own_list;

typedef struct work {
    asj_context *context;
    const asj_junction *junctions;
    const asj_edge *edges;
    size_t junction_count, edge_count;
    asj_watch watch;
    asj_segment *segments;
    uint32_t count;
    uint32_t *joined;      /* for each branch that of the segment which its own has joined, itself while it has not, or
                            * ASJ_NO_SEGMENT: where this ends is the segment's branch */
    uint32_t *edge_of;     /* for each branch its edge, + 1; 0 = none */
    uint32_t *asked;       /* for each segment the last one that was compared with it, + 1 */
    asj_segment_cells cells;
} work;

static double length2_of(const asj_segment *s)
{
    const double dx = (double)s->x2 - (double)s->x1, dy = (double)s->y2 - (double)s->y1;
    return dx * dx + dy * dy;
}

static size_t number_of(uint32_t junction, uint16_t branch)
{
    return (size_t)junction * ASJ_MAX_BRANCHES + branch;
}

static size_t branch_of(const asj_segment *s)
{
    return number_of(s->junction, s->branch);
}

static int by_length(const void *a, const void *b)
{
    const asj_segment *p = a, *q = b;
    const double one = length2_of(p), other = length2_of(q);
    if (one > other || one < other)
        return one > other ? -1 : 1;
    return branch_of(p) < branch_of(q) ? -1 : branch_of(p) > branch_of(q);
}

/* ---- branches ---- */

static asj_segment segment_of(const asj_junction *junction, uint32_t index, int32_t b)
{
    const asj_branch *branch = &junction->branches[b];
    const double length = (double)branch->length, angle = (double)branch->angle;
    asj_segment s;
    memset(&s, 0, sizeof s);
    s.x1 = junction->x;
    s.y1 = junction->y;
    s.x2 = (float)((double)junction->x + length * cos(angle));
    s.y2 = (float)((double)junction->y + length * sin(angle));
    s.sd1 = junction->location_sd;
    s.sd2 = branch->length_sd;
    s.end1 = ASJ_BRANCH_END_JUNCTION;
    s.end2 = branch->end;
    s.junction1 = s.junction = index;
    s.junction2 = ASJ_NO_JUNCTION;
    s.log10_nfa = branch->log10_nfa;
    s.branch = (uint16_t)b;
    s.branch_count = 1;
    return s;
}

static int is_sound(const asj_segment *s, const asj_branch *branch)
{
    return branch->length >= 0 && isfinite(s->x2) && isfinite(s->y2) && isfinite(s->sd1) && isfinite(s->sd2) &&
           isfinite(s->log10_nfa);
}

/* Does the branch go from its junction to the other one, and end there? */
static int ends_at(const asj_junction *junction, uint16_t branch, const asj_junction *other)
{
    const double dx = (double)other->x - (double)junction->x, dy = (double)other->y - (double)junction->y;
    const double distance = hypot(dx, dy), length = (double)junction->branches[branch].length;
    const double angle = (double)junction->branches[branch].angle;
    return length > 0 && fabs(length - distance) <= asj_same_end(distance) &&
           dx * cos(angle) + dy * sin(angle) > ASJ_STRAIGHT * distance;
}

static int has_branch(const work *w, uint32_t junction, uint16_t branch)
{
    return junction < w->junction_count && branch < ASJ_MAX_BRANCHES && branch < w->junctions[junction].branch_count;
}

/* The edges whose two branches end at each other's junctions. */
static asj_status take_edges(work *w)
{
    memset(w->edge_of, 0, w->junction_count * ASJ_MAX_BRANCHES * sizeof *w->edge_of);
    for (size_t k = 0; k < w->edge_count; k++) {
        const asj_edge *e = &w->edges[k];
        if (!has_branch(w, e->junction_a, e->branch_a) || !has_branch(w, e->junction_b, e->branch_b))
            return asj_fail(w->context, ASJ_ERROR_ARGUMENT, "edge %zu is of a branch that is not there", k);
        const asj_junction *a = &w->junctions[e->junction_a], *b = &w->junctions[e->junction_b];
        uint32_t *of_a = &w->edge_of[number_of(e->junction_a, e->branch_a)];
        uint32_t *of_b = &w->edge_of[number_of(e->junction_b, e->branch_b)];
        if (!*of_a && !*of_b && ends_at(a, e->branch_a, b) && ends_at(b, e->branch_b, a))
            *of_a = *of_b = (uint32_t)k + 1;
    }
    return ASJ_OK;
}

/* The segment of a branch is that of its whole edge. */
static void reach_other_end(asj_segment *s, const asj_edge *e, const asj_junction *junctions)
{
    const asj_junction *b = &junctions[e->junction_b];
    s->x2 = b->x;
    s->y2 = b->y;
    s->sd2 = b->location_sd;
    s->end2 = ASJ_BRANCH_END_JUNCTION;
    s->junction2 = e->junction_b;
    s->log10_nfa = fminf(s->log10_nfa, b->branches[e->branch_b].log10_nfa);
    s->branch_count = 2;
}

/* A branch, or the edge that it is the first branch of; the second belongs to the first. What has no length is left out. */
static asj_status take_branch(work *w, uint32_t j, int32_t b)
{
    asj_segment s = segment_of(&w->junctions[j], j, b);
    const size_t number = branch_of(&s);
    const asj_edge *edge = w->edge_of[number] ? &w->edges[w->edge_of[number] - 1] : NULL;
    const size_t first = edge ? number_of(edge->junction_a, edge->branch_a) : number;
    if (!is_sound(&s, &w->junctions[j].branches[b]))
        return asj_fail(w->context, ASJ_ERROR_ARGUMENT, "branch %d of junction %lu cannot be", (int)b, (unsigned long)j);
    if (!edge && !(length2_of(&s) > 0))
        return ASJ_OK;
    w->joined[number] = (uint32_t)first;
    if (number != first)
        return ASJ_OK;
    if (edge)
        reach_other_end(&s, edge, w->junctions);
    w->segments[w->count++] = s;
    return ASJ_OK;
}

/* In the order of the junctions. */
static asj_status take_branches(work *w)
{
    asj_status status = ASJ_OK;
    for (size_t j = 0; j < w->junction_count && status == ASJ_OK; j++) {
        const int32_t branches = w->junctions[j].branch_count;
        if (branches < 0 || branches > ASJ_MAX_BRANCHES)
            return asj_fail(w->context, ASJ_ERROR_ARGUMENT, "junction %zu has %d branches", j, (int)branches);
        if (!isfinite(w->junctions[j].x) || !isfinite(w->junctions[j].y))
            return asj_fail(w->context, ASJ_ERROR_ARGUMENT, "junction %zu is nowhere", j);
        for (int32_t b = 0; b < branches && status == ASJ_OK; b++)
            status = take_branch(w, (uint32_t)j, b);
    }
    return status;
}

/* ---- all of them ---- */

/* The longest before segment `number` that it is of one edge with. */
typedef struct partner {
    uint32_t best; /* so far; at first one beyond all */
    asj_course course;
} partner;

static void look_in_cell(work *w, const asj_segment *s, uint32_t number, uint32_t first, partner *p)
{
    for (uint32_t at = first; at; at = w->cells.entries[at].next) {
        const uint32_t k = w->cells.entries[at].segment;
        asj_course course;
        if (k >= p->best || w->asked[k] == number + 1)
            continue;
        w->asked[k] = number + 1;
        if (asj_is_one_edge(&w->segments[k], s, &course))
            *p = (partner){k, course};
    }
}

static partner find_longer(work *w, const asj_segment *s, uint32_t number, uint32_t kept)
{
    const asj_end_point ends[2] = {asj_segment_end(s, 0), asj_segment_end(s, 1)};
    partner p = {.best = kept};
    int32_t first, last;
    asj_segment_cells_rows(&w->cells, ends, 0, &first, &last);
    for (int32_t row = first; row <= last; row++) {
        const asj_cell_run run = asj_segment_cells_run(&w->cells, ends, 0, row);
        for (int32_t column = run.first; column <= run.last; column++)
            look_in_cell(w, s, number, w->cells.first[(size_t)row * (size_t)w->cells.columns + (size_t)column], &p);
    }
    return p;
}

static int32_t add_to_cells(work *w, uint32_t k)
{
    const asj_end_point ends[2] = {asj_segment_end(&w->segments[k], 0), asj_segment_end(&w->segments[k], 1)};
    return asj_segment_cells_add(&w->context->memory, &w->cells, ends, k);
}

/* One after the other, the longest first, into those before. */
static asj_status join_once(work *w, int32_t *moved)
{
    uint32_t kept = 0;
    *moved = 0;
    memset(w->asked, 0, w->count * sizeof *w->asked);
    asj_segment_cells_clear(&w->cells);
    for (uint32_t i = 0; i < w->count && !asj_watch_stops(&w->watch, NULL); i++) {
        const asj_segment s = w->segments[i];
        const partner p = find_longer(w, &s, i, kept);
        const uint32_t k = p.best;
        int32_t changed = k == kept;
        if (k < kept) {
            changed = asj_become_one_edge(w->junctions, &w->segments[k], &s, &p.course);
            *moved |= changed;
            w->joined[branch_of(&s)] = (uint32_t)branch_of(&w->segments[k]);
        } else {
            w->segments[kept++] = s;
        }
        if (changed && !add_to_cells(w, k))
            return asj_fail(w->context, ASJ_ERROR_MEMORY, "no memory for the segments of %lu branches", (unsigned long)w->count);
    }
    w->count = kept;
    return asj_watch_end(&w->watch);
}

/* Of two or more. */
static int32_t make_cells(work *w)
{
    double left = HUGE_VAL, top = HUGE_VAL, right = -HUGE_VAL, bottom = -HUGE_VAL;
    for (uint32_t k = 0; k < 2 * w->count; k++) {
        const asj_end_point p = asj_segment_end(&w->segments[k / 2], (int32_t)(k % 2));
        left = fmin(left, p.x), right = fmax(right, p.x);
        top = fmin(top, p.y), bottom = fmax(bottom, p.y);
    }
    return asj_segment_cells_make(&w->context->memory, left, top, right, bottom, &w->cells);
}

static asj_status join_all(work *w)
{
    int32_t moved = 1;
    asj_status status = ASJ_OK;
    if (w->count < 2)
        return ASJ_OK;
    if (!make_cells(w))
        return asj_fail(w->context, ASJ_ERROR_MEMORY, "no memory for the segments of %lu branches", (unsigned long)w->count);
    while (moved && status == ASJ_OK) {
        qsort(w->segments, w->count, sizeof *w->segments, by_length);
        status = join_once(w, &moved);
    }
    return status;
}

/* ---- the list ---- */

static asj_status make_list(work *w, own_list **made)
{
    const size_t branches = w->junction_count * ASJ_MAX_BRANCHES;
    asj_memory memory = {.allocator = w->context->memory.allocator};
    own_list *l = asj_allocate_zero(&memory, 1, sizeof *l);
    uint32_t *of_branches = asj_allocate(&memory, branches, sizeof *of_branches);
    asj_segment *segments = asj_allocate(&memory, w->count, sizeof *segments);
    if (!l || !of_branches || !segments) {
        asj_release(&memory, l);
        asj_release(&memory, of_branches);
        asj_release(&memory, segments);
        return asj_fail(w->context, ASJ_ERROR_MEMORY, "no memory for a list of %lu segments", (unsigned long)w->count);
    }
    memcpy(segments, w->segments, w->count * sizeof *segments);
    for (uint32_t k = 0; k < w->count; k++)
        of_branches[branch_of(&segments[k])] = k;
    for (size_t b = 0; b < branches; b++) {
        uint32_t root = w->joined[b];
        while (root != ASJ_NO_SEGMENT && w->joined[root] != root)
            root = w->joined[root];
        of_branches[b] = root == ASJ_NO_SEGMENT ? ASJ_NO_SEGMENT : of_branches[root];
    }
    l->memory = memory;
    l->segments = segments;
    l->of_branches = of_branches;
    l->list = (asj_segment_list){segments, of_branches, w->count, (uint32_t)w->junction_count, {0, 0}};
    *made = l;
    return ASJ_OK;
}

static asj_status work_on(work *w, own_list **made)
{
    asj_memory *memory = &w->context->memory;
    const size_t branches = w->junction_count * ASJ_MAX_BRANCHES;
    w->segments = asj_allocate(memory, branches, sizeof *w->segments);
    w->joined = asj_allocate(memory, branches, sizeof *w->joined);
    w->edge_of = asj_allocate(memory, branches, sizeof *w->edge_of);
    w->asked = asj_allocate(memory, branches, sizeof *w->asked);
    if (!w->segments || !w->joined || !w->edge_of || !w->asked)
        return asj_fail(w->context, ASJ_ERROR_MEMORY, "no memory for the branches of %zu junctions", w->junction_count);
    memset(w->joined, 0xff, branches * sizeof *w->joined);
    asj_status status = take_edges(w);
    if (status == ASJ_OK)
        status = take_branches(w);
    if (status == ASJ_OK)
        status = join_all(w);
    return status == ASJ_OK ? make_list(w, made) : status;
}

asj_status asj_find_segments(asj_context *context, const asj_junction *junctions, size_t count, const asj_edge *edges,
                             size_t edge_count, asj_segment_list **list)
{
    if (list)
        *list = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    context->progress = 0; /* a call of its own */
    if (!list || (!junctions && count > 0) || (!edges && edge_count > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the junctions, the edges or the list is NULL");
    if (count > ASJ_MOST_JUNCTIONS || edge_count >= UINT32_MAX)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%zu junctions or %zu edges are too many", count, edge_count);
    own_list *made = NULL;
    work w = {.context = context, .junctions = junctions, .edges = edges, .junction_count = count, .edge_count = edge_count};
    asj_watch_start(&w.watch, context, ASJ_STAGE_DECOMPOSE);
    const asj_status status = work_on(&w, &made);
    asj_release(&context->memory, w.segments);
    asj_release(&context->memory, w.joined);
    asj_release(&context->memory, w.edge_of);
    asj_release(&context->memory, w.asked);
    asj_segment_cells_free(&context->memory, &w.cells);
    if (status == ASJ_OK)
        *list = &made->list;
    return status;
}

void asj_segment_list_free(asj_segment_list **pointer)
{
    if (!pointer || !*pointer)
        return;
    own_list *l = (own_list *)*pointer;
    asj_memory memory = l->memory;
    asj_release(&memory, l->segments);
    asj_release(&memory, l->of_branches);
    asj_release(&memory, l);
    *pointer = NULL;
}
