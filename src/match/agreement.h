/* SPDX-License-Identifier: BSD-2-Clause */
/* Do two candidates show two points of one scene? */
#ifndef ASJ_SRC_AGREEMENT_H
#define ASJ_SRC_AGREEMENT_H

#include "distance.h"

#define ASJ_AGREEMENT_PIXELS 3.0 /* px, error allowed anywhere: location errors of two junctions and their map; as in corners.c */
#define ASJ_AGREEMENT_REACH 5.0  /* r^2 at which agreement ends: where exp(-r^2 / 2) is below a tenth */

/* From c to d in image 1 and in image 2, px. */
typedef struct asj_way {
    double x1, y1, x2, y2;
} asj_way;

asj_way asj_way_between(const asj_view *view1, const asj_view *view2, const asj_candidate *c, const asj_candidate *d);

/* Of points on one surface, and of corners on one edge: 0 .. 1, symmetric in the candidates. */
float asj_surface_agreement(const asj_match_options *options, const asj_candidate *c, const asj_candidate *d, const asj_way *way);
float asj_edge_agreement(const asj_match_options *options, const asj_corners *corners1, const asj_corners *corners2,
                         const asj_candidate *c, const asj_candidate *d, const asj_way *way);

/* --- first looks at many ---------------------------------------------------------------------------------------------------- */

/* In single precision, so a little more is let through than asj_surface_agreement() and asj_edge_agreement() look at: the square of
 * how far a map may miss e, MOST + SLOPE neighbour_tolerance^2 |e|^2, and px that a corner may lie off an edge's line. */
#define ASJ_LOOK_SLOPE (8.1 * ASJ_AGREEMENT_REACH) /* 8.001 there */
#define ASJ_LOOK_MOST (ASJ_LOOK_SLOPE * ASJ_AGREEMENT_PIXELS * ASJ_AGREEMENT_PIXELS)
#define ASJ_LOOK_ACROSS 9.6 /* 3 sqrt(2 REACH) = 9.487 there */

/* Candidates of one image's places. */
typedef struct asj_spots {
    float *x, *y;   /* px: where they stand in the other image */
    float *map[4];  /* their maps from this image to the other */
} asj_spots;

/* What one candidate c expects of those at one of the places. */
typedef struct asj_look {
    float x, y;          /* px: where c stands in the other image */
    float way_x, way_y;  /* px: from c to the place, */
    float px, py;        /* .. turned by c's map */
    float slope;         /* ASJ_LOOK_SLOPE neighbour_tolerance^2 */
    uint32_t edges;      /* branches of c that pass the place: bit 0: a, bit 1: b */
    float branch[2][2];  /* their directions in the other image */
} asj_look;

/* Of spots first .. first + count - 1, 1 to ASJ_LOOK_COUNT, those that may agree with c: where a bit is clear, both agreements
 * are 0. Spots can be read ASJ_LOOK_MORE numbers beyond the last one. */
#define ASJ_LOOK_COUNT 64
#define ASJ_LOOK_MORE 8
uint64_t asj_look_at(const asj_look *look, const asj_spots *spots, uint32_t first, uint32_t count);

/* Which of the branches `among` (bit 0: a, bit 1: b) of an L-junction pass what lies (ex, ey) away, so that both may be corners of
 * one edge. Without a branch that does in both images asj_edge_agreement() is 0. */
uint32_t asj_edges_through(const asj_corners *corners, uint32_t l, uint32_t among, double ex, double ey);

/* Operations (core/ops.h). */
typedef struct asj_agreement_ops {
    uint64_t (*look_at)(const asj_look *look, const asj_spots *spots, uint32_t first, uint32_t count); /* asj_look_at() */
} asj_agreement_ops;
extern const asj_agreement_ops asj_agreement_reference;

#endif
