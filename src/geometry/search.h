/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_SEARCH_H
#define ASJ_SRC_GEOMETRY_SEARCH_H

#include "core/context.h"
#include "adjust.h"

#define ASJ_FINALISTS 15
#define ASJ_TURNED 8

typedef struct asj_search {
    int32_t kind;
    int32_t samples;
    uint64_t seed;
    asj_camera cameras[2];
    double least; /* nats: when no geometry reaches this score at first sight, there is none */
    const double *weights; /* NULL, or how much of its prior each candidate is drawn by */
    int32_t brief;         /* 1 = fewer of the best samples are followed, and sampled around once only */
} asj_search;

/* The best geometries of the kind, refined, the best score first; finalists has room for ASJ_FINALISTS. *count may be 0. */
asj_status asj_geometry_search(asj_context *context, const asj_pairs *set, const asj_search *search, asj_model *finalists,
                               int32_t *count);

/* The same, unjudged, of the essential matrices with one of set->rotations, which must be there, but for those near `except` (NULL:
 * none): the best of each, so that none crowds out the others; finalists has room for ASJ_TURNED. */
asj_status asj_geometry_search_turned(asj_context *context, const asj_pairs *set, const asj_search *search, const double *except,
                                      asj_model *finalists, int32_t *count);

#endif
