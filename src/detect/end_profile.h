/* SPDX-License-Identifier: BSD-2-Clause */
/* How the contrast of an edge goes along it, and where it ends by that. */
#ifndef ASJ_SRC_END_PROFILE_H
#define ASJ_SRC_END_PROFILE_H

#include "edge_rows.h"
#include "hypothesis.h"

typedef struct asj_end_profile {
    double end;    /* px from the junction: where the edge has lost all but the share of its contrast; 0 = it has none */
    double fading; /* px over which the contrast that it has left falls from three quarters to one quarter around there */
    double noise;  /* of the contrast at one pixel along the edge, over the contrast at its end: standard deviation */
} asj_end_profile;

/* `share` of the branch's own contrast, 0 .. 1. `steady`: an edge with less than that goes on where it is as strong all along. */
asj_end_profile asj_end_profile_of(const asj_edge_ops *ops, const asj_frame *frame, const asj_hypothesis *hypothesis,
                                   const asj_hypothesis_branch *branch, double share, int steady);

#endif
