/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SEGMENTS_H
#define ASJ_SEGMENTS_H

#include <asj/context.h>
#include <asj/junction.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ASJ_NO_JUNCTION 0xffffffff
#define ASJ_NO_SEGMENT 0xffffffff

/* A straight edge of the picture, from end to end: a branch of a junction, or several along one line that overlap, as one. */
typedef struct asj_segment {
    float x1, y1, x2, y2;          /* px: its ends */
    float sd1, sd2;                /* px: standard uncertainty of the ends along it; 0 = not known */
    int32_t end1, end2;            /* ASJ_BRANCH_END_...: what is at them */
    uint32_t junction1, junction2; /* the junction at this end, if one of its branches runs along the segment; ASJ_NO_JUNCTION =
                                    * none, and with ASJ_BRANCH_END_JUNCTION one that has no such branch */
    float log10_nfa;               /* of the surest of its branches */
    uint32_t junction;             /* of one of its branches, mostly the longest, which goes from end 1 to end 2, and beyond that
                                    * where the edge bends */
    uint16_t branch;
    uint16_t branch_count;         /* that are parts of it; 65535 = so many or more */
    uint32_t reserved;
} asj_segment;

typedef struct asj_segment_list {
    const asj_segment *segments;   /* the longest first */
    const uint32_t *of_branches;   /* for junction j and its branch b at [j * ASJ_MAX_BRANCHES + b] the index of the segment that it
                                    * is a part of, of the two halves of an edge that bends (below) the nearer one, but that which
                                    * goes by a branch has it; ASJ_NO_SEGMENT where there is no such branch, or one without a
                                    * length */
    uint32_t count;
    uint32_t junction_count;       /* as given */
    uint64_t reserved[2];
} asj_segment_list;

/* The straight edges of one image, each once, from its junctions: an edge has a branch from each of its ends and from every corner
 * on it. Two are of one edge when they lie within 2 px of one line and share more than 4 px and 5 % of the shorter one (12 px are
 * enough), or the shorter lies in the longer: what only touches, where one edge ends at a corner and another begins, stays two. An
 * edge reaches from its first end to the last; ends are known to 4 px or 5 % of the length, 12 px at most, and where a corner is no
 * farther from a less sure end, that is the end, unless the corner goes on and the end lies beyond it by more than 4 px. A corner
 * that turns is the end also of what goes on beyond it by up to 24 px and half of its length. Edges count as straight: what bends
 * by more than 2 px comes in several, and of two such that overlap, cross at less than 6 degrees and lie within 6 px of each other
 * there, one from each end of the edge, each ends where they cross (ASJ_BRANCH_END_CROSSING, its uncertainty not known); where that
 * is within 2 px of the line between their corners, they are one. For matches of two images: asj_join_segment_matches().
 *
 * junctions   may be NULL when count is 0; only read
 * edges       of these junctions, as the detection has them: branches that end at each other's junctions are one in any case. NULL
 *             when edge_count is 0; only read
 * list        on success *list belongs to the caller until asj_segment_list_free(); the context may end before
 *
 * Made for junctions of preset default: those of preset match have many weak branches and are of all octaves side by side, which
 * the segments then show, too. The same junctions give the same list. Progress comes as ASJ_STAGE_DECOMPOSE. Time: 50 ms for 19 000
 * branches of a photograph; for 100 000 that lie anywhere in 16 megapixels 1 s where they are 30 px long, 4 s where they are 300,
 * 24 where they are 1000, and two to three times as long for twice as many (tests/benchmark/README.md).
 * Memory while it works: 580 bytes a junction with two branches of 30 px, 900 with two of 300, 2110 with two of 1000.
 * Thread safety: one call at a time per context.
 *
 * ASJ_ERROR_ARGUMENT   a NULL pointer; a junction that cannot be (asj_junction_check()); an edge of a branch that is not there
 * ASJ_ERROR_OPTION     a reserved field of an edge that is not zero
 * ASJ_ERROR_LIMIT      more than 2^28 junctions or 2^32 - 2 edges
 * ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED */
ASJ_API asj_status asj_find_segments(asj_context *context, const asj_junction *junctions, size_t count, const asj_edge *edges,
                                     size_t edge_count, asj_segment_list **list);

/* Frees a list and sets the pointer to NULL. NULL and a pointer to NULL are fine. */
ASJ_API void asj_segment_list_free(asj_segment_list **list);

#ifdef __cplusplus
}
#endif
#endif
