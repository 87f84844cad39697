/* SPDX-License-Identifier: BSD-2-Clause */
/* Candidates from line segments.
 *
 * "Since junction is formed by several intersected line segments ..." (paper, section "Detecting Junction Locations and Isotropic
 * Branches"). The paper starts from isotropic junctions and does not say at which pixels they are looked for. Asked at every pixel
 * of a photograph their test finds thousands, as its null model, independent gradients, does not hold on smooth and compressed
 * walls. The output of the authors' program shows where it looks: in sixteen photographs 75 % of its places lie within 5 px of
 * where two of our line segments nearly meet (8 px apart), and 74 % of these meeting points have one of its places within 5 px.
 * So seeds are
 *   - the meeting point of the lines of two segments, no farther than `gap` from both;
 *   - the end of a segment, no farther than `gap` from another one;
 * where both open by at least 20 degrees, and all pixels within seed_radius of a seed are candidates.
 *
 * The gap is 10 px in preset paper: a corner that two segments farther apart would make is seldom there in the next picture. With
 * 12 px .82 of the authors' places are found instead of .80, but .59 instead of .62 of ours are near theirs, and of the L-junctions
 * 23.8 instead of 24.6 % repeat under zoom by 0.7. In rendered rooms the two differ by 1 % at most.
 *
 * The segments' own number of false alarms may be large (option segment_epsilon): a false segment costs the time for a few
 * candidates, no more, and small things have short segments. */
#include "seeds.h"
#include "core/sort.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define LEAST_SINE 0.3420201433256687 /* of 20 degrees */

typedef struct line {
    double ux, uy, length;
} line;

static line line_of(const asj_line_segment *s)
{
    const double dx = s->x2 - s->x1, dy = s->y2 - s->y1, length = sqrt(dx * dx + dy * dy);
    return length > 0 ? (line){dx / length, dy / length, length} : (line){0, 0, 0};
}

/* How far beyond its ends place `t` along a segment is. */
static double beyond(double t, double length)
{
    return t < 0 ? -t : t > length ? t - length : 0;
}

/* From a: p_a + t u_a = p_b + s u_b gives, with the cross product c = u_a x u_b and d = p_b - p_a,  t = (d x u_b) / c,
 * s = (d x u_a) / c. */
int asj_seeds_meet(const asj_line_segment *a, const asj_line_segment *b, double gap, double *x, double *y)
{
    const line la = line_of(a), lb = line_of(b);
    const double cross = la.ux * lb.uy - la.uy * lb.ux, dx = b->x1 - a->x1, dy = b->y1 - a->y1;
    if (fabs(cross) < LEAST_SINE)
        return 0;
    const double t = (dx * lb.uy - dy * lb.ux) / cross, s = (dx * la.uy - dy * la.ux) / cross;
    if (beyond(t, la.length) > gap || beyond(s, lb.length) > gap)
        return 0;
    *x = a->x1 + t * la.ux;
    *y = a->y1 + t * la.uy;
    return 1;
}

int asj_seeds_ends_at(const asj_line_segment *a, double x, double y, const asj_line_segment *b, double gap)
{
    const line la = line_of(a), lb = line_of(b);
    if (fabs(la.ux * lb.uy - la.uy * lb.ux) < LEAST_SINE)
        return 0;
    const double along = (x - b->x1) * lb.ux + (y - b->y1) * lb.uy, across = (y - b->y1) * lb.ux - (x - b->x1) * lb.uy;
    const double past = beyond(along, lb.length);
    return past * past + across * across <= gap * gap;
}

/* What is marked, and how. */
typedef struct marker {
    const asj_frame *frame;
    uint16_t *masks;
    double radius;
} marker;

static void mark(const marker *m, double x, double y)
{
    const double r = m->radius;
    const double top = fmax(ceil(y - r), 0), bottom = fmin(floor(y + r), m->frame->height - 1);
    for (double row = top; row <= bottom; row++) {
        const double half = sqrt(fmax(r * r - (row - y) * (row - y), 0));
        const double left = fmax(ceil(x - half), 0), right = fmin(floor(x + half), m->frame->width - 1);
        for (double column = left; column <= right; column++) {
            const int32_t at = (int32_t)column;
            m->masks[(ptrdiff_t)row * m->frame->blocks + at / ASJ_LANES] |= (uint16_t)(1u << at % ASJ_LANES);
        }
    }
}

static void mark_end(const marker *m, const asj_line_segment *a, double x, double y, const asj_line_segment *b, double gap)
{
    if (asj_seeds_ends_at(a, x, y, b, gap))
        mark(m, x, y);
}

static void mark_pair(const marker *m, const asj_line_segment *a, const asj_line_segment *b, double gap)
{
    double x, y;
    if (asj_seeds_meet(a, b, gap, &x, &y))
        mark(m, x, y);
    mark_end(m, a, a->x1, a->y1, b, gap);
    mark_end(m, a, a->x2, a->y2, b, gap);
    mark_end(m, b, b->x1, b->y1, a, gap);
    mark_end(m, b, b->x2, b->y2, a, gap);
}

static double left_of(const asj_line_segment *s)
{
    return fmin(s->x1, s->x2);
}

/* Then by the other numbers, so that the same are in one order. */
static int from_left(const void *a, const void *b)
{
    const asj_line_segment *p = a, *q = b;
    const double left[][2] = {{left_of(p), left_of(q)}, {p->x1, q->x1}, {p->y1, q->y1}, {p->x2, q->x2}, {p->y2, q->y2}};
    for (int32_t k = 0; k < 5; k++)
        if (left[k][0] < left[k][1] || left[k][0] > left[k][1])
            return left[k][0] < left[k][1] ? -1 : 1;
    return 0;
}

/* Whether two segments are no farther apart than `gap` along y. */
static int side_by_side(const asj_line_segment *a, const asj_line_segment *b, double gap)
{
    return fmin(a->y1, a->y2) - gap <= fmax(b->y1, b->y2) && fmin(b->y1, b->y2) - gap <= fmax(a->y1, a->y2);
}

/* A segment meets those that start before it ends. A point no farther than gap from both: they are 2 gap apart at most. */
static asj_status mark_pairs(asj_context *context, const marker *m, asj_line_segment *segments, size_t count, double gap)
{
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_CANDIDATES);
    if (count > 1)
        asj_sort(segments, count, sizeof *segments, from_left);
    for (size_t i = 0; i < count && !asj_watch_stops(&watch, NULL); i++) {
        const double end = fmax(segments[i].x1, segments[i].x2) + 2 * gap;
        for (size_t j = i + 1; j < count && left_of(&segments[j]) <= end; j++)
            if (side_by_side(&segments[i], &segments[j], 2 * gap) && !asj_watch_stops(&watch, NULL))
                mark_pair(m, &segments[i], &segments[j], gap);
    }
    return asj_watch_end(&watch);
}

asj_status asj_seeds_mark(asj_context *context, const asj_frame *frame, const asj_detect_options *options, uint16_t *masks)
{
    const marker m = {frame, masks, options->seed_radius};
    asj_line_segment *segments;
    size_t count;
    memset(masks, 0, (size_t)frame->blocks * (size_t)frame->height * sizeof *masks);
    asj_status status = asj_line_segments_find(context, frame, ASJ_STAGE_CANDIDATES, options->segment_epsilon, &segments, &count);
    if (status == ASJ_OK)
        status = mark_pairs(context, &m, segments, count, options->seed_gap);
    asj_release(&context->memory, segments);
    return status;
}
