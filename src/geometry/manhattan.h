/* SPDX-License-Identifier: BSD-2-Clause */
/* What the directions of two images' edges say of the rotation between them. */
#ifndef ASJ_SRC_GEOMETRY_MANHATTAN_H
#define ASJ_SRC_GEOMETRY_MANHATTAN_H

#include "directions.h"
#include "likelihood.h"

/* Makes set->rotations, none when one image has no directions. 0: no memory. */
int32_t asj_manhattan_rotations(asj_memory *memory, const asj_directions_list directions[2], asj_pairs *set);

/* Directions that a caller gives (rows), as exact as those of images are; none when they are zero. */
void asj_directions_given(const double directions[9], asj_directions_list *list);

/* Which of set->rotations is the likeliest at R, and w with exp([w]x) R = that one; -1 when none is near enough to say anything. */
int32_t asj_nearest_rotation(const asj_pairs *set, const double rotation[9], double w[3]);

/* Log of the density of rotations at R over the flat one; 0 without rotations. */
double asj_rotation_prior(const asj_pairs *set, const double rotation[9]);

/* The pull of the likeliest one: adds to the normal equations of the turn w (rows of n parameters). */
void asj_add_rotation_prior(const asj_pairs *set, const double rotation[9], int32_t n, double *normal, double *right);

#endif
