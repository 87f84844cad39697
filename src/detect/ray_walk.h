/* SPDX-License-Identifier: BSD-2-Clause */
/* One ray of step 4, step by step: which arc decides next, and what follows from it. */
#ifndef ASJ_SRC_RAY_WALK_H
#define ASJ_SRC_RAY_WALK_H

#include "nfa.h"
#include "ray.h"

#define ASJ_RAY_REOPEN 3 /* steps in a row that must look ahead again after a crossing; one or two happen by chance in noise */
#define ASJ_RAY_STRIDE 4 /* steps to the next one that is looked at, while nothing fails */
#define ASJ_RAY_PLAIN 4  /* steps before the end of a plain edge that are looked at all the same: there the branch may end */

/* A ray in whole numbers, as it is walked along. */
typedef struct asj_ray_direction {
    int64_t x, y;   /* start of the ray, 1/65536 px */
    int64_t ux, uy; /* its unit vector, 2^-30 */
    uint16_t angle; /* 1/65536 of a turn */
} asj_ray_direction;

#define ASJ_ARC_LANES 8 /* places for the samples of an arc, at most ASJ_MAX_ARC of which are used */

/* The samples of an arc: their pixels, and cosine and sine of the directions a_d to them, 1 = 16384. */
typedef struct asj_arc {
    int32_t x[ASJ_ARC_LANES], y[ASJ_ARC_LANES];
    int16_t unit[ASJ_ARC_LANES][2];
} asj_arc;

/* The local junctions there. */
typedef asj_field_branch asj_arc_branches[ASJ_ARC_LANES][ASJ_FIELD_BRANCHES];

/* Sums over the arc at one radius. */
typedef struct asj_arc_sums {
    int32_t forward, ahead, axial; /* of the forward branches; of those among them that point ahead; of the axial branches */
} asj_arc_sums;

/* Passes and failures in a row along a ray so far. */
typedef struct asj_ray_progress {
    int32_t forward_failures, ahead_passes, ahead_failures, axial_failures;
} asj_ray_progress;

typedef struct asj_ray_walk {
    asj_ray *ray;
    asj_ray_direction way;
    int32_t r;       /* the step to take */
    int32_t looked;  /* the last step that is taken by itself, since a stride to it has failed */
    int missed;      /* a stride of a rough scan has failed */
    int strides;     /* whether the arc asked for is some steps ahead */
    asj_arc_sums far; /* of the arc at `looked` */
    asj_ray_progress progress;
} asj_ray_walk;

void asj_ray_walk_start(asj_ray *ray, asj_ray_walk *walk);

/* The radius of the next arc to sum. */
int32_t asj_ray_walk_next(const asj_scan *scan, const asj_frame *frame, asj_ray_walk *walk);

/* Operations (core/ops.h). */
typedef struct asj_arc_ops {
    /* The samples of the arc at radius r, 2 half_width + 1 of them; other places may be written to. */
    void (*place)(const asj_scan *scan, const asj_ray_direction *way, int32_t r, asj_arc *arc);
    /* The sums of an arc; branches[i]: the local junction at sample i, all of strength 0 outside the image and in places that are
     * not used. */
    void (*sum)(const asj_scan *scan, const asj_ray_direction *way, const asj_arc *arc, asj_arc_branches branches,
                asj_arc_sums *sums);
} asj_arc_ops;
extern const asj_arc_ops asj_arc_reference;

/* Takes the arc that asj_ray_walk_next() asked for; 0 when the ray ends, whose lengths are set then. */
int asj_ray_walk_take(const asj_scan *scan, const asj_arc_sums *sums, asj_ray_walk *walk);

asj_ray_direction asj_ray_walk_direction(const asj_ray *ray);

/* The last step of a walk: the axial length ends no farther beyond the forward one than a crossing may be bridged. */
void asj_ray_walk_finish(const asj_scan *scan, asj_ray *ray);

#endif
