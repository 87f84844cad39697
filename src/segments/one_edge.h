/* SPDX-License-Identifier: BSD-2-Clause */
/* Whether two segments of an image, made of branches, are parts of one straight edge, and what they become then. */
#ifndef ASJ_SRC_ONE_EDGE_H
#define ASJ_SRC_ONE_EDGE_H

#include "course.h"

#include <asj/segments.h>

#define ASJ_STRAIGHT 0.978147601 /* cosine of 12 degrees: what turns by less goes on */

static inline asj_end_point asj_segment_end(const asj_segment *s, int32_t end)
{
    return end == 0 ? (asj_end_point){(double)s->x1, (double)s->y1} : (asj_end_point){(double)s->x2, (double)s->y2};
}

/* The square of its length, px^2. */
static inline double asj_segment_length2(const asj_segment *s)
{
    const double dx = (double)s->x2 - (double)s->x1, dy = (double)s->y2 - (double)s->y1;
    return dx * dx + dy * dy;
}

/* The end of one becomes that of another, `from`. */
void asj_take_end(asj_segment *s, int32_t end, const asj_segment *t, int32_t from);

/* The longer is as sure as either of both. */
void asj_take_nfa(asj_segment *longer, const asj_segment *shorter);

/* 0: they are parts of different edges. Else where the shorter lies along the longer. */
int32_t asj_is_one_edge(const asj_segment *longer, const asj_segment *shorter, asj_course *c);

/* The longer becomes both. Returns whether an end has moved. */
int32_t asj_become_one_edge(const asj_junction *junctions, asj_segment *longer, const asj_segment *shorter, const asj_course *c);

#endif
