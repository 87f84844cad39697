/* SPDX-License-Identifier: BSD-2-Clause */
/* Two looks at the same images have estimated one motion, each from candidates of its own. Which of the two poses is told?
 *
 * Both, each as well as it is known. With p' the parameters of the other pose from this one (pose_parameters.h), C and C' what is
 * told of the two, it is the pose at
 *
 *     p = (C^-1 + C'^-1)^-1 C'^-1 p',
 *
 * from where both are away least, in standard deviations, and squared. That is the mean of covariance intersection, too (Julier and
 * Uhlmann, "A non-divergent estimation algorithm in the presence of unknown correlations", 1997, both weights 1/2), which asks
 * for no independence: the looks see the same corners in the same pixels. So the covariance stays that of the pose that is moved;
 * it holds as before. (tests/accuracy/tried/geometry.md, "Which look holds".) */
#include "both_poses.h"
#include "pose_parameters.h"
#include "geometry/small_matrix.h"

#define MOTION ASJ_POSE_PARAMETERS

void asj_both_poses(const asj_geometry *other, asj_geometry *pose)
{
    asj_pose_origin origin;
    double information[MOTION * MOTION], of_other[MOTION * MOTION], p[MOTION], sum[MOTION] = {0};
    asj_pose_origin_of(pose, &origin);
    if (!asj_pose_information(&origin, pose, information) || !asj_pose_information(&origin, other, of_other))
        return;
    asj_pose_parameters_of(&origin, other, p);
    for (int32_t i = 0; i < MOTION; i++)
        for (int32_t k = 0; k < MOTION; k++) {
            sum[i] += of_other[i * MOTION + k] * p[k];
            information[i * MOTION + k] += of_other[i * MOTION + k];
        }
    if (asj_cholesky_solve(information, MOTION, sum, NULL))
        asj_pose_tell(&origin, sum, pose);
}
