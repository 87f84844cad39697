/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7: the affine map that a pair of L-junctions induces (paper, section "ASJ Matching", q_i = H p_i for i = 0, 1, 2).
 *
 * Three point pairs determine the six numbers of an affine map exactly, so the paper's DLT is a 2x2 solve: with the branches as
 * vectors, A [a1 b1] = [a2 b2], A = [a2 b2] [a1 b1]^-1, and the translation takes one location to the other.
 * The order of the branches (decompose.c) makes both areas positive, hence det A > 0: such a map never folds or mirrors. */
#include "affine.h"

#include <math.h>

#define LEAST_AREA 1.0

double asj_affine_area(const asj_affine_frame *frame)
{
    return frame->ax * frame->by - frame->ay * frame->bx;
}

/* [a2 b2] [a1 b1]^-1, with the area of frame 1 at hand. */
static void solve(const asj_affine_frame *f1, const asj_affine_frame *f2, double area1, double matrix[4])
{
    matrix[0] = (f2->ax * f1->by - f2->bx * f1->ay) / area1;
    matrix[1] = (f2->bx * f1->ax - f2->ax * f1->bx) / area1;
    matrix[2] = (f2->ay * f1->by - f2->by * f1->ay) / area1;
    matrix[3] = (f2->by * f1->ax - f2->ay * f1->bx) / area1;
}

int32_t asj_affine_between(const asj_affine_frame *frame1, const asj_affine_frame *frame2, asj_linear *map)
{
    double area1 = asj_affine_area(frame1), area2 = asj_affine_area(frame2);
    if (!(area1 >= LEAST_AREA && area2 >= LEAST_AREA && area1 < HUGE_VAL && area2 < HUGE_VAL))
        return 0;
    solve(frame1, frame2, area1, map->to);
    solve(frame2, frame1, area2, map->from);
    return 1;
}

int32_t asj_affine_invert(const double m[4], double inverse[4])
{
    double determinant = m[0] * m[3] - m[1] * m[2];
    if (!(fabs(determinant) >= 1e-12))
        return 0;
    double result[4] = {m[3] / determinant, -m[1] / determinant, -m[2] / determinant, m[0] / determinant};
    for (int i = 0; i < 4; i++)
        inverse[i] = result[i];
    return 1;
}
