/* SPDX-License-Identifier: BSD-2-Clause */
/* What the directions of two images' edges say of the rotation between them. */
#ifndef ASJ_SRC_GEOMETRY_MANHATTAN_H
#define ASJ_SRC_GEOMETRY_MANHATTAN_H

#include "likelihood.h"

/* Fills set->rotations from three directions at right angles of each image (rows); none when one of them is zero. */
void asj_manhattan_rotations(const double directions[2][9], asj_pairs *set);

/* Which of set->rotations is nearest, and the rotation w with exp([w]x) R = it; -1 when none is near enough to say anything. */
int32_t asj_nearest_rotation(const asj_pairs *set, const double rotation[9], double w[3]);

/* Log of the density of rotations at R over the flat one; *information: what it adds to that of each of the three angles. 0 and 0
 * without rotations. */
double asj_rotation_prior(const asj_pairs *set, const double rotation[9], double *information);

#endif
