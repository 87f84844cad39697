/* SPDX-License-Identifier: BSD-2-Clause */
/* Whether another geometry may be the right one as well. */
#ifndef ASJ_SRC_GEOMETRY_AMBIGUITY_H
#define ASJ_SRC_GEOMETRY_AMBIGUITY_H

#include "estimation.h"

/* log10 NFA of a rival that makes a geometry ambiguous that has up to two and a half times as much: chance does not bring so much,
 * but what repeats does. (Facades of equal windows that are accepted shifted by a window, with up to 2.2 times the log evidence of
 * a rival that has -190 to -350; of 1083 pairs of rooms none is accepted beside one of -66 or less.) */
#define ASJ_SURE_RIVAL (-100)

/* The finalist with the largest evidence that contradicts number `best`, which is e->first afterwards, or that pictures prefer to
 * it (contradiction.h), and that neither colours nor pictures contradict; -1 = none. *doubt: 1 when they are rather for it. */
int32_t asj_strongest_rival(asj_estimation *e, int32_t best, int32_t *doubt);

/* May the rival be the right one as well? inliers: of the best one. */
int32_t asj_is_ambiguous(const asj_estimation *e, int32_t best, int32_t rival, int32_t doubt, double inliers);

#endif
