/* SPDX-License-Identifier: BSD-2-Clause */
/* Where a place on a matched branch lies in the other image, as the matches around it see it. */
#ifndef ASJ_SRC_AROUND_H
#define ASJ_SRC_AROUND_H

#include "places.h"

/* Matches, and where they lie in image 1 and in image 2; without places (NULL) all of them are looked at. */
typedef struct asj_around {
    const asj_junction_match *matches;
    uint32_t count;
    const asj_place *places[2];
    uint32_t place_count;
    const double *epipolar; /* the fundamental matrix of the images by rows, x2' F x1 = 0; NULL = not known */
} asj_around;

/* The line of a matched branch in both images: from the junctions, as detected, along unit vectors. */
typedef struct asj_matched_branch {
    const asj_junction_match *match;
    double x[2], y[2], ux[2], uy[2];
} asj_matched_branch;

/* A place beside the line of a branch: px from the junction along it, and px off it. `from`: px,
 * sqrt(d^2 + NEAR^2) of a single match at a distance of d that would know the place as well (around.c). */
typedef struct asj_line_place {
    double along, off, from;
} asj_line_place;

/* In the other image, the place that lies `length` px along the branch in image `side` (0, 1). `around` may be NULL: then the match
 * alone is asked. */
asj_line_place asj_around_place(const asj_around *around, const asj_matched_branch *branch, int32_t side, double length);

#endif
