/* SPDX-License-Identifier: BSD-2-Clause */
/* Line segments of matches: which ends of two matched branches correspond. */
#ifndef ASJ_SRC_SEGMENTS_H
#define ASJ_SRC_SEGMENTS_H

#include "match_run.h"

/* Lengths of a matched branch in both images that show the same part of it. */
typedef struct asj_common_end {
    double length1, length2; /* px */
    int32_t kind;            /* ASJ_END_... */
} asj_common_end;

/* branch: 0 = a, 1 = b. */
asj_common_end asj_find_common_end(const asj_match_run *run, const asj_candidate *c, int32_t branch);

#endif
