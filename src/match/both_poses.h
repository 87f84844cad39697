/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_MATCH_BOTH_POSES_H
#define ASJ_SRC_MATCH_BOTH_POSES_H

#include <asj/asj.h>

/* Moves a pose to what another estimate of the same motion says of it, too: both_poses.c. Unchanged where the two covariances have
 * no inverse. */
void asj_both_poses(const asj_geometry *other, asj_geometry *pose);

#endif
