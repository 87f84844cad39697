/* SPDX-License-Identifier: BSD-2-Clause */
/* What an accepted geometry makes of the matches. */
#ifndef ASJ_SRC_MATCH_VERDICT_H
#define ASJ_SRC_MATCH_VERDICT_H

#include "geometry/directions.h"
#include "match_run.h"
#include "shown_pictures.h"

/* The longer list of candidates, and what the geometry says of it (two_view.c). */
typedef struct asj_wide_run {
    asj_match_options options;
    asj_match_run run;
    asj_geometry_candidate *given;
    double *probability;
    double *colours;    /* how well those of each candidate agree */
    double *branches;   /* of each candidate: geometry/estimate.h */
    uint32_t *place[2]; /* of each location */
    asj_edge_list edges[2]; /* of either image, where a focal length is looked for */
    asj_shown_pictures shown;
} asj_wide_run;

/* Choices that it contradicts become run->rejected, the others have their probability, and new ones come: see verdict.c. */
asj_status asj_apply_verdict(asj_match_run *run, const asj_wide_run *wide);

/* The same for guests that are chosen later, from number `first` on; what is contradicted is left out. */
void asj_judge_guests(asj_match_run *run, size_t first);

#endif
