/* SPDX-License-Identifier: BSD-2-Clause */
/* One motion at all focal lengths. */
#ifndef ASJ_SRC_GEOMETRY_FOCAL_PROFILE_H
#define ASJ_SRC_GEOMETRY_FOCAL_PROFILE_H

#include "adjust.h"
#include "focal_prior.h"

#define ASJ_FOCAL_REACH 24 /* steps to either side */

/* A motion at the focal length that explains most. */
typedef struct asj_focal {
    asj_model model;     /* its evidence is the mean over all focal lengths; -HUGE_VAL when there is none */
    double along[6];     /* how rotation (vector, rad) and translation differ when f is longer by one standard deviation */
    double sd;           /* of the log of the focal length */
    double log_share;    /* what other motions' evidence at that focal length counts more, or less, as a mean over all of them */
    int32_t is_known;    /* sd is small enough */
} asj_focal;

typedef struct asj_focal_profile {
    asj_context *context;
    asj_pairs *set;              /* with the rotations of the focal length at hand */
    const asj_focal_prior *prior;
    const double *branches;      /* asj_geometry_hints */
    uint64_t seed;
    asj_adjust_scratch *scratch; /* for each thread; the first one serves where there is one only */
    asj_status status;           /* what went wrong on the way */
    double step;                 /* of the log of the focal length */
    asj_model at[2 * ASJ_FOCAL_REACH + 1];
    int32_t has[2 * ASJ_FOCAL_REACH + 1];
} asj_focal_profile;

/* Nats of evidence by which one focal length excludes another one, where the best one has that much: focal_profile.c. */
double asj_focal_excludes(double evidence);

/* The set with the directions that edges have at a focal length. profile->status, which is returned, tells when memory fails. */
asj_status asj_focal_turn(asj_focal_profile *profile, double factor);

/* Follows an essential matrix to longer and shorter focal lengths, and says of it what asj_focal says. tells: 0 where the motion
 * cannot tell a focal length, so that only edges do, and what was known before. The set is turned to the focal length found. */
asj_status asj_focal_follow(asj_focal_profile *profile, const asj_model *start, int32_t tells, asj_focal *found);

#endif
