/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: orientations and location over the whole length of the branches, and validation. */
#ifndef ASJ_SRC_REFINE_H
#define ASJ_SRC_REFINE_H

#include "draft.h"

/* Orients the branches of a junction by the edge under their whole length (they have been scanned). With line fits the junction
 * moves to where the new lines meet. */
void asj_refine(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft);

/* The same with quick fits (asj_line_guess), good enough to scan along. */
void asj_orient(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft);

/* Drops branches that asj_validate() would drop whatever their length, before they are scanned; branch_count becomes 0 when no two
 * that open enough are left. */
void asj_foresee(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft);

/* Drops branches that are too short, off the junction, not meaningful, or twins of a better one; branch_count becomes 0 when no two
 * branches open enough. Sorts the branches by angle. */
void asj_validate(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft);

#endif
