/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_MOTIONS_H
#define ASJ_SRC_GEOMETRY_MOTIONS_H

#include "core/context.h"
#include "search.h"

/* Essential matrices with planes, from those among the `count` finalists and from the homographies among them: motions.c. They take
 * the place of the essential matrices; `finalists` has room for 2 ASJ_FINALISTS, or where all of them are essential matrices, of
 * which come no more than there are, for these. So many of the best are settled (posterior.c): all that are of use, or 0. */
#define ASJ_SETTLED 3
asj_status asj_refine_motions(asj_context *context, const asj_pairs *set, const asj_camera cameras[2], uint64_t seed,
                              int32_t settled, asj_model *finalists, int32_t *count);

#endif
