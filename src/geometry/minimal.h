/* SPDX-License-Identifier: BSD-2-Clause */
/* Geometries from two or three affine correspondences. */
#ifndef ASJ_SRC_MINIMAL_H
#define ASJ_SRC_MINIMAL_H

#include "model.h"

/* The rays of the k-th (0 .. 2) of the three pairs of points that a correspondence stands for: see minimal.c. */
void asj_rays_beside(const asj_pair *c, const asj_camera cameras[2], int32_t k, double ray1[3], double ray2[3]);

/* Essential matrix and motion from two candidates: see minimal.c. 0 when none agrees with both. */
int32_t asj_essential_from_two(const asj_pairs *set, const asj_pair *const pairs[2], const asj_camera cameras[2], asj_model *model);

/* The same where the rotation is known. */
int32_t asj_translation_from_two(const asj_pair *const pairs[2], const double rotation[9], const asj_camera cameras[2],
                                 asj_model *model);

/* Fundamental matrix from three candidates, homography from two. 0 when they do not determine it, or contradict it. */
int32_t asj_fundamental_from_three(const asj_pair *const pairs[3], const asj_camera cameras[2], asj_model *model);
int32_t asj_homography_from_two(const asj_pairs *set, const asj_pair *const pairs[2], const asj_camera cameras[2],
                                asj_model *model);

#endif
