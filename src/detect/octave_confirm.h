/* SPDX-License-Identifier: BSD-2-Clause */
/* Whether the image shows what one of its octaves has. */
#ifndef ASJ_SRC_OCTAVE_CONFIRM_H
#define ASJ_SRC_OCTAVE_CONFIRM_H

#include "hypothesis.h"

/* Drops branches that the grey plane of the image does not show where they begin, and rejects the hypothesis when no two open by
 * minimum_opening, degrees, any more. All in px of the image. */
void asj_octave_confirm(const asj_frame *frame, double minimum_opening, asj_hypothesis *hypothesis);

#endif
