/* SPDX-License-Identifier: BSD-2-Clause */
/* Corners of two soft edges: where they would be without the blur, which bends the edges near the corner. */
#ifndef ASJ_SRC_BLURRED_CORNER_H
#define ASJ_SRC_BLURRED_CORNER_H

#include "hypothesis.h"

#define ASJ_SOFT_FROM 1.1 /* px: width of an edge. Sharper ones bend by less than can be seen */

/* For a hypothesis of two soft branches whose widths are known, lengths where they are: moves it, and turns the branches, to the
 * corner whose blurred gradient is most like that of the pixels around; says how much that explains. Returns 0, and changes nothing
 * else, when there is no such corner. */
int asj_blurred_corner(const asj_context *context, const asj_frame *frame, asj_hypothesis *hypothesis);

/* Whether it explains as much as chance does not. */
int asj_blurred_corner_is_sure(const asj_hypothesis *hypothesis);

#endif
