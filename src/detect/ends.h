/* SPDX-License-Identifier: BSD-2-Clause */
/* After step 5: branches that end near a junction end at it. */
#ifndef ASJ_SRC_ENDS_H
#define ASJ_SRC_ENDS_H

#include "hypothesis.h"

/* Moves the ends of branches onto junctions that lie on their line within `reach` px of the end, and tells which end at one. `order` is scratch for `count`
 * elements. */
void asj_ends_snap(asj_hypothesis *hypotheses, size_t count, double reach, const asj_hypothesis **order);

#endif
