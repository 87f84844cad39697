/* SPDX-License-Identifier: BSD-2-Clause */
/* Whether another geometry may be the right one as well. */
#ifndef ASJ_SRC_GEOMETRY_AMBIGUITY_H
#define ASJ_SRC_GEOMETRY_AMBIGUITY_H

#include "estimation.h"

/* The finalist with the largest evidence that contradicts number `best`, whose probabilities are in scratch, and that the colours
 * do not contradict; -1 = none. */
int32_t asj_strongest_rival(asj_estimation *e, int32_t best);

/* May the rival be the right one as well? inliers: of the best one. */
int32_t asj_is_ambiguous(const asj_estimation *e, int32_t best, int32_t rival, double inliers);

#endif
