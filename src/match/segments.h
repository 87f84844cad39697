/* SPDX-License-Identifier: BSD-2-Clause */
/* Line segments of matches: which ends of two matched branches correspond. */
#ifndef ASJ_SRC_SEGMENTS_H
#define ASJ_SRC_SEGMENTS_H

#include "around.h"
#include "l_junctions.h"

/* Lengths of a matched branch in both images that show the same part of it. */
typedef struct asj_common_end {
    double length[2]; /* px, from the junctions as detected */
    int32_t kind;     /* ASJ_END_... */
} asj_common_end;

/* lengths: the branch's in either image, its own first. tolerance: asj_match_options.end_tolerance. */
asj_common_end asj_find_common_end(const asj_around *around, const asj_matched_branch *branch, const asj_lengths *const lengths[2],
                                   double tolerance);

#endif
