/* SPDX-License-Identifier: BSD-2-Clause */
/* Which way is up.
 *
 * What looks the same when it is turned (a window, a picture frame, tiles) is matched with itself upside down as exactly as the
 * right way up. Photographs are taken upright: of the directions of a room (directions.c) one points down in both images, within
 * some 40 degrees of the downward axis, and a motion that takes it anywhere else than there is hardly ever right. A homography
 * between known cameras has two motions, and is upright when one of them is; one that has none to tell (planes.c: of a camera that
 * only turns) is taken for upright. */
#include "upright.h"
#include "core/angle.h"
#include "planes.h"
#include "small_matrix.h"

#include <math.h>

#define TILT (30 * ASJ_DEGREE) /* between what either image and the motion say: directions that belong to other edges */

static int32_t keeps_down(const asj_pairs *set, const double rotation[9])
{
    double turned[3];
    asj_apply3(rotation, set->down[0], turned);
    return asj_dot3(turned, set->down[1]) > cos(TILT);
}

int32_t asj_turns_over(const asj_pairs *set, const asj_model *model, const asj_camera cameras[2])
{
    double rotations[2][9];
    if (!set->has_down || !cameras || model->kind == ASJ_GEOMETRY_FUNDAMENTAL)
        return 0;
    if (asj_model_has_rotation(model))
        return !keeps_down(set, model->rotation);
    const int32_t count = asj_rotations_of_homography(model, cameras, rotations);
    int32_t upright = count == 0;
    for (int32_t k = 0; k < count; k++)
        upright = upright || keeps_down(set, rotations[k]);
    return !upright;
}
