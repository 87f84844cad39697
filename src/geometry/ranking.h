/* SPDX-License-Identifier: BSD-2-Clause */
/* The best geometries that differ. */
#ifndef ASJ_SRC_GEOMETRY_RANKING_H
#define ASJ_SRC_GEOMETRY_RANKING_H

#include "model.h"

typedef struct asj_ranked {
    double score;
    int32_t index;
} asj_ranked;

/* For asj_sort(): the largest score first, then the smallest index. */
int asj_by_score(const void *left, const void *right);

/* The best `most` of models that differ, in the order given; scores of -HUGE_VAL are none. Returns how many. `best` must not
 * overlap. */
int32_t asj_pick(const asj_model *models, const asj_ranked *order, int32_t count, int32_t most, asj_model *best);

#endif
