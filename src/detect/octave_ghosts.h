/* SPDX-License-Identifier: BSD-2-Clause */
/* Junctions of coarse octaves that finer ones contradict. */
#ifndef ASJ_SRC_OCTAVE_GHOSTS_H
#define ASJ_SRC_OCTAVE_GHOSTS_H

#include "octave_grid.h"

/* 1 when too few of its branches begin at the hypothesis, since the others begin at junctions of finer octaves: see
 * octave_ghosts.c. */
int asj_octave_ghost(const asj_octave_grid *grid, const asj_hypothesis *hypotheses, const asj_hypothesis *hypothesis,
                     double minimum_opening);

#endif
