/* SPDX-License-Identifier: BSD-2-Clause */
/* The short list: for each L-junction of either image its best partners in the other one. */
#ifndef ASJ_SRC_SHORTLIST_H
#define ASJ_SRC_SHORTLIST_H

#include "compare.h"

/* A partner of an L-junction: its score (candidate.h) and its index; of equal scores the smaller index comes first. */
typedef struct asj_partner {
    int32_t score;           /* ASJ_NO_PARTNER = none */
    uint32_t index;
} asj_partner;

/* Fills run->candidates: the union of all lists, compared; pairs without a map are dropped. */
asj_status asj_shortlist(asj_match_run *run);

/* rank.c, the part of it that back ends replace: the options->shortlist best partners of L-junction i of image 1 from
 * rows[i * shortlist] on, of j of image 2 from columns[j * shortlist] on, best first; the lists come in empty. */
asj_status asj_rank_partners(const asj_match_run *run, asj_partner *rows, asj_partner *columns);

/* Operations (core/ops.h); a device replaces it. */
typedef struct asj_rank_ops {
    asj_status (*partners)(const asj_match_run *run, asj_partner *rows, asj_partner *columns); /* asj_rank_partners() */
} asj_rank_ops;
extern const asj_rank_ops asj_rank_reference; /* rank.c */

#endif
