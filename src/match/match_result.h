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
    asj_judge judge;    /* of images stretched so: */
    asj_stretch by[2];
    int32_t lines_hold; /* whether anything follows from being far from an epipolar line (verdict.c) */
} asj_known_geometry;

/* NULL where there is none. Of a result of asj_match_result_create(). */
const asj_known_geometry *asj_match_result_geometry(const asj_match_result *shown);

/* What asj_match_result_create() makes is one. */
typedef struct asj_own_result {
    asj_match_result shown; /* first, so that the caller's pointer is ours */
    asj_memory memory;
    asj_junction_match *matches, *rejected;
    asj_l_junction *l1, *l2;
    asj_place *places[2]; /* of `count` matches, in image 1 and image 2 */
    uint32_t count;
    double end_tolerance;     /* asj_match_options.end_tolerance, that its ends were judged by */
    double farthest;          /* px of the images from an epipolar line that its matches may be: asj_farthest_from_line() */
    asj_known_geometry known; /* the one that is accepted, */
    int32_t is_known;         /* .. if there is one */
    int32_t hopeless;         /* was a geometry asked, and is it known that there is none? */
    int32_t has_epipolar;     /* is the fundamental matrix of the matches known (epipolar.c), */
    double epipolar[9];       /* .. of the images, by rows */
} asj_own_result;

/* asj_match_options.end_tolerance of its call; the default for a result that the caller has put together or copied, which does not
 * say. */
double asj_match_result_end_tolerance(const asj_match_result *shown);

/* px from an epipolar line that its matches may be. */
double asj_match_result_farthest(const asj_match_result *shown);

/* Is it known that the images have no geometry, so that no look like this one has to be taken for it? */
int32_t asj_match_result_is_hopeless(const asj_match_result *shown);

/* Its matches are no longer what they were: smallest distance first again, and where they are. */
void asj_match_result_sort(asj_own_result *r);

#endif
