/* SPDX-License-Identifier: BSD-2-Clause */
#include "pose_parameters.h"
#include "geometry/model.h"
#include "geometry/small_matrix.h"

#include <string.h>

#define MOTION ASJ_POSE_PARAMETERS
#define LEAST_SD 1e-5 /* rad: of a covariance, so that it has an inverse */

void asj_pose_origin_of(const asj_geometry *pose, asj_pose_origin *origin)
{
    memcpy(origin->rotation, pose->rotation, sizeof origin->rotation);
    memcpy(origin->translation, pose->translation, sizeof origin->translation);
    asj_translation_axes(pose->translation, origin->axes[0], origin->axes[1]);
}

int32_t asj_pose_information(const asj_pose_origin *origin, const asj_geometry *pose, double *information)
{
    double to[MOTION][6] = {{1}, {0, 1}, {0, 0, 1}}, c[MOTION * MOTION];
    memcpy(&to[3][3], origin->axes[0], sizeof origin->axes[0]);
    memcpy(&to[4][3], origin->axes[1], sizeof origin->axes[1]);
    for (int32_t i = 0; i < MOTION; i++)
        for (int32_t k = 0; k < MOTION; k++) {
            c[i * MOTION + k] = i == k ? LEAST_SD * LEAST_SD : 0;
            for (int32_t n = 0; n < 36; n++)
                c[i * MOTION + k] += to[i][n / 6] * pose->covariance[n] * to[k][n % 6];
        }
    return asj_invert_positive(c, MOTION, information, NULL);
}

void asj_pose_parameters_of(const asj_pose_origin *origin, const asj_geometry *pose, double p[MOTION])
{
    double turn[9];
    asj_multiply3_transposed(pose->rotation, origin->rotation, turn);
    asj_vector_of_rotation(turn, p);
    for (int32_t k = 0; k < 2; k++)
        p[3 + k] = asj_dot3(origin->axes[k], pose->translation);
}

void asj_pose_at(const asj_pose_origin *origin, const double p[MOTION], double rotation[9], double translation[3])
{
    double turn[9];
    asj_rotation_of(p, turn);
    asj_multiply3(turn, origin->rotation, rotation);
    for (int32_t k = 0; k < 3; k++)
        translation[k] = origin->translation[k] + p[3] * origin->axes[0][k] + p[4] * origin->axes[1][k];
    asj_normalise3(translation);
}

void asj_pose_tell(const asj_pose_origin *origin, const double p[MOTION], asj_geometry *pose)
{
    double cross[9], essential[9];
    asj_pose_at(origin, p, pose->rotation, pose->translation);
    asj_skew3(pose->translation, cross);
    asj_multiply3(cross, pose->rotation, essential);
    if (pose->model == ASJ_GEOMETRY_ESSENTIAL)
        asj_fundamental_of(essential, pose->cameras, pose->matrix);
}
