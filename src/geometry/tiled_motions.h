/* SPDX-License-Identifier: BSD-2-Clause */
/* Motions that tiles allow: tiled_motions.c. */
#ifndef ASJ_SRC_GEOMETRY_TILED_MOTIONS_H
#define ASJ_SRC_GEOMETRY_TILED_MOTIONS_H

#include "estimation.h"

/* Of finalist `best`, where the pictures do not agree with it: those with which they agree well, the most evidence first.
 * `motions` has room for ASJ_TILED; *count may be 0. ASJ_ERROR_MEMORY. */
asj_status asj_find_tiled_motions(asj_estimation *e, int32_t best, asj_model *motions, int32_t *count);

#endif
