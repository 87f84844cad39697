/* SPDX-License-Identifier: BSD-2-Clause */
/* Junctions of several octaves at one corner: what they make of support, and which of their matches stays. */
#ifndef ASJ_SRC_SAME_CORNER_H
#define ASJ_SRC_SAME_CORNER_H

#include "match_run.h"

/* Of choices of different octaves, from number `first` on, those stay that have the support which these need, and of those at one
 * corner, in either image, the finest; those before it stay. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_same_corner(asj_match_run *run, size_t first);

#endif
