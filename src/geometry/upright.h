/* SPDX-License-Identifier: BSD-2-Clause */
/* Which way is up. */
#ifndef ASJ_SRC_GEOMETRY_UPRIGHT_H
#define ASJ_SRC_GEOMETRY_UPRIGHT_H

#include "model.h"

/* Does the geometry turn a room that stands upright in both images on its side, or further? upright.c. cameras: where they are
 * known, or NULL. */
int32_t asj_turns_over(const asj_pairs *set, const asj_model *model, const asj_camera cameras[2]);

#endif
