/* SPDX-License-Identifier: BSD-2-Clause */
/* Other geometries that explain the same images. */
#ifndef ASJ_SRC_GEOMETRY_RIVALS_H
#define ASJ_SRC_GEOMETRY_RIVALS_H

#include "search.h"

/* Geometries that explain the images without the candidates of `best`: rivals.c. One search for each kind in `kinds`, kind_count of
 * them; cameras: NULL, or where essential matrices are searched. `rivals` has room for (1 + kind_count) ASJ_FINALISTS +
 * ASJ_TURNED. */
asj_status asj_find_rivals(asj_context *context, asj_pairs *set, const asj_search *kinds, int32_t kind_count,
                           const asj_camera *cameras, const asj_model *best, asj_model *rivals, int32_t *count);

#endif
