/* SPDX-License-Identifier: BSD-2-Clause */
/* Refinement of a pair's affine map on the images. */
#ifndef ASJ_SRC_ALIGN_H
#define ASJ_SRC_ALIGN_H

#include "alignments.h"
#include "disc.h"
#include "match_run.h"

/* Result of an alignment. */
typedef struct asj_alignment {
    asj_disc_pose pose;
    float first, similarity; /* correlation before and after */
    int32_t moved;           /* the start was improved upon, within the limits */
} asj_alignment;

/* How discs are aligned. */
typedef struct asj_aligner {
    const asj_disc *disc;
    int32_t iterations;
    double max_move;         /* px: farthest that the location may go */
} asj_aligner;

/* Aligns `source` with the template, starting from the pose given. */
asj_alignment asj_align(const asj_aligner *aligner, const asj_template *t, const asj_pyramid *source, const asj_disc_pose *start);

/* Steps for the candidates of this run. */
int32_t asj_align_steps(const asj_match_run *run);

/* Aligns every candidate of a list of this run: updates map, move1, move2, similarity and distance2, and drops those whose discs do
 * not look alike. */
asj_status asj_align_candidates(const asj_match_run *run, asj_candidates *candidates);

#endif
