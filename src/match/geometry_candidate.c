/* SPDX-License-Identifier: BSD-2-Clause */
/* How far from its line a match may lie: FARTHEST px, or OF_SIDE of the longer side, since lenses bend lines in proportion to the
 * image; twice as far for each octave where L-junctions of the image itself are few. Guests (guests.c) may lie no farther off than
 * others: their places are known less well, but the alignment finds the same place in the other image as well as it does of
 * others. (Rendered rooms and sixteen pairs of photographs with sides of up to 1600 px; epipolar.c and verdict.c ask the same.) */
#include "geometry_candidate.h"

#include <math.h>
#include <string.h>

#define FARTHEST 4.0   /* px, and .. */
#define OF_SIDE 0.0025 /* .. of the longer side */

asj_geometry_candidate asj_candidate_for_geometry(const asj_match_run *run, const asj_candidate *c, double prior)
{
    const asj_l_junction *l1 = asj_match_run_l(run, c, 0);
    const double *t = c->map.to;
    double at[2];
    asj_match_run_partner(run, c, 0, at);
    return (asj_geometry_candidate){
        run->image[0]->l_junctions.location[c->i], run->image[1]->l_junctions.location[c->j],
        (double)l1->x, (double)l1->y, at[0], at[1], {t[0], t[1], t[2], t[3]}, prior};
}

void asj_candidate_branches(const asj_match_run *run, const asj_candidate *c, double *branches)
{
    memcpy(branches, run->image[0]->l_junctions.direction + 4 * (size_t)c->i, 4 * sizeof *branches);
    memcpy(branches + 4, run->image[1]->l_junctions.direction + 4 * (size_t)c->j, 4 * sizeof *branches);
}

int asj_keeps_area(const double t[4])
{
    const double area = t[0] * t[3] - t[1] * t[2];
    return area > 1e-3 && area < 1e3;
}

double asj_distance_from_line(const asj_geometry *g, double x1, double y1, double x2, double y2)
{
    const double *f = g->matrix;
    const double n2x = f[0] * x1 + f[1] * y1 + f[2], n2y = f[3] * x1 + f[4] * y1 + f[5];
    const double n1x = f[0] * x2 + f[3] * y2 + f[6], n1y = f[1] * x2 + f[4] * y2 + f[7];
    const double e = fabs(x2 * n2x + y2 * n2y + f[6] * x1 + f[7] * y1 + f[8]);
    const double least = fmin(n1x * n1x + n1y * n1y, n2x * n2x + n2y * n2y);
    return g->model == ASJ_GEOMETRY_HOMOGRAPHY ? 0 : least > 0 ? e / sqrt(least) : HUGE_VAL;
}

double asj_farthest_from_line(const asj_match_run *run)
{
    double most = 0;
    for (int32_t side = 0; side < 2; side++) {
        const asj_image_features *image = run->image[side];
        const int32_t width = image->pyramid.width[0], height = image->pyramid.height[0];
        most = fmax(most, ldexp(fmax(FARTHEST, OF_SIDE * (width > height ? width : height)), image->l_junctions.home));
    }
    return most;
}
