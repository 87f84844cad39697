/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_PAIRS_H
#define ASJ_SRC_GEOMETRY_PAIRS_H

#include "core/context.h"
#include "estimate.h"
#include "likelihood.h"

/* Checks the candidates and brings them into order, the likeliest ASJ_MOST_PAIRS: places from 0 on, priors of a place at most 0.9
 * in sum. hints may be NULL. set is to be freed, whatever is returned. */
#define ASJ_MOST_PAIRS 3000
asj_status asj_pairs_create(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                            const asj_geometry_hints *hints, const asj_geometry_options *options, asj_pairs *set);
/* Other directions than before, seen by these cameras, and what branches (asj_geometry_hints; NULL = not known) point along. The
 * densities of rotations are taken times exp(log_share). ASJ_ERROR_MEMORY. */
asj_status asj_pairs_turn(asj_context *context, const asj_directions_list directions[2], const double *branches,
                          const asj_camera cameras[2], double log_share, asj_pairs *set);
void asj_pairs_free(asj_memory *memory, asj_pairs *set);

#endif
