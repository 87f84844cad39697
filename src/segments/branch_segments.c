/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_find_segments(): the straight edges of an image, each once.
 *
 * Every branch is a segment, and those of one edge are joined (join_segments.c). Before that the two branches of an edge of the
 * graph (asj_edge) that end at each other's junctions are one: side by side with another edge, each might join that instead. The
 * paper has no such step: its results are branches. */
#include "join_segments.h"
#include "one_edge.h"
#include "core/most_junctions.h"
#include "core/reserved.h"

#include <asj/segments.h>

#include <math.h>
#include <string.h>

/* What stands behind the public struct. */
typedef struct own_list {
    asj_segment_list list; /* first: the public pointer is this one */
    asj_memory memory;     /* the allocator; lists outlive their context */
    asj_segment *segments;
    uint32_t *of_branches;
} own_list;

typedef struct work {
    asj_joining joining;
    const asj_edge *edges;
    size_t junction_count, edge_count;
    uint32_t *edge_of; /* for each branch its edge, + 1; 0 = none */
} work;

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
    return s;
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
    return junction < w->junction_count && branch < ASJ_MAX_BRANCHES && branch < w->joining.junctions[junction].branch_count;
}

/* The edges whose two branches end at each other's junctions. */
static asj_status take_edges(work *w)
{
    memset(w->edge_of, 0, w->junction_count * ASJ_MAX_BRANCHES * sizeof *w->edge_of);
    for (size_t k = 0; k < w->edge_count; k++) {
        const asj_edge *e = &w->edges[k];
        if (!has_branch(w, e->junction_a, e->branch_a) || !has_branch(w, e->junction_b, e->branch_b))
            return asj_fail(w->joining.context, ASJ_ERROR_ARGUMENT, "edge %zu is of a branch that is not there", k);
        if (!asj_is_zero(e->reserved, sizeof e->reserved))
            return asj_fail(w->joining.context, ASJ_ERROR_OPTION,
                            "a reserved field of edge %zu is not zero: never cleared, or of a later version", k);
        const asj_junction *a = &w->joining.junctions[e->junction_a], *b = &w->joining.junctions[e->junction_b];
        uint32_t *of_a = &w->edge_of[asj_branch_number(e->junction_a, e->branch_a)];
        uint32_t *of_b = &w->edge_of[asj_branch_number(e->junction_b, e->branch_b)];
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
}

/* A branch, or the edge that it is the first branch of; the second belongs to the first. What has no length is left out. */
static void take_branch(work *w, uint32_t j, int32_t b)
{
    asj_segment s = segment_of(&w->joining.junctions[j], j, b);
    const size_t number = asj_branch_of(&s);
    const asj_edge *edge = w->edge_of[number] ? &w->edges[w->edge_of[number] - 1] : NULL;
    const size_t first = edge ? asj_branch_number(edge->junction_a, edge->branch_a) : number;
    if (!edge && !(asj_segment_length2(&s) > 0))
        return;
    w->joining.joined[number] = (uint32_t)first;
    if (number != first)
        return;
    if (edge)
        reach_other_end(&s, edge, w->joining.junctions);
    w->joining.segments[w->joining.count++] = s;
}

/* In the order of the junctions. */
static void take_branches(work *w)
{
    for (size_t j = 0; j < w->junction_count; j++)
        for (int32_t b = 0; b < w->joining.junctions[j].branch_count; b++)
            take_branch(w, (uint32_t)j, b);
}

/* ---- the list ---- */

/* px from a point to the nearest of a segment, squared. */
static double far_from(const asj_segment *s, double x, double y)
{
    const asj_end_point a = asj_segment_end(s, 0), b = asj_segment_end(s, 1);
    const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    const double along = length2 > 0 ? fmin(1, fmax(0, ((x - a.x) * dx + (y - a.y) * dy) / length2)) : 0;
    const double off_x = a.x + along * dx - x, off_y = a.y + along * dy - y;
    return off_x * off_x + off_y * off_y;
}

/* Of the halves of an edge that bends a branch is a part of that which its middle is nearest to; that which goes by it keeps it.
 * From half to half, since what goes on there may have been cut, too. */
static uint32_t nearest_half(const asj_joining *w, size_t number, const asj_segment *segments, const uint32_t *of_branches)
{
    const asj_junction *junction = &w->junctions[number / ASJ_MAX_BRANCHES];
    const asj_branch *branch = &junction->branches[number % ASJ_MAX_BRANCHES];
    const double half = 0.5 * (double)branch->length, angle = (double)branch->angle;
    const double x = (double)junction->x + half * cos(angle), y = (double)junction->y + half * sin(angle);
    const uint32_t root = asj_joined_branch(w, number);
    uint32_t nearest = of_branches[root], at = ASJ_NO_SEGMENT;
    double least = far_from(&segments[nearest], x, y);
    while (number != root && at != nearest) {
        at = nearest;
        for (uint32_t cut = w->first_cut[asj_branch_of(&segments[at])]; cut != ASJ_NO_SEGMENT; cut = w->cuts[cut].next) {
            const uint32_t other = of_branches[asj_joined_branch(w, w->cuts[cut].other)];
            const double far = far_from(&segments[other], x, y);
            nearest = far < least ? other : nearest;
            least = fmin(far, least);
        }
    }
    return nearest;
}

/* Which segment each branch is a part of, and of how many branches each segment is. */
static void tell_branches(const work *w, asj_segment *segments, uint32_t *of_branches)
{
    const asj_joining *j = &w->joining;
    for (uint32_t k = 0; k < j->count; k++) {
        of_branches[asj_branch_of(&segments[k])] = k;
        segments[k].branch_count = 0;
    }
    for (size_t b = 0; b < w->junction_count * ASJ_MAX_BRANCHES; b++) {
        const uint32_t root = asj_joined_branch(j, b);
        const uint32_t k = root == ASJ_NO_SEGMENT ? ASJ_NO_SEGMENT : nearest_half(j, b, segments, of_branches);
        of_branches[b] = k;
        if (k != ASJ_NO_SEGMENT && segments[k].branch_count < UINT16_MAX)
            segments[k].branch_count++;
    }
}

static asj_status make_list(work *w, own_list **made)
{
    const size_t branches = w->junction_count * ASJ_MAX_BRANCHES;
    asj_memory memory = {.allocator = w->joining.context->memory.allocator};
    own_list *l = asj_allocate_zero(&memory, 1, sizeof *l);
    uint32_t *of_branches = asj_allocate(&memory, branches, sizeof *of_branches);
    asj_segment *segments = asj_allocate(&memory, w->joining.count, sizeof *segments);
    if (!l || !of_branches || !segments) {
        asj_release(&memory, l);
        asj_release(&memory, of_branches);
        asj_release(&memory, segments);
        return asj_fail(w->joining.context, ASJ_ERROR_MEMORY, "no memory for a list of %lu segments",
                        (unsigned long)w->joining.count);
    }
    memcpy(segments, w->joining.segments, w->joining.count * sizeof *segments);
    tell_branches(w, segments, of_branches);
    l->memory = memory;
    l->segments = segments;
    l->of_branches = of_branches;
    l->list = (asj_segment_list){segments, of_branches, w->joining.count, (uint32_t)w->junction_count, {0, 0}};
    *made = l;
    return ASJ_OK;
}

static asj_status check(const work *w)
{
    char fault[128];
    for (size_t j = 0; j < w->junction_count; j++)
        if (asj_junction_check(&w->joining.junctions[j], fault, sizeof fault) != ASJ_OK)
            return asj_fail(w->joining.context, ASJ_ERROR_ARGUMENT, "junction %zu has %s", j, fault);
    return ASJ_OK;
}

static asj_status work_on(work *w, own_list **made)
{
    asj_memory *memory = &w->joining.context->memory;
    const size_t branches = w->junction_count * ASJ_MAX_BRANCHES;
    w->joining.segments = asj_allocate(memory, branches, sizeof *w->joining.segments);
    w->joining.joined = asj_allocate(memory, branches, sizeof *w->joining.joined);
    w->edge_of = asj_allocate(memory, branches, sizeof *w->edge_of);
    w->joining.first_cut = asj_allocate(memory, branches, sizeof *w->joining.first_cut);
    w->joining.asked = asj_allocate(memory, branches, sizeof *w->joining.asked);
    if (!w->joining.segments || !w->joining.joined || !w->edge_of || !w->joining.first_cut || !w->joining.asked)
        return asj_fail(w->joining.context, ASJ_ERROR_MEMORY, "no memory for the branches of %zu junctions", w->junction_count);
    memset(w->joining.joined, 0xff, branches * sizeof *w->joining.joined);
    memset(w->joining.first_cut, 0xff, branches * sizeof *w->joining.first_cut);
    asj_status status = check(w);
    if (status == ASJ_OK)
        status = take_edges(w);
    if (status == ASJ_OK) {
        take_branches(w);
        status = asj_join_segments(&w->joining);
    }
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
    work w = {.joining = {.context = context, .junctions = junctions}, .edges = edges, .junction_count = count,
              .edge_count = edge_count};
    asj_watch_start(&w.joining.watch, context, ASJ_STAGE_DECOMPOSE);
    const asj_status status = work_on(&w, &made);
    asj_release(&context->memory, w.joining.segments);
    asj_release(&context->memory, w.joining.joined);
    asj_release(&context->memory, w.edge_of);
    asj_release(&context->memory, w.joining.first_cut);
    asj_release(&context->memory, w.joining.cuts);
    asj_release(&context->memory, w.joining.asked);
    asj_segment_cells_free(&context->memory, &w.joining.cells);
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
