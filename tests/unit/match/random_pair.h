/* SPDX-License-Identifier: BSD-2-Clause */
/* Two images of the same random corners and candidate pairs between them, true and false ones: what the steps of the matcher are
 * tested on against naive evaluations of their formulas. */
#ifndef ASJ_TESTS_RANDOM_PAIR_H
#define ASJ_TESTS_RANDOM_PAIR_H

#include "match/match_run.h"
#include "unit_test.h"

#define RANDOM_PAIR_SIDE 400

typedef struct random_pair {
    asj_image_features image[2];
    asj_match_options options;
    asj_match_run run;
} random_pair;

/* `count` junctions of two to four branches in a textured picture; image 2 shows them turned, smaller and a pixel off. Some stand
 * at one location with others or at equal distances. All options but those given are the defaults. */
void random_pair_create(asj_context *context, uint64_t seed, int32_t count, const asj_match_options *options, random_pair *pair);

/* Fills run.candidates: every L-junction with those of the same junction and `others` random ones; maps from their frames, random
 * distances, similarities and moves. At least one of ten scores is equal to another's. */
void random_pair_candidates(uint64_t seed, int32_t others, random_pair *pair);

void random_pair_free(random_pair *pair);

#endif
