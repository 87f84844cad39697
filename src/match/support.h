/* SPDX-License-Identifier: BSD-2-Clause */
/* Which candidates agree with which. */
#ifndef ASJ_SRC_SUPPORT_H
#define ASJ_SRC_SUPPORT_H

#include "distance.h"

/* Candidates of each place of one image: order[start[p]] .. order[start[p + 1] - 1]. */
typedef struct asj_place_index {
    uint32_t *start;
    uint32_t *order;
} asj_place_index;

/* Of the candidates with such a number or a larger one; side 1 or 2. */
asj_status asj_place_index_create(asj_context *context, const asj_corners *corners, const asj_candidates *candidates, int32_t side,
                                  uint32_t least_number, asj_place_index *index);
void asj_place_index_free(asj_memory *memory, asj_place_index *index);

/* A candidate at a neighbour place that agrees. */
typedef struct asj_supporter {
    uint32_t number; /* of the candidate, less 1 */
    uint16_t weight; /* agreement in 1/ASJ_SUPPORT_ONE; not 0 */
    uint16_t place;  /* which of the neighbour places it belongs to */
} asj_supporter;
#define ASJ_SUPPORT_ONE 65535.0f

/* The supporters of candidates at the neighbour places of one image, neighbour place by neighbour place. Those of number n + 1 are
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

/* Gives numbers to the candidates that have none, and finds whom they support and who supports them. */
asj_status asj_support_extend(asj_context *context, const asj_match_options *options, const asj_view *view1,
                              const asj_view *view2, asj_candidates *candidates, asj_support *support);
void asj_support_free(asj_memory *memory, asj_support *support);

#endif
