/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_PEAK_H
#define ASJ_SRC_GEOMETRY_PEAK_H

#include "adjust.h"

/* Moves an essential matrix, or the turn of a camera, that has been adjusted on to the peak of what the candidates say: peak.c.
 * Its evidence stays what it was. */
void asj_climb(const asj_pairs *set, asj_model *model, asj_adjust_scratch *scratch);

#endif
