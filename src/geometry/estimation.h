/* SPDX-License-Identifier: BSD-2-Clause */
/* One estimation, which its steps hand on (geometry.c lists them). */
#ifndef ASJ_SRC_GEOMETRY_ESTIMATION_H
#define ASJ_SRC_GEOMETRY_ESTIMATION_H

#include "adjust.h"
#include "focal.h"
#include "picture_agreement.h"
#include "search.h"

#define ASJ_MOST_KINDS 3
#define ASJ_TILED 4 /* tiled_motions.c */
/* The last three: with a focal length that was found. One: a camera that only turns. */
#define ASJ_MOST_MODELS ((2 * ASJ_MOST_KINDS + 3) * ASJ_FINALISTS + 1 + ASJ_TILED)

/* One of two geometries that are compared (contradiction.h). */
typedef struct asj_compared {
    const asj_model *model;
    double *probability;     /* of each candidate, under it */
    int32_t is_seen;         /* somebody has looked at the pictures through it; of the other one, when that is asked for */
    asj_agreement agreement; /* of the pictures with it; 0 and 0: nobody has shown them, or has looked */
} asj_compared;

/* One call. */
typedef struct asj_estimation {
    asj_context *context;
    const asj_geometry_options *options;
    asj_pairs set;
    asj_model finalists[ASJ_MOST_MODELS]; /* and their rivals */
    int32_t count;
    int32_t again; /* 1: these were found when they were looked for once more */
    asj_adjust_scratch scratch;
    asj_compared first, other; /* contradiction.h */
    double *elsewhere; /* of each candidate: how sure `first` is that its places are matched with something else */
    double *vote;  /* colour_vote.c, contradiction.c: four numbers of each place */
    asj_pictures *pictures; /* NULL: nobody has shown them. Their looks are of `first` and of `other` */
    asj_focal_search *focal_search; /* NULL: nobody asks for it */
    asj_focal focal;
    asj_focal rotation_focal; /* the same, of a camera that only turns */
    int32_t focal_at; /* where the finalist that has told the focal length stands; -1 = there is none */
} asj_estimation;

/* Both cameras as they are known, or have become known with the focal length; NULL = they are not. */
const asj_camera *asj_estimation_cameras(const asj_estimation *e);

/* The search for a kind. Cameras that are not known have the longer side as focal length, of the image as it is with square pixels.
 * `again`: with other samples, and more. */
asj_search asj_estimation_plan(const asj_estimation *e, int32_t kind, int32_t again);

/* Makes another finalist with the focal length the one that tells it. ASJ_ERROR_MEMORY. */
asj_status asj_estimation_refocus(asj_estimation *e, int32_t number);

/* posterior.c: without that nothing is known of how exact its motion is. ASJ_ERROR_MEMORY. */
asj_status asj_estimation_settle(const asj_estimation *e, asj_model *model);

/* Is a finalist's focal length found? */
int32_t asj_has_found_focal(const asj_estimation *e, int32_t number);

/* The finalist with the largest evidence of those that stand, of a kind or of any (ASJ_GEOMETRY_AUTO); -1 when there is none. */
int32_t asj_estimation_best(const asj_estimation *e, int32_t kind);

/* .. of a camera that only turns. */
int32_t asj_estimation_best_rotation(const asj_estimation *e);

/* Does a camera that only turns explain more than any motion among the finalists, and the same matches? Only then it is one. */
int32_t asj_estimation_is_outdone(asj_estimation *e, const asj_model *rotation);

/* log10 of how many such geometries chance brings. */
double asj_estimation_log10_nfa(const asj_estimation *e, const asj_model *m);

/* May chance be ruled out? Of what is hardly more than chance by itself that depends on the pictures, where there are some. */
int32_t asj_estimation_counts(const asj_estimation *e, int32_t number);

/* log10 of how often chance brings pictures that agree so well: 0 to -ASJ_MOST_BY_PICTURES. */
#define ASJ_MOST_BY_PICTURES 3.0
double asj_estimation_log10_agreement(asj_agreement agreement);

#endif
