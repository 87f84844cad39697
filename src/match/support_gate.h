/* SPDX-License-Identifier: BSD-2-Clause */
/* Which of many candidates may agree with one: a quick test before agreement.h. */
#ifndef ASJ_SRC_SUPPORT_GATE_H
#define ASJ_SRC_SUPPORT_GATE_H

#include "agreement.h"

/* In single precision, so a little wider than asj_surface_agreement() and asj_edge_agreement(): the square of how far a map may
 * miss e, MOST + SLOPE neighbour_tolerance^2 |e|^2, and px that a corner may lie off an edge's line. */
#define ASJ_GATE_SLOPE (8.1 * ASJ_AGREEMENT_REACH) /* 8.001 there */
#define ASJ_GATE_MOST (ASJ_GATE_SLOPE * ASJ_AGREEMENT_PIXELS * ASJ_AGREEMENT_PIXELS)
#define ASJ_GATE_ACROSS 9.6 /* 3 sqrt(2 REACH) = 9.487 there */
#define ASJ_GATE_COVER 0.999 /* of 1 - end_tolerance there: part of the way that branches of an edge cover */

/* Candidates of one image's locations. */
typedef struct asj_gate_candidates {
    float *x, *y;     /* px: where they stand in the other image */
    float *map[4];    /* their maps from this image to the other */
    float *length[2]; /* px: of the longer branch in this image and in the other; ASJ_GATE_NO_EDGE in this one when there is none
                       * that may be of an edge */
} asj_gate_candidates;
#define ASJ_GATE_NO_EDGE (-1e30f)

/* The lengths of a candidate; `side`: of the image whose locations are asked. */
void asj_gate_lengths(const asj_match_run *run, const asj_candidate *c, int32_t side, float *here, float *there);

/* What one candidate c expects of those at one of the locations. */
typedef struct asj_gate_query {
    float x, y;          /* px: where c stands in the other image */
    float way_x, way_y;  /* px: from c to the location, */
    float px, py;        /* .. turned by c's map */
    float slope;         /* ASJ_GATE_SLOPE neighbour_tolerance^2 */
    uint32_t edges;      /* branches of c that pass the location: bit 0: a, bit 1: b */
    float branch[2][2];  /* their directions in the other image, */
    float length[2];     /* .. and px: their lengths there, */
    float least[2];      /* .. and px: how long another branch has to be in this image to cover with them what they have to */
    float cover;         /* square of the part of the way that branches cover */
} asj_gate_query;

/* Of candidates first .. first + count - 1 of the list, 1 to ASJ_GATE_COUNT, those that may agree with c: where a bit is clear,
 * both agreements are 0. The list can be read ASJ_GATE_PADDING numbers beyond the last one. */
#define ASJ_GATE_COUNT 64
#define ASJ_GATE_PADDING 16
uint64_t asj_support_gate(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t first, uint32_t count);

/* Which of the branches `among` (bit 0: a, bit 1: b) of an L-junction pass what lies (ex, ey) away, so that both may be corners of
 * one edge. Without a branch that does in both images asj_edge_agreement() is 0. */
uint32_t asj_edges_through(const asj_l_junctions *l_junctions, uint32_t l, uint32_t among, double ex, double ey);

/* Operations (core/ops.h). */
typedef struct asj_gate_ops {
    /* asj_support_gate() */
    uint64_t (*pass)(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t first, uint32_t count);
} asj_gate_ops;
extern const asj_gate_ops asj_gate_reference;

#endif
