/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_FINAL_POSE_H
#define ASJ_SRC_FINAL_POSE_H

#include "match_result.h"

/* Moves an accepted pose of cameras that were given to where the locations of its matches, those likelier right than wrong, want
 * it: final_pose.c. Matches, their probabilities and the covariance stay. ASJ_ERROR_MEMORY; then the result is freed and NULL. */
asj_status asj_finish_pose(asj_context *context, asj_match_result **result);

#endif
