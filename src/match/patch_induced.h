/* SPDX-License-Identifier: BSD-2-Clause */
/* The paper's patches: squares of fixed size, carried into the other image by each pair's own map. */
#ifndef ASJ_SRC_PATCH_INDUCED_H
#define ASJ_SRC_PATCH_INDUCED_H

#include "match_run.h"

/* Fills features->patches and usable with the squares around the L-junctions, one for each. */
asj_status asj_patch_induced_describe(asj_context *context, const asj_match_options *options, asj_image_features *features);

/* The paper's distance of L-junction i of image 1 and j of image 2; HUGE_VALF when the map of the pair leaves the image. */
float asj_patch_induced_distance(const asj_match_run *run, uint32_t i, uint32_t j);

/* ---- parts of it ---- */

/* The map of the pair; 0: it has none, or a square leaves its own image. */
int32_t asj_patch_induced_map(const asj_match_run *run, uint32_t i, uint32_t j, asj_linear *map);

/* The square of another L-junction, carried by `map` to l. */
asj_affine_frame asj_patch_induced_frame(const asj_match_options *options, const asj_l_junction *l, const double map[4]);

/* Grey levels, of a sum of squares in 1/ASJ_GRAY_ONE. */
float asj_patch_induced_raw(int64_t sum);

/* A distance as a score (candidate.h), and back. */
int32_t asj_patch_induced_to_score(float distance);
double asj_patch_induced_of_score(int32_t score);

#endif
