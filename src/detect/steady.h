/* SPDX-License-Identifier: BSD-2-Clause */
/* After step 5: whether a junction would be found again. */
#ifndef ASJ_SRC_STEADY_H
#define ASJ_SRC_STEADY_H

#include "core/image.h"
#include "hypothesis.h"
#include "strip.h"

/* Drops what would hardly be found again in the same picture at another size: branch_count becomes 0. Of what stays it drops
 * branches that cross edges (tilt.h) and make no such junction with another one. `known`: the strips of its branches
 * (asj_strip_test()), or NULL. */
void asj_keep_steady(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                     const asj_strip *known, asj_hypothesis *hypothesis);

#endif
