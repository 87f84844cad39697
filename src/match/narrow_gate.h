/* SPDX-License-Identifier: BSD-2-Clause */
/* Which of the candidates that the gate (support_gate.h) lets through may agree with one: narrower, one at a time. */
#ifndef ASJ_SRC_NARROW_GATE_H
#define ASJ_SRC_NARROW_GATE_H

#include "support_gate.h"

/* What is asked of a candidate. */
typedef struct asj_narrow_maps {
    float here[4], to[4]; /* from the image whose locations are asked to the other, and from image 1 to image 2 */
    float size;           /* square of the norm of the former */
    uint32_t candidate;   /* its place in the list of candidates */
} asj_narrow_maps;

/* What candidate c, of which the gate's query is, expects besides. */
typedef struct asj_narrow_query {
    asj_narrow_maps own;
    int32_t side;    /* of the image asked */
    float unlike;    /* for the square of what maps may differ by, over that of d's size */
    float power;     /* factor by which the way may be longer or shorter than both maps make it, to the fourth power */
    float tolerance; /* neighbour_tolerance */
} asj_narrow_query;

asj_narrow_maps asj_narrow_maps_of(const asj_candidate *list, uint32_t candidate, int32_t side);
asj_narrow_query asj_narrow_query_of(const asj_match_options *options, const asj_candidate *c, int32_t side);

/* What d may be for c: where a bit is clear, asj_surface_agreement() and asj_edge_agreement() are 0. (ex, ey) is the way from c to
 * d in the other image. */
#define ASJ_NARROW_SURFACE 1u
#define ASJ_NARROW_EDGE 2u
uint32_t asj_narrow_gate(const asj_gate_query *query, const asj_narrow_query *narrow, const asj_narrow_maps *d, float ex, float ey);

#endif
