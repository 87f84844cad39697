/* SPDX-License-Identifier: BSD-2-Clause */
/* The caller may stop the estimation. Loops then leave out what takes time, but leave numbers that can be sorted and looked up, as
 * they do for models that are impossible; the result is thrown away at the end. */
#ifndef ASJ_SRC_GEOMETRY_STOP_H
#define ASJ_SRC_GEOMETRY_STOP_H

#include "candidates.h"
#include "core/watch.h"

static inline int asj_pairs_stop(const asj_pairs *set, const asj_part *part)
{
    return set->watch && asj_watch_stops(set->watch, part);
}

#endif
