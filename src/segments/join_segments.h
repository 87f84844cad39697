/* SPDX-License-Identifier: BSD-2-Clause */
/* Of the segments of branches those that each are a whole edge: join_segments.c. */
#ifndef ASJ_SRC_JOIN_SEGMENTS_H
#define ASJ_SRC_JOIN_SEGMENTS_H

#include "segment_cells.h"
#include "core/context.h"
#include "core/watch.h"

#include <asj/segments.h>

/* A segment ends where it crosses another one, the other half of an edge that bends. */
typedef struct asj_cut {
    uint32_t other; /* a branch of that one, or of what lies farther on */
    uint32_t next;  /* cut of the same segment; ASJ_NO_SEGMENT = none */
} asj_cut;

typedef struct asj_joining {
    asj_context *context;
    const asj_junction *junctions; /* that the branches are of */
    asj_watch watch;
    asj_segment *segments;         /* at first of each branch, or edge, its own */
    uint32_t count;
    uint32_t *joined;              /* for each branch that of the segment which its own has joined, itself while it has not, or
                                    * ASJ_NO_SEGMENT: where this ends is the segment's branch */
    uint32_t *first_cut;           /* for the branch of a segment, or ASJ_NO_SEGMENT */
    asj_cut *cuts;                 /* the caller frees them */
    size_t cut_count, cut_capacity;
    uint32_t *asked;               /* scratch, for each segment */
    asj_segment_cells cells;       /* scratch; the caller frees it */
} asj_joining;

/* Of a junction's branch in lists of all branches. */
static inline size_t asj_branch_number(uint32_t junction, uint16_t branch)
{
    return (size_t)junction * ASJ_MAX_BRANCHES + branch;
}

/* Of the branch that the segment goes by. */
static inline size_t asj_branch_of(const asj_segment *s)
{
    return asj_branch_number(s->junction, s->branch);
}

/* The branch of the segment that a branch is a part of; ASJ_NO_SEGMENT = of none. */
uint32_t asj_joined_branch(const asj_joining *joining, size_t branch);

/* Leaves the segments of edges, the longest first. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_join_segments(asj_joining *joining);

#endif
