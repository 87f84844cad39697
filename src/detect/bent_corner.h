/* SPDX-License-Identifier: BSD-2-Clause */
/* Lines that were fitted to the bent edges of a blurred corner, put where its edges would be without the blur. */
#ifndef ASJ_SRC_BENT_CORNER_H
#define ASJ_SRC_BENT_CORNER_H

#include "hypothesis.h"

#define ASJ_BENT_FROM 1.1 /* px: width of an edge. Sharper ones bend by less than can be seen */

/* Where a branch's line was fitted: px along it from the hypothesis's place, and px to either side. */
typedef struct asj_fitted_part {
    double first, last, half_width;
} asj_fitted_part;

/* For a hypothesis of two soft branches whose lines were fitted over `parts` and that has been moved to where they meet: moves it,
 * and turns the branches, to the corner whose blurred edges would have given these lines. Others stay as they are. */
void asj_bent_corner(const asj_fitted_part *parts, asj_hypothesis *hypothesis);

#endif
