/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: orientations and location over the whole length of the branches. */
#ifndef ASJ_SRC_REFINE_H
#define ASJ_SRC_REFINE_H

#include "hypothesis.h"

/* Orients the branches of a junction by the edge under their whole length (they have been scanned). With line fits the junction
 * moves to where the new lines meet. */
void asj_refine(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis);

/* The same with quick fits (asj_line_guess), good enough to scan along; branches that cross edges are turned to them (tilt.c). */
void asj_orient(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis);

#endif
