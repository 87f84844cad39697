/* SPDX-License-Identifier: BSD-2-Clause */
/* Rooms are built at right angles, and the vanishing points of each image tell its three directions (vanishing.c), though not which
 * is which. With the directions as rows of D1 and D2, in camera coordinates, the rotation from camera 1 to camera 2 is one of
 *
 *     R = D2' P D1,   P one of the 24 signed permutations that make R a rotation.
 *
 * Prior density of rotations: a half of it flat, the other half normal about these 24 with standard deviation SD in each angle:
 *
 *     q(R) / flat = 1/2 + 1/2 (8 pi^2 / 24) (2 pi SD^2)^(-3/2) sum of exp(-|w|^2 / 2 SD^2),
 *
 * w from R to each (the one near R counts, the others are 90 degrees away). It is fixed before any candidate is looked at, so the
 * evidence (evidence.c) holds. In rendered rooms directions are right to 0.15 degrees (median) and 0.7 (worst of 72). */
#include "manhattan.h"
#include "core/angle.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define SD (0.8 * ASJ_DEGREE)
#define NEAR (4 * ASJ_DEGREE)

void asj_manhattan_rotations(const double directions[2][9], asj_pairs *set)
{
    static const int32_t order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    set->rotation_count = 0;
    for (int32_t v = 0; v < 2; v++)
        if (!(fabs(asj_determinant3(directions[v])) > 0.5))
            return;
    for (int32_t n = 0; n < 48; n++) {
        const int32_t *p = order[n / 8];
        double permuted[9], r[9];
        for (int32_t k = 0; k < 9; k++)
            permuted[k] = (n >> (k / 3) & 1 ? -1 : 1) * directions[0][3 * p[k / 3] + k % 3];
        asj_transposed_multiply3(directions[1], permuted, r);
        if (asj_determinant3(r) > 0 && set->rotation_count < ASJ_ROTATIONS)
            memcpy(set->rotations[set->rotation_count++], r, sizeof r);
    }
}

int32_t asj_nearest_rotation(const asj_pairs *set, const double rotation[9], double w[3])
{
    double least = NEAR;
    int32_t found = -1;
    for (int32_t k = 0; k < set->rotation_count; k++) {
        double turn[9];
        asj_multiply3_transposed(set->rotations[k], rotation, turn);
        if (turn[0] + turn[4] + turn[8] < 2.9)
            continue;
        const double angle = asj_rotation_angle(turn);
        if (angle >= least)
            continue;
        /* the axis times twice the sine of the angle */
        const double factor = angle > 1e-6 ? angle / (2 * sin(angle)) : 0.5;
        w[0] = factor * (turn[7] - turn[5]);
        w[1] = factor * (turn[2] - turn[6]);
        w[2] = factor * (turn[3] - turn[1]);
        least = angle;
        found = k;
    }
    return found;
}

double asj_rotation_prior(const asj_pairs *set, const double rotation[9], double *information)
{
    double w[3];
    *information = 0;
    if (set->rotation_count == 0)
        return 0;
    if (asj_nearest_rotation(set, rotation, w) < 0)
        return log(0.5);
    const double top = 8 * ASJ_PI * ASJ_PI / ASJ_ROTATIONS * pow(2 * ASJ_PI * SD * SD, -1.5);
    const double near = top * exp(-0.5 * asj_dot3(w, w) / (SD * SD));
    *information = near / (1 + near) / (SD * SD);
    return log(0.5 + 0.5 * near);
}
