/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5 as in the paper: the orientation of strongest junction-ness. */
#ifndef ASJ_SRC_SEARCH_H
#define ASJ_SRC_SEARCH_H

#include "hypothesis.h"

/* Turns each branch of a junction, whose lengths are known, to the angle within 0.1 rad at which its sector is strongest. */
void asj_search_orientation(const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis);

#endif
