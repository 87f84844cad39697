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
    uint32_t number;         /* support.h knows it by: 1, 2, ...; 0 = not yet */
} asj_candidate;

typedef struct asj_candidates {
    asj_candidate *list;     /* by i, then j */
    size_t count, capacity;
} asj_candidates;

/* One image as the distances need it. */
typedef struct asj_view {
    asj_pyramid pyramid;
    asj_corners corners;
    int16_t *patches;        /* canonical: `length` numbers for each frame; unit vectors unless option normalise is no */
    uint8_t *usable;         /* of each frame: its patch lies in the image */
    uint64_t device_copy;    /* names what a device keeps of them; 0 = nothing */
} asj_view;

/* A partner of an L-junction. Scores are whole numbers, the larger the better (distance.c); of equals the smaller index. */
#define ASJ_NO_PARTNER INT32_MIN
typedef struct asj_partner {
    int32_t score;           /* ASJ_NO_PARTNER = none */
    uint32_t index;
} asj_partner;

/* Numbers in a described patch; whether they are unit vectors. */
int32_t asj_patch_length(const asj_match_options *options);
int32_t asj_patch_units(const asj_match_options *options);

/* Fills view->patches (canonical patches only). */
asj_status asj_describe(asj_context *context, const asj_match_options *options, asj_view *view);
/* The part of it that back ends replace: patches and usable are allocated. */
asj_status asj_describe_frames(asj_context *context, const asj_match_options *options, asj_view *view);

/* The short list: for each L-junction of either image its options->shortlist best partners. */
asj_status asj_shortlist(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         asj_candidates *candidates);
/* rank.c, the part of it that back ends replace: the options->shortlist best partners of L-junction i of image 1 from
 * rows[i * shortlist] on, of j of image 2 from columns[j * shortlist] on, best first; the lists come in empty. */
asj_status asj_rank_partners(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                             asj_partner *rows, asj_partner *columns);

/* The best pair of frames of a pair of L-junctions and its score; ASJ_NO_PARTNER when there is none that can be used. */
int32_t asj_best_frames(const asj_match_options *options, const asj_view *view1, const asj_view *view2, uint32_t i, uint32_t j,
                        uint32_t *frame1, uint32_t *frame2);

/* Fills distance2 and map of the pair candidate->i, candidate->j from the best pair of frames. Returns 0 when the pair gives no
 * map. */
int32_t asj_compare(const asj_match_options *options, const asj_view *view1, const asj_view *view2, asj_candidate *candidate);

/* Sorts by i, then j; of equal pairs one stays. */
asj_status asj_candidates_sort(asj_candidates *candidates);

/* induced.c: fills view->patches and view->usable with the squares around the L-junctions, one for each. */
asj_status asj_induced_describe(asj_context *context, const asj_match_options *options, asj_view *view);

/* induced.c: the paper's distance of a pair, whose views are described so; HUGE_VALF when its map leaves the image. */
float asj_induced_distance(const asj_match_options *options, const asj_view *view1, const asj_view *view2, uint32_t i, uint32_t j);

/* Operations (core/ops.h), both of which a device replaces. */
typedef struct asj_describe_ops {
    asj_status (*frames)(asj_context *context, const asj_match_options *options, asj_view *view); /* asj_describe_frames() */
} asj_describe_ops;
extern const asj_describe_ops asj_describe_reference;
typedef struct asj_rank_ops {
    /* asj_rank_partners() */
    asj_status (*partners)(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                           asj_partner *rows, asj_partner *columns);
} asj_rank_ops;
extern const asj_rank_ops asj_rank_reference; /* rank.c */

#endif
