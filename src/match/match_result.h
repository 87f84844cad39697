/* SPDX-License-Identifier: BSD-2-Clause */
/* Chosen candidates as the caller sees them. */
#ifndef ASJ_SRC_MATCH_RESULT_H
#define ASJ_SRC_MATCH_RESULT_H

#include "around.h"
#include "match_run.h"
#include "unstretch.h"

/* Turns the choices into a result, smallest distance first; on failure it is NULL. The result does not depend on the context
 * afterwards. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_match_result_create(const asj_match_run *run, asj_match_result **shown);

/* The matches, and where they are; without places for a result that the caller has put together or copied, and for one whose
 * matches are no longer those of the call. */
asj_around asj_match_result_around(const asj_match_result *shown);

/* The accepted geometry of two images, for other matches of theirs. */
typedef struct asj_known_geometry {
    asj_judge judge;
    double farthest;    /* px from its epipolar line that a match may be .. */
    int32_t lines_hold; /* .. if anything follows from that (verdict.c) */
} asj_known_geometry;

/* NULL where there is none, and for stretched images. Of a result of asj_match_result_create(). */
const asj_known_geometry *asj_match_result_geometry(const asj_match_result *shown);

/* Takes the matches whose probability is negative to the rejected ones; others have theirs from now on. ASJ_ERROR_MEMORY. */
asj_status asj_match_result_judge(asj_context *context, asj_match_result *shown, const float *probability);

/* Numbers the L-junctions of image 1 (side 0) or 2 as asj_decompose() does those of all junctions, where the result knows those of
 * octaves 0 and up alone. ASJ_ERROR_MEMORY. */
asj_status asj_match_result_number(asj_context *context, asj_match_result *shown, int32_t side, double minimum_opening,
                                   const asj_junction *junctions, size_t count);

/* A result of stretched images -> one of the images themselves (unstretch.h). */
void asj_match_result_unstretch(asj_match_result *shown, const asj_stretch by[2]);

#endif
