/* SPDX-License-Identifier: BSD-2-Clause */
/* Two line segments that are the halves of one edge which bends. */
#ifndef ASJ_SRC_BENT_EDGE_H
#define ASJ_SRC_BENT_EDGE_H

#include "course.h"

#include <asj/segments.h>

typedef struct asj_bend {
    asj_end_point at;    /* px: where both cross */
    int32_t is_straight; /* the edge does not bend by more than its lines are known: it is that from one's own end to the other's */
    int32_t beyond[2];   /* whether the other one goes on beyond the longer's own end, and beyond the shorter's */
} asj_bend;

#define ASJ_BEND_TURN 0.1 /* sine of the largest angle between them: 6 degrees */

/* Whether both are such halves. A segment's own end is its first. */
int32_t asj_find_bend(const asj_segment *longer, const asj_segment *shorter, asj_bend *bend);

#endif
