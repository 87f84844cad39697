/* SPDX-License-Identifier: BSD-2-Clause */
/* A focal length that nobody knows, found with the motion: focal.c. */
#ifndef ASJ_SRC_GEOMETRY_FOCAL_H
#define ASJ_SRC_GEOMETRY_FOCAL_H

#include "core/context.h"
#include "search.h"

/* The motion at the focal length that explains most. */
typedef struct asj_focal {
    asj_model model;     /* its evidence is the mean over all focal lengths; -HUGE_VAL when there is none */
    double along[6];     /* how rotation (vector, rad) and translation differ when f is longer by one standard deviation */
    double sd;           /* of the log of the focal length */
    int32_t is_known;    /* sd is small enough */
    int32_t reserved;
} asj_focal;

/* flat: homographies that were found already, `count` of them at most ASJ_FINALISTS, whose motions are tried too. search: samples,
 * seed and least count; of its cameras the principal points, and the focal lengths as the longer sides. */
asj_status asj_find_focal(asj_context *context, const asj_pairs *set, const asj_search *search, const asj_model *flat,
                          int32_t count, asj_focal *found);

#endif
