/* SPDX-License-Identifier: BSD-2-Clause */
/* A pose that is told, and the five numbers p by which it moves: the turn w of exp([w]x) R, rad, and the translation's steps along
 * two directions across it. */
#ifndef ASJ_SRC_MATCH_POSE_PARAMETERS_H
#define ASJ_SRC_MATCH_POSE_PARAMETERS_H

#include <asj/asj.h>

#define ASJ_POSE_PARAMETERS 5

typedef struct asj_pose_origin {
    double rotation[9], translation[3];
    double axes[2][3]; /* across the translation */
} asj_pose_origin;

void asj_pose_origin_of(const asj_geometry *pose, asj_pose_origin *origin);

/* The inverse of the covariance that a pose near this one is told with, 5 x 5; 0 when there is none. */
int32_t asj_pose_information(const asj_pose_origin *origin, const asj_geometry *pose, double *information);

/* p of another pose, less than half a turn away. */
void asj_pose_parameters_of(const asj_pose_origin *origin, const asj_geometry *pose, double p[ASJ_POSE_PARAMETERS]);

/* The pose at p. */
void asj_pose_at(const asj_pose_origin *origin, const double p[ASJ_POSE_PARAMETERS], double rotation[9], double translation[3]);

/* .. written where it is told: rotation and translation, and of cameras that see no plane alone the matrix. */
void asj_pose_tell(const asj_pose_origin *origin, const double p[ASJ_POSE_PARAMETERS], asj_geometry *pose);

#endif
