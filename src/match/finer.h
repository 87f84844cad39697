/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches of junctions of octave -1, in the enlarged images, where they hold. */
#ifndef ASJ_SRC_FINER_H
#define ASJ_SRC_FINER_H

#include "match_result.h"

/* Whether some are of octave -1. */
int32_t asj_has_finer(const asj_junction *junctions, size_t count);

/* Matches two images once: `enlarged` says whether those that have junctions of octave -1 are looked at enlarged; otherwise such
 * junctions are none. Results are in pixels of the images. */
typedef asj_status (*asj_match_pass)(asj_context *context, const asj_match_options *options, const void *data, int32_t enlarged,
                                     asj_match_result **result);

typedef struct asj_finer_match {
    asj_match_pass pass;
    const void *data;                 /* for it */
    const asj_junction *junctions[2]; /* all of both images */
    size_t counts[2];
} asj_finer_match;

/* The passes that are needed, and the result that holds: see finer.c. */
asj_status asj_match_finer(asj_context *context, const asj_match_options *options, const asj_finer_match *match,
                           asj_match_result **result);

#endif
