/* SPDX-License-Identifier: BSD-2-Clause */
/* The distance of two L-junctions and the map between them. */
#ifndef ASJ_SRC_COMPARE_H
#define ASJ_SRC_COMPARE_H

#include "match_run.h"

/* The score of L-junctions i of image 1 and j of image 2. For canonical patches the frames are those of the best pair of frames. */
typedef struct asj_pair_score {
    int32_t score;           /* ASJ_NO_PARTNER = the pair cannot be compared */
    uint32_t frame1, frame2;
} asj_pair_score;

asj_pair_score asj_score_pair(const asj_match_run *run, uint32_t i, uint32_t j);

/* Compares every pair of the list, fills distance2 and map, and drops pairs without a map; the order stays. */
asj_status asj_compare_and_drop(const asj_match_run *run, asj_candidates *candidates);

#endif
