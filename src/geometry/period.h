/* SPDX-License-Identifier: BSD-2-Clause */
/* Motions whose matches lie on a plane on which they repeat: period.c. */
#ifndef ASJ_SRC_GEOMETRY_PERIOD_H
#define ASJ_SRC_GEOMETRY_PERIOD_H

#include "model.h"

#include "core/memory.h"

/* 1: all that the motion has matched repeats; *shifted is the motion by a period more then, with the same planes, as it follows
 * from the matches, without evidence. probability: of each candidate under the motion. 0: it does not. -1: no memory. */
int32_t asj_find_period(asj_memory *memory, const asj_pairs *set, const asj_model *motion, const double *probability,
                        asj_model *shifted);

#endif
