/* SPDX-License-Identifier: BSD-2-Clause */
/* What the steps of the matcher hand on: candidate pairs, who supports them, and which of them are chosen. */
#ifndef ASJ_SRC_CANDIDATE_H
#define ASJ_SRC_CANDIDATE_H

#include "affine.h"
#include "core/context.h"

#include <stddef.h>

/* Scores of pairs are whole numbers, the larger the better (compare.c); this one says that there is none. */
#define ASJ_NO_PARTNER INT32_MIN

/* A pair that may be a match. */
typedef struct asj_candidate {
    uint32_t i, j;           /* L-junctions of image 1 and 2 */
    float distance2;         /* square of the patches' distance */
    float similarity;        /* correlation of the aligned discs; 0 when not aligned */
    double move1[2], move2[2]; /* px: how far the alignment moved the junction in either image; one of the two is zero */
    asj_linear map;          /* linear part, image 1 -> image 2 */
    float support;
    float score;             /* the choice takes the largest */
    uint32_t number;         /* its name in asj_support: 1, 2, ...; 0 = not yet */
} asj_candidate;

typedef struct asj_candidates {
    asj_candidate *list;     /* by i, then j */
    size_t count, capacity;
} asj_candidates;

/* Images are sides 0 and 1 where a step works on either of them. */
static inline uint32_t asj_candidate_l(const asj_candidate *c, int32_t side)
{
    return side == 0 ? c->i : c->j;
}

/* The linear map from image `side` to the other one. */
static inline const double *asj_candidate_map(const asj_candidate *c, int32_t side)
{
    return side == 0 ? c->map.to : c->map.from;
}

/* Brings a list of different pairs in order. */
void asj_candidates_sort(asj_candidates *candidates);

/* Adds others, both lists in order, and so is the outcome; of a pair in both what is there stays. Others that have room for all
 * give it: their list is taken apart. The caller is asked on behalf of `stage`. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED; then nothing
 * has been added. */
asj_status asj_candidates_merge(asj_context *context, asj_candidates *candidates, asj_candidates *others, int32_t stage);

/* That of these two L-junctions in a sorted list, or NULL. */
const asj_candidate *asj_candidates_find(const asj_candidates *candidates, uint32_t i, uint32_t j);

/* Adds the fresh ones behind the others, unsorted. */
asj_status asj_candidates_append(asj_context *context, asj_candidates *candidates, const asj_candidates *fresh);

/* A candidate at a neighbour location that agrees. */
typedef struct asj_supporter {
    uint32_t number;    /* of the candidate, less 1 */
    uint16_t weight;    /* agreement in 1/ASJ_SUPPORT_ONE; not 0 */
    uint16_t neighbour; /* which of the neighbour locations it belongs to */
} asj_supporter;
#define ASJ_SUPPORT_ONE 65535.0f

/* The supporters of candidates at the neighbour locations of one image, neighbour by neighbour. Those of number n + 1 are
 * list[offset[n]] .. list[offset[n] + count[n] - 1]. */
typedef struct asj_supporters {
    size_t *offset;
    uint32_t *count;
    asj_supporter *list;
} asj_supporters;

/* Agreement never changes, so it is kept while candidates become more. All zero at first. */
typedef struct asj_support {
    asj_supporters side[2];
    uint32_t count;  /* of candidates that are known: numbers 1 .. count */
} asj_support;

/* A candidate that was chosen. */
typedef struct asj_choice {
    uint32_t candidate; /* index into the list */
    float ratio;        /* score over that of the best at another location; HUGE_VALF when there is none */
    float probability;  /* verdict.c */
} asj_choice;

typedef struct asj_choices {
    asj_choice *list;
    size_t count;
} asj_choices;

#endif
