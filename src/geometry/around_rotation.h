/* SPDX-License-Identifier: BSD-2-Clause */
/* A motion with another rotation: around_rotation.c. */
#ifndef ASJ_SRC_GEOMETRY_AROUND_ROTATION_H
#define ASJ_SRC_GEOMETRY_AROUND_ROTATION_H

#include "adjust.h"

/* Translation and planes follow the model's rotation, which stays: with the candidates that `like`, a motion with as many planes,
 * explains, then with its own. The model's score is not that of the result. */
void asj_adjust_around_rotation(const asj_pairs *set, asj_model *model, const asj_model *like, asj_adjust_scratch *scratch);

#endif
