/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_CONSENSUS_H
#define ASJ_SRC_CONSENSUS_H

#include "agreement.h"

/* Candidates of each place of one image: order[start[p]] .. order[start[p + 1] - 1]. */
typedef struct asj_place_index {
    uint32_t *start;
    uint32_t *order;
} asj_place_index;

/* side 1 or 2. */
asj_status asj_place_index_create(asj_context *context, const asj_corners *corners, const asj_candidates *candidates, int32_t side,
                                  asj_place_index *index);
void asj_place_index_free(asj_memory *memory, asj_place_index *index);

/* The support that a match needs between images with so many places: see consensus.c. */
float asj_needed_support(const asj_match_options *options, const asj_corners *corners1, const asj_corners *corners2);

/* Fills support and score of every candidate. Without neighbours the score is 1 / distance. */
asj_status asj_consensus(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         asj_candidates *candidates);

#endif
