/* SPDX-License-Identifier: BSD-2-Clause */
/* Which candidates agree with which. */
#ifndef ASJ_SRC_SUPPORT_H
#define ASJ_SRC_SUPPORT_H

#include "match_run.h"

/* Candidates of each location of one image: order[start[p]] .. order[start[p + 1] - 1]. */
typedef struct asj_location_index {
    uint32_t *start;
    uint32_t *order;
} asj_location_index;

/* Of the candidates of the run with such a number or a larger one, by their locations in image `side` (0 or 1). On failure the
 * caller still frees. */
asj_status asj_location_index_create(const asj_match_run *run, int32_t side, uint32_t least_number, asj_location_index *index);
void asj_location_index_free(asj_memory *memory, asj_location_index *index);

/* Gives numbers to the candidates that have none, and finds whom they support and who supports them: run->support. Nothing when
 * no neighbours are asked. */
asj_status asj_support_find(asj_match_run *run);

/* The same with room for so many supporters on either side, or for one of each candidate: where all are more, a candidate keeps no
 * more than its share, those at the nearest locations. */
asj_status asj_support_find_within(asj_match_run *run, size_t most);
void asj_support_free(asj_memory *memory, asj_support *support);

#endif
