/* SPDX-License-Identifier: BSD-2-Clause */
/* Translations by a vote, where the rotation is one of a few: turned.c. */
#ifndef ASJ_SRC_GEOMETRY_TURNED_H
#define ASJ_SRC_GEOMETRY_TURNED_H

#include "core/memory.h"
#include "model.h"

/* What the first `count` candidates say of the translation under each of the set's rotations. */
typedef struct asj_turned {
    float *normal; /* for each rotation all x, all y, all z */
    float *weight; /* for each rotation, of each candidate's vote */
    int32_t count;
} asj_turned;

/* weights: NULL, or factors of the priors. 0 without memory; asj_turned_free() in any case. */
int32_t asj_turned_create(asj_memory *memory, const asj_pairs *set, int32_t count, const double *weights,
                          const asj_camera cameras[2], asj_turned *turned);
void asj_turned_free(asj_memory *memory, asj_turned *turned);

/* The essential matrix with this rotation whose epipolar plane holds `pair` (of set->list) and that most others vote for; 0 when
 * there is none. */
int32_t asj_translation_by_vote(const asj_pairs *set, const asj_turned *turned, int32_t rotation, const asj_pair *pair,
                                const asj_camera cameras[2], asj_model *model);

#endif
