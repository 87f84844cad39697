/* SPDX-License-Identifier: BSD-2-Clause */
/* Pairs of L-junctions on their way to become candidates, which take sixteen times as much memory. */
#ifndef ASJ_SRC_PAIR_LIST_H
#define ASJ_SRC_PAIR_LIST_H

#include "candidate.h"
#include "core/context.h"

typedef struct asj_pair_list {
    uint32_t (*pairs)[2]; /* L-junctions of image 1 and 2, in any order; some may be there twice */
    size_t count, capacity;
} asj_pair_list;

asj_status asj_pair_list_add(asj_context *context, asj_pair_list *list, uint32_t i, uint32_t j);

/* One candidate of each pair, in order, in a list that has room for as many more. `count`: L-junctions of image 1. The caller is
 * asked on behalf of `stage`. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED; then there are none. */
asj_status asj_pair_list_candidates(asj_context *context, const asj_pair_list *list, uint32_t count, size_t more, int32_t stage,
                                    asj_candidates *candidates);

#endif
