/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_ASSIGN_H
#define ASJ_SRC_ASSIGN_H

#include "consensus.h"

/* A candidate that was chosen. */
typedef struct asj_choice {
    uint32_t candidate; /* index into the list */
    float ratio;        /* score over that of the best at another place; HUGE_VALF when there is none */
} asj_choice;

/* Chooses matches by score: see assign.c. choices has room for every place of image 1; *count receives how many there are. */
asj_status asj_assign(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                      const asj_candidates *candidates, asj_choice *choices, size_t *count);

#endif
