/* SPDX-License-Identifier: BSD-2-Clause */
/* A camera that only turns: pure_rotation.c. */
#ifndef ASJ_SRC_GEOMETRY_PURE_ROTATION_H
#define ASJ_SRC_GEOMETRY_PURE_ROTATION_H

#include "core/context.h"
#include "adjust.h"

/* The best rotation K2 R K1^-1 near those of `count` models, which are unchanged, judged by its evidence; cameras: known. *found: 0
 * where there is none. ASJ_ERROR_MEMORY. */
asj_status asj_find_pure_rotation(asj_context *context, const asj_pairs *set, const asj_camera cameras[2], const asj_model *models,
                                  int32_t count, asj_model *rotation, int32_t *found);

/* Does a camera that only turns explain more than a motion, and the same matches? */
int32_t asj_rotation_outdoes(const asj_pairs *set, const asj_model *rotation, const asj_model *motion, asj_adjust_scratch *scratch);

/* How far a homography between these cameras is from a rotation: log of the largest over the smallest singular value of
 * K2^-1 H K1, 0 for a rotation. */
double asj_far_from_rotation(const asj_model *homography, const asj_camera cameras[2]);

#endif
