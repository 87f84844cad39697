/* SPDX-License-Identifier: BSD-2-Clause */
/* The paper's distance for all pairs: each is left as soon as it cannot come on a short list any more. */
#ifndef ASJ_SRC_INDUCED_SCORE_H
#define ASJ_SRC_INDUCED_SCORE_H

#include "match_run.h"

/* The squares of both images in the order in which they are compared; NULL where pairs are compared in one go. */
typedef struct asj_induced_squares {
    int16_t *of[2];
} asj_induced_squares;

/* Release it with asj_induced_squares_free(), also after an error. */
asj_status asj_induced_squares_create(const asj_match_run *run, asj_induced_squares *squares);
void asj_induced_squares_free(asj_memory *memory, asj_induced_squares *squares);

/* The score (compare.h) of L-junctions i of image 1 and j of image 2 when it is above `needed`; otherwise anything that is not. */
int32_t asj_induced_score(const asj_match_run *run, const asj_induced_squares *squares, uint32_t i, uint32_t j, int32_t needed);

#endif
