/* SPDX-License-Identifier: BSD-2-Clause */
/* An edge has a branch from each of its ends, and one from every corner on it (a window frame where bars meet it, a row of tiles).
 * Segments are taken one after the other, the longest first; one that is of the same edge as one before joins it (one_edge.c).
 * Where ends have moved they may reach others, so all is done again until none has. What is left and crosses another one nearly
 * lengthwise is half of an edge that bends (bent_edge.c). */
#include "join_segments.h"
#include "bent_edge.h"
#include "one_edge.h"
#include "core/sort.h"

#include <math.h>
#include <string.h>

static int by_length(const void *a, const void *b)
{
    const asj_segment *p = a, *q = b;
    const double one = asj_segment_length2(p), other = asj_segment_length2(q);
    if (one > other || one < other)
        return one > other ? -1 : 1;
    return asj_branch_of(p) < asj_branch_of(q) ? -1 : asj_branch_of(p) > asj_branch_of(q);
}

uint32_t asj_joined_branch(const asj_joining *joining, size_t branch)
{
    uint32_t root = joining->joined[branch];
    while (root != ASJ_NO_SEGMENT && joining->joined[root] != root)
        root = joining->joined[root];
    return root;
}

static asj_status no_memory(const asj_joining *w)
{
    return asj_fail(w->context, ASJ_ERROR_MEMORY, "no memory for the segments of %lu branches", (unsigned long)w->count);
}

/* ---- pairs ---- */

/* Of the segments before one that pass near it, the first that it makes an edge with: one edge as it is, or one that bends. */
typedef struct partner_search {
    asj_joining *w;
    const asj_segment *s;
    uint32_t mark; /* of this search, in `asked` */
    uint32_t best; /* the first that the segment is a part of an edge with; at first one beyond all */
    int32_t (*compare)(struct partner_search *search, uint32_t k);
    double turn; /* rad: what is turned by more is none */
    asj_course course;
    asj_bend bend;
    uint32_t goes_on[2]; /* where the other one goes on beyond an end (bend.beyond), a branch of what lies there */
} partner_search;

static void look_in_class(partner_search *p, uint32_t first)
{
    for (uint32_t at = first; at; at = p->w->cells.entries[at].next) {
        const uint32_t k = p->w->cells.entries[at].segment;
        if (k >= p->best || p->w->asked[k] == p->mark)
            continue;
        p->w->asked[k] = p->mark;
        if (p->compare(p, k))
            p->best = k;
    }
}

static void look_in_cell(partner_search *p, const uint32_t *first_of, asj_cell_classes classes)
{
    for (int32_t n = 0, class = classes.next; n < classes.count; n++, class = class + 1 < p->w->cells.classes ? class + 1 : 0)
        look_in_class(p, first_of[class]);
}

/* The longest before that it is a part of an edge with. */
static void find_longer(partner_search *p)
{
    const asj_segment_cells *cells = &p->w->cells;
    const asj_end_point ends[2] = {asj_segment_end(p->s, 0), asj_segment_end(p->s, 1)};
    const asj_cell_classes classes = asj_segment_cells_classes(cells, ends, p->turn);
    int32_t first, last;
    asj_segment_cells_rows(cells, ends, 0, &first, &last);
    for (int32_t row = first; row <= last; row++) {
        const asj_cell_run run = asj_segment_cells_run(cells, ends, 0, row);
        for (int32_t column = run.first; column <= run.last; column++)
            look_in_cell(p, asj_segment_cells_first(cells, row, column), classes);
    }
}

static int32_t add_to_cells(asj_joining *w, uint32_t k)
{
    const asj_end_point ends[2] = {asj_segment_end(&w->segments[k], 0), asj_segment_end(&w->segments[k], 1)};
    return asj_segment_cells_add(&w->context->memory, &w->cells, ends, k);
}

/* ---- straight ones ---- */

static int32_t is_one_edge(partner_search *p, uint32_t k)
{
    asj_course course;
    if (!asj_is_one_edge(&p->w->segments[k], p->s, &course))
        return 0;
    p->course = course;
    return 1;
}

/* One after the other, the longest first, into those before. */
static asj_status join_once(asj_joining *w, int32_t *moved)
{
    uint32_t kept = 0;
    *moved = 0;
    memset(w->asked, 0, w->count * sizeof *w->asked);
    asj_segment_cells_clear(&w->cells);
    for (uint32_t i = 0; i < w->count && !asj_watch_stops(&w->watch, NULL); i++) {
        const asj_segment s = w->segments[i];
        partner_search p = {.w = w, .s = &s, .mark = i + 1, .best = kept, .compare = is_one_edge,
                            .turn = asj_course_most_turn(sqrt(asj_segment_length2(&s)))};
        find_longer(&p);
        const uint32_t k = p.best;
        int32_t changed = k == kept;
        if (k < kept) {
            changed = asj_become_one_edge(w->junctions, &w->segments[k], &s, &p.course);
            *moved |= changed;
            w->joined[asj_branch_of(&s)] = (uint32_t)asj_branch_of(&w->segments[k]);
        } else {
            w->segments[kept++] = s;
        }
        if (changed && !add_to_cells(w, k))
            return no_memory(w);
    }
    w->count = kept;
    return asj_watch_end(&w->watch);
}

/* ---- bent ones ---- */

