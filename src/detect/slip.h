/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: branches that slip from one edge to the next. */
#ifndef ASJ_SRC_SLIP_H
#define ASJ_SRC_SLIP_H

#include "edge_rows.h"
#include "hypothesis.h"

/* px from the junction to where the branch, along its line, still follows the edge that it begins with; its length when it does so
 * all the way. */
double asj_slip_length(const asj_edge_ops *ops, const asj_frame *frame, const asj_hypothesis *hypothesis,
                       const asj_hypothesis_branch *branch);

#endif
