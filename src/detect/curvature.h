/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: arcs that look like corners. */
#ifndef ASJ_SRC_CURVATURE_H
#define ASJ_SRC_CURVATURE_H

#include "core/image.h"
#include "hypothesis.h"

/* Whether some branches open by at least `least` radians, and every two that do lie on an arc; 0 where a side is too short and soft
 * to tell. */
int asj_is_arc(const asj_frame *frame, const asj_hypothesis *hypothesis, double least);

#endif
