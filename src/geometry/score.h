/* SPDX-License-Identifier: BSD-2-Clause */
/* How much likelier all candidates are with a geometry than without one, and which of them are right. */
#ifndef ASJ_SRC_GEOMETRY_SCORE_H
#define ASJ_SRC_GEOMETRY_SCORE_H

#include "candidates.h"

/* Scratch for a score: place by place, and a list of those touched. */
typedef struct asj_score_scratch {
    double *sum[2];
    uint32_t *touched[2];
    uint32_t *near; /* one number a candidate, and one more */
    double *ratio;  /* of each that is near */
} asj_score_scratch;

/* Log of likelihood with the geometry over likelihood without. Of the first `count` candidates. */
double asj_score(const asj_pairs *set, int32_t count, const asj_two_view *view, double loose, asj_score_scratch *scratch);

/* Sum of the probabilities of all candidates. */
double asj_inliers(const asj_pairs *set, const double *probability);

/* For every candidate the probability that it is right, given the geometry and its rivals at both places. */
void asj_probabilities(const asj_pairs *set, const asj_two_view *view, double loose, asj_score_scratch *scratch,
                       double *probability);

#endif
