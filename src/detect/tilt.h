/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: branches that cross edges instead of following one. */
#ifndef ASJ_SRC_TILT_H
#define ASJ_SRC_TILT_H

#include "hypothesis.h"
#include "strip.h"

/* Whether a strip with these sums crosses edges at an angle of more than max_tilt. Never when that option is 0. */
int asj_is_tilted(const asj_detect_options *options, const asj_strip_sums *sums);

/* How much it does: tan phi times rho (tilt.c), in tan max_tilt. 0 when that option is. */
double asj_tilt(const asj_detect_options *options, const asj_strip_sums *sums);

/* Turns a branch that is tilted to the edges that it crosses, if it then follows one. `first`, `last`: px along it where a line is
 * fitted. */
void asj_turn_to_edge(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                      const asj_hypothesis *hypothesis, double first, double last, asj_hypothesis_branch *branch);

#endif
