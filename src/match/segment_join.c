/* SPDX-License-Identifier: BSD-2-Clause */
/* Line segments of one edge as one.
 *
 * An edge with corners on it (a window frame where bars meet it, a row of tiles) has a branch from each corner to the edge's end,
 * and so a segment match from each: two in five of 4311 in photographs of sixteen scenes. Two are of one edge when
 *     both ends of the shorter lie on the longer's line in both images (within ASJ_OFF_LINE px),
 *     both images have its ends in the same order along that line, and
 *     they share more than an end's uncertainty (4 px, or 5 % of the shorter, 12 px at most), or the shorter lies in the longer.
 * So two that only touch, at a corner where one edge ends and another begins, stay two. An end that goes on beyond the longer's in
 * both images moves its end there; where only one image says so, the two stay as they are: one of them is wrong. Where the shorter
 * ends at a matched corner beside an end of the longer that is less sure, that corner is the end. The paper has no such step: its
 * segments are the branches of the matches. */
#include "segments/course.h"
#include "core/sort.h"

#include <asj/match.h>

#include <math.h>
#include <stdlib.h>

static asj_end_point end_of(const asj_segment_match *s, int image, int end)
{
    if (image == 0)
        return end == 0 ? (asj_end_point){(double)s->x1, (double)s->y1} : (asj_end_point){(double)s->ex1, (double)s->ey1};
    return end == 0 ? (asj_end_point){(double)s->x2, (double)s->y2} : (asj_end_point){(double)s->ex2, (double)s->ey2};
}

/* Moves an end of `s` to an end of `t`, in both images. */
static void take_end(asj_segment_match *s, int end, const asj_segment_match *t, int from)
{
    const asj_end_point one = end_of(t, 0, from), other = end_of(t, 1, from);
    const int32_t kind = from == 0 ? t->start : t->end;
    if (end == 0) {
        s->x1 = (float)one.x, s->y1 = (float)one.y, s->x2 = (float)other.x, s->y2 = (float)other.y;
        s->start = kind;
    } else {
        s->ex1 = (float)one.x, s->ey1 = (float)one.y, s->ex2 = (float)other.x, s->ey2 = (float)other.y;
        s->end = kind;
    }
}

static double length_in(const asj_segment_match *s, int image)
{
    const asj_end_point a = end_of(s, image, 0), b = end_of(s, image, 1);
    return sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
}

/* The shorter of the two lengths. */
static double length_of(const asj_segment_match *s)
{
    const double shorter = fmin(length_in(s, 0), length_in(s, 1));
    return shorter > 0 ? shorter : 0; /* NaN: what the caller has put there */
}

/* 0: the shorter does not lie along the longer's line in this image. */
static int course_in(const asj_segment_match *longer, const asj_segment_match *shorter, int image, asj_course *c)
{
    const asj_end_point ends[2] = {end_of(longer, image, 0), end_of(longer, image, 1)};
    const asj_end_point of_shorter[2] = {end_of(shorter, image, 0), end_of(shorter, image, 1)};
    return asj_course_along(ends, of_shorter, c);
}

enum { APART, ONE, MOVED };

/* Whether both are of one edge; then the longer has become both, and its ends may have moved. */
static int join(asj_segment_match *longer, const asj_segment_match *shorter)
{
    asj_course c[2];
    if (!course_in(longer, shorter, 0, &c[0]) || !course_in(longer, shorter, 1, &c[1]))
        return APART;
    const int back = asj_course_is_back(&c[0]);
    if (back != asj_course_is_back(&c[1]))
        return APART;
    const int far[2] = {back ? 1 : 0, back ? 0 : 1}; /* which of the shorter's ends is towards the longer's first and second */
    int beyond[2];
    for (int end = 0; end < 2; end++) {
        beyond[end] = asj_course_is_beyond(&c[0], end, far[end]);
        if (beyond[end] != asj_course_is_beyond(&c[1], end, far[end]))
            return APART;
    }
    const int inside = !beyond[0] && !beyond[1];
    int result = ONE;
    for (int image = 0; image < 2; image++)
        if (!(asj_course_shared(&c[image]) > (inside ? 0 : c[image].overlap)))
            return APART;
    for (int end = 0; end < 2; end++) {
        const int32_t kind = end == 0 ? longer->start : longer->end, other = far[end] == 0 ? shorter->start : shorter->end;
        const int beside = asj_course_is_beside(&c[0], end, far[end]) && asj_course_is_beside(&c[1], end, far[end]);
        if (beyond[end] || (other == ASJ_END_CORNER && kind < ASJ_END_CORNER && beside)) {
            take_end(longer, end, shorter, far[end]);
            result = MOVED;
        }
    }
    return result;
}

static int by_names(const asj_segment_match *p, const asj_segment_match *q)
{
    if (p->match != q->match)
        return p->match < q->match ? -1 : 1;
    if (p->branch1 != q->branch1)
        return p->branch1 < q->branch1 ? -1 : 1;
    return p->branch2 < q->branch2 ? -1 : p->branch2 > q->branch2;
}

/* The last word where nothing else tells two apart, so that no order is left to asj_sort(). */
static int by_place(const asj_segment_match *p, const asj_segment_match *q)
{
    const float one[] = {p->x1, p->y1, p->ex1, p->ey1, p->x2, p->y2, p->ex2, p->ey2};
    const float other[] = {q->x1, q->y1, q->ex1, q->ey1, q->x2, q->y2, q->ex2, q->ey2};
    for (size_t k = 0; k < sizeof one / sizeof *one; k++)
        if (one[k] < other[k] || one[k] > other[k])
            return one[k] < other[k] ? -1 : 1;
    if (p->end != q->end)
        return p->end < q->end ? -1 : 1;
    return p->start < q->start ? -1 : p->start > q->start;
}

static int by_length(const void *a, const void *b)
{
    const asj_segment_match *p = a, *q = b;
    const double one = length_of(p), other = length_of(q);
    if (one > other || one < other)
        return one > other ? -1 : 1;
    const int order = by_names(p, q);
    return order ? order : by_place(p, q);
}

static int by_match(const void *a, const void *b)
{
    const int order = by_names(a, b);
    return order ? order : by_length(a, b);
}

/* One after the other, the longest first, into those before; whether ends of these have moved. */
static int join_once(asj_segment_match *segments, size_t *count)
{
    size_t kept = 0;
    int moved = 0;
    for (size_t i = 0; i < *count; i++) {
        const asj_segment_match s = segments[i];
        int joined = APART;
        for (size_t k = 0; k < kept && joined == APART; k++)
            joined = join(&segments[k], &s);
        moved |= joined == MOVED;
        if (joined == APART)
            segments[kept++] = s;
    }
    *count = kept;
    return moved;
}

size_t asj_join_segment_matches(asj_segment_match *segments, size_t count)
{
    if (!segments)
        return 0;
    int again = count > 1;
    while (again) { /* where ends have moved they may reach others */
        asj_sort(segments, count, sizeof *segments, by_length);
        again = join_once(segments, &count);
    }
    if (count > 1)
        asj_sort(segments, count, sizeof *segments, by_match);
    return count;
}
