/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_ADJUST_H
#define ASJ_SRC_GEOMETRY_ADJUST_H

#include "core/memory.h"
#include "model.h"
#include "score.h"

/* What a place contributes to the evidence. */
typedef struct asj_share {
    double value;
    const asj_pair *pair; /* its best candidate */
} asj_share;

/* What one thread works in: probability has one number a candidate; shares, sorted and best have one a place of the image that has
 * more. */
typedef struct asj_adjust_scratch {
    asj_score_scratch score;
    double *probability;
    asj_share *shares, *sorted;
    double *best;
    float *spots; /* five a place: four coordinates, and how near others are (evidence.c) */
    double *weights[2]; /* of the places of either image: asj_weigh_places() */
} asj_adjust_scratch;

/* `scratch` must be all zero. 0 without memory; to be freed either way. */
int32_t asj_adjust_scratch_create(asj_memory *memory, const asj_pairs *set, asj_adjust_scratch *scratch);
void asj_adjust_scratch_free(asj_memory *memory, asj_adjust_scratch *scratch);

/* One for each of so many threads; NULL without memory. */
asj_adjust_scratch *asj_adjust_scratches_create(asj_memory *memory, const asj_pairs *set, int32_t threads);
void asj_adjust_scratches_free(asj_memory *memory, asj_adjust_scratch *scratches, int32_t threads);

/* Moves the model to where the candidates want it, in so many rounds: adjust.c. Its score is that of all candidates then. */
void asj_adjust(const asj_pairs *set, asj_model *model, int32_t rounds, asj_adjust_scratch *scratch);

/* One round of it with the probabilities of all candidates; 0, and the model stays, when its equations cannot be solved. */
int32_t asj_adjust_once(const asj_pairs *set, asj_model *model, const double *probability);

/* The same of an essential matrix whose rotation stays, with standard deviations times `loose`. */
int32_t asj_adjust_held(const asj_pairs *set, asj_model *model, const double *probability, double loose);

/* The same for a model that should explain the candidates that `like` does, and may still be some way off. */
void asj_adjust_like(const asj_pairs *set, asj_model *model, const asj_model *like, int32_t rounds, asj_adjust_scratch *scratch);

/* The normal matrix (information) of the model's parameters at the candidates' probabilities: parameters x parameters. */
void asj_information(const asj_pairs *set, const asj_model *model, const double *probability, double *information);

/* How many candidates it explains: the sum of their probabilities, which stand in the scratch then. */
double asj_explained(const asj_pairs *set, const asj_model *model, asj_adjust_scratch *scratch);

/* Of the four motions of an essential matrix the one with most probability in front of both cameras; what is behind counts BEHIND
 * times against it. Returns the balance. */
double asj_choose_motion(const asj_pairs *set, const double *probability, asj_model *model);

#endif
