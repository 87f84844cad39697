/* SPDX-License-Identifier: BSD-2-Clause */
/* Do two candidates show two points of one scene? */
#ifndef ASJ_SRC_AGREEMENT_H
#define ASJ_SRC_AGREEMENT_H

#include "match_run.h"

#define ASJ_AGREEMENT_PIXELS 3.0 /* px, error allowed anywhere: locations of two junctions and their map; as RAY_DISTANCE */
#define ASJ_AGREEMENT_REACH 5.0  /* r^2 at which agreement ends: where exp(-r^2 / 2) is below a tenth */
#define ASJ_AGREEMENT_LEAST_WAY 10.0 /* px: nearer corners say nothing of an edge's direction; as LEAST_START of frames.c */

/* From c to d in image 1 and in image 2, px. */
typedef struct asj_way {
    double x1, y1, x2, y2;
} asj_way;

asj_way asj_way_between(const asj_match_run *run, const asj_candidate *c, const asj_candidate *d);

/* Of points on one surface, and of corners on one edge: 0 .. 1, symmetric in the candidates. */
float asj_surface_agreement(const asj_match_options *options, const asj_candidate *c, const asj_candidate *d, const asj_way *way);
float asj_edge_agreement(const asj_match_run *run, const asj_candidate *c, const asj_candidate *d, const asj_way *way);

#endif
