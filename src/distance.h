/* SPDX-License-Identifier: BSD-2-Clause */
/* Distances of all pairs of L-junctions, and the short list of the best. */
#ifndef ASJ_SRC_DISTANCE_H
#define ASJ_SRC_DISTANCE_H

#include "corners.h"
#include "patch.h"

/* A pair that may be a match. */
typedef struct asj_candidate {
    uint32_t i, j;           /* L-junctions of image 1 and 2 */
    float distance2;         /* square of the patches' distance */
    float similarity;        /* correlation of the aligned discs; 0 when not aligned */
    double move1[2], move2[2]; /* px: how far the alignment moved the junction in either image; one of the two is zero */
    asj_linear map;          /* linear part, image 1 -> image 2 */
    float support;
    float score;             /* what the choice goes by; the larger the better */
} asj_candidate;

typedef struct asj_candidates {
    asj_candidate *list;     /* by i, then j */
    size_t count, capacity;
} asj_candidates;

/* One image as the distances need it. */
typedef struct asj_view {
    asj_pyramid pyramid;
    asj_corners corners;
    int16_t *patches;        /* canonical: unit vectors, `length` numbers for each frame */
    uint8_t *usable;         /* of each frame: its patch lies in the image */
} asj_view;

/* Numbers in a described patch. */
int32_t asj_patch_length(const asj_match_options *options);

/* Fills view->patches (canonical patches only). */
asj_status asj_describe(asj_context *context, const asj_match_options *options, asj_view *view);

/* The short list: for each L-junction of either image its options->shortlist best partners. */
asj_status asj_shortlist(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         asj_candidates *candidates);

/* Fills distance2 and map of the pair candidate->i, candidate->j from the best pair of frames. Returns 0 when the pair gives no
 * map. */
int32_t asj_compare(const asj_match_options *options, const asj_view *view1, const asj_view *view2, asj_candidate *candidate);

/* Appends pairs (two numbers each), sorts by i, then j. */
asj_status asj_candidates_sort(asj_candidates *candidates);

/* induced.c: the paper's distance of a pair; HUGE_VALF when its map leaves the image. */
float asj_induced_distance(const asj_match_options *options, const asj_view *view1, const asj_view *view2, uint32_t i, uint32_t j);

#endif