/* The branch of another segment than `other` that goes on where the segment begins; ASJ_NO_SEGMENT = none. */
static uint32_t what_goes_on(const asj_joining *w, const asj_segment *s, const asj_segment *other)
{
    const double dx = (double)s->x1 - (double)s->x2, dy = (double)s->y1 - (double)s->y2;
    const double least = ASJ_STRAIGHT * sqrt(asj_segment_length2(s));
    if (s->junction1 == ASJ_NO_JUNCTION)
        return ASJ_NO_SEGMENT;
    const asj_junction *corner = &w->junctions[s->junction1];
    for (int32_t b = 0; b < corner->branch_count; b++) {
        const double angle = (double)corner->branches[b].angle;
        const uint32_t of = asj_joined_branch(w, asj_branch_number(s->junction1, (uint16_t)b));
        if (dx * cos(angle) + dy * sin(angle) > least && of != ASJ_NO_SEGMENT && of != asj_branch_of(other))
            return of;
    }
    return ASJ_NO_SEGMENT;
}

/* What lies beyond the end of its edge must be another's. */
static int32_t is_bent(partner_search *p, uint32_t k)
{
    const asj_segment *longer = &p->w->segments[k];
    asj_bend bend;
    if (!asj_find_bend(longer, p->s, &bend))
        return 0;
    const uint32_t there[2] = {bend.beyond[0] ? what_goes_on(p->w, longer, p->s) : ASJ_NO_SEGMENT,
                               bend.beyond[1] ? what_goes_on(p->w, p->s, longer) : ASJ_NO_SEGMENT};
    for (int32_t end = 0; end < 2; end++)
        if (bend.beyond[end] && there[end] == ASJ_NO_SEGMENT)
            return 0;
    p->bend = bend;
    memcpy(p->goes_on, there, sizeof there);
    return 1;
}

/* other: a branch, or ASJ_NO_SEGMENT. */
static int32_t add_cut(asj_joining *w, const asj_segment *s, uint32_t other)
{
    void *cuts = w->cuts;
    if (other == ASJ_NO_SEGMENT)
        return 1;
    if (asj_grow(&w->context->memory, &cuts, &w->cut_capacity, w->cut_count + 1, sizeof *w->cuts, w->cut_count) != ASJ_OK)
        return 0;
    uint32_t *first = &w->first_cut[asj_branch_of(s)];
    w->cuts = cuts;
    w->cuts[w->cut_count] = (asj_cut){other, *first};
    *first = (uint32_t)w->cut_count++;
    return 1;
}

static void end_at(asj_segment *s, const asj_end_point *at)
{
    s->x2 = (float)at->x;
    s->y2 = (float)at->y;
    s->sd2 = 0;
    s->end2 = ASJ_BRANCH_END_CROSSING;
    s->junction2 = ASJ_NO_JUNCTION;
}

/* From one's own end to the other's. */
static int32_t join_both(asj_joining *w, asj_segment *longer, const asj_segment *shorter, const partner_search *p)
{
    asj_take_end(longer, 1, shorter, 0);
    asj_take_nfa(longer, shorter);
    w->joined[asj_branch_of(shorter)] = (uint32_t)asj_branch_of(longer);
    return add_cut(w, longer, p->goes_on[0]) && add_cut(w, longer, p->goes_on[1]);
}

/* Each ends where they cross. What lies beyond may be a part of the other, or of what goes on at the other's corner. */
static int32_t cut_both(asj_joining *w, asj_segment *longer, asj_segment *shorter, const partner_search *p)
{
    end_at(longer, &p->bend.at);
    end_at(shorter, &p->bend.at);
    return add_cut(w, longer, (uint32_t)asj_branch_of(shorter)) && add_cut(w, shorter, (uint32_t)asj_branch_of(longer)) &&
           add_cut(w, longer, p->goes_on[1]) && add_cut(w, shorter, p->goes_on[0]);
}

/* Once: what has been cut crosses nobody any more there. */
static asj_status join_halves(asj_joining *w)
{
    uint32_t kept = 0;
    memset(w->asked, 0, w->count * sizeof *w->asked);
    asj_segment_cells_clear(&w->cells);
    for (uint32_t i = 0; i < w->count && !asj_watch_stops(&w->watch, NULL); i++) {
        asj_segment s = w->segments[i];
        partner_search p = {.w = w, .s = &s, .mark = i + 1, .best = kept, .compare = is_bent, .turn = asin(ASJ_BEND_TURN)};
        find_longer(&p);
        const uint32_t k = p.best;
        int32_t good = 1;
        if (k < kept && p.bend.is_straight) {
            good = join_both(w, &w->segments[k], &s, &p) && add_to_cells(w, k); /* where it reaches now, too */
        } else {
            good = k == kept || cut_both(w, &w->segments[k], &s, &p);
            w->segments[kept] = s;
            good = good && add_to_cells(w, kept++);
        }
        if (!good)
            return no_memory(w);
    }
    w->count = kept;
    asj_sort(w->segments, w->count, sizeof *w->segments, by_length);
    return asj_watch_end(&w->watch);
}

/* ---- all of them ---- */

/* Of two or more. */
static int32_t make_cells(asj_joining *w)
{
    double left = HUGE_VAL, top = HUGE_VAL, right = -HUGE_VAL, bottom = -HUGE_VAL;
    for (uint32_t k = 0; k < 2 * w->count; k++) {
        const asj_end_point p = asj_segment_end(&w->segments[k / 2], (int32_t)(k % 2));
        left = fmin(left, p.x), right = fmax(right, p.x);
        top = fmin(top, p.y), bottom = fmax(bottom, p.y);
    }
    return asj_segment_cells_make(&w->context->memory, left, top, right, bottom, w->count, &w->cells);
}

asj_status asj_join_segments(asj_joining *w)
{
    int32_t moved = 1;
    asj_status status = ASJ_OK;
    if (w->count < 2)
        return ASJ_OK;
    if (!make_cells(w))
        return no_memory(w);
    while (moved && status == ASJ_OK) {
        asj_sort(w->segments, w->count, sizeof *w->segments, by_length);
        status = join_once(w, &moved);
    }
    return status == ASJ_OK ? join_halves(w) : status;
}
