/* SPDX-License-Identifier: BSD-2-Clause */
/* Planes in a motion, and motions of a plane: planes.c. */
#ifndef ASJ_SRC_GEOMETRY_PLANES_H
#define ASJ_SRC_GEOMETRY_PLANES_H

#include "adjust.h"

/* The motions of a homography between known cameras, each with its plane: none (a camera that only turns), one or two. `set` says
 * what is seen. */
int32_t asj_motions_of_homography(const asj_pairs *set, const asj_model *homography, const asj_camera cameras[2],
                                  asj_model motions[2]);

/* The rotations of these alone; 0 or 2, a mirror perhaps. */
int32_t asj_rotations_of_homography(const asj_model *homography, const asj_camera cameras[2], double rotations[2][9]);

/* Adds planes to an essential matrix as long as its evidence rises. evidence, score and view are those of the result. */
void asj_add_planes(const asj_pairs *set, asj_model *model, asj_adjust_scratch *scratch);

#endif
