/* SPDX-License-Identifier: BSD-2-Clause */
/* Do two candidates show two points of one scene? */
#ifndef ASJ_SRC_AGREEMENT_H
#define ASJ_SRC_AGREEMENT_H

#include "distance.h"

/* Of points on one surface, and of corners on one surface or one edge: 0 .. 1, symmetric in the candidates and in the images. */
float asj_surface_agreement(const asj_match_options *options, const asj_view *view1, const asj_view *view2, const asj_candidate *c,
                            const asj_candidate *d);
float asj_agreement(const asj_match_options *options, const asj_view *view1, const asj_view *view2, const asj_candidate *c,
                    const asj_candidate *d);

/* First looks at many: is asj_surface_agreement() 0 for certain? */
typedef struct asj_way {
    double x1, y1, x2, y2; /* from c to d in image 1 and in image 2, px */
} asj_way;

int32_t asj_way_misses(const asj_match_options *options, const asj_candidate *c, const asj_way *way);

/* May a candidate at L-junction `l` and one at `place` of the same image be corners of one edge? */
int32_t asj_edge_possible(const asj_corners *corners, uint32_t l, uint32_t place);

#endif
