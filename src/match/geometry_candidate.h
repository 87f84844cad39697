/* SPDX-License-Identifier: BSD-2-Clause */
/* Candidates as the geometry sees them, and their epipolar lines. */
#ifndef ASJ_SRC_MATCH_GEOMETRY_CANDIDATE_H
#define ASJ_SRC_MATCH_GEOMETRY_CANDIDATE_H

#include "match_run.h"

/* Of matches that were no candidates of a geometry, so many are right before it is asked (of guests 962 of 1055 in rooms 101 to
 * 140). */
#define ASJ_MATCH_RIGHT 0.9

/* A candidate as the geometry sees it, its locations as places: in image 1 as detected, in image 2 where the aligned map puts it,
 * as match_result.c has them. */
asj_geometry_candidate asj_candidate_for_geometry(const asj_match_run *run, const asj_candidate *c, double prior);

/* The unit vectors of its branches, a and b in image 1, then in image 2 (ASJ_BRANCH_NUMBERS of geometry/candidates.h). */
void asj_candidate_branches(const asj_match_run *run, const asj_candidate *c, double *branches);

/* A map that hardly keeps any area, or makes thousandfold, is no map, and the geometry takes none. */
int asj_keeps_area(const double affine[4]);

/* px from the epipolar lines, the larger of both images; 0 for a homography. */
double asj_distance_from_line(const asj_geometry *g, double x1, double y1, double x2, double y2);

/* How far from its epipolar line a match may lie, px, of the image that knows places less well. */
double asj_farthest_from_line(const asj_match_run *run);

#endif
