/* SPDX-License-Identifier: BSD-2-Clause */
/* Seen from (x, y), a vanishing point p in homogeneous coordinates lies along (p0 - p2 x, p1 - p2 y), whether it is far away or
 * not; an edge there runs to it when its line does, to within NEAR. */
#include "plot_direction.h"

#include <math.h>

#define NEAR 0.035   /* rad: 2 degrees */
#define FARTHEST 1e6 /* px */

int32_t cli_direction_of(const asj_vanishing_points *points, double x, double y, double angle)
{
    double least = sin(NEAR);
    int32_t nearest = -1;
    for (int32_t n = 0; points && n < points->count; n++) {
        const double *p = points->points[n].point, along[2] = {p[0] - p[2] * x, p[1] - p[2] * y};
        const double length = hypot(along[0], along[1]);
        const double off = length > 0 ? fabs(along[0] * sin(angle) - along[1] * cos(angle)) / length : 1;
        nearest = off < least ? n : nearest;
        least = fmin(least, off);
    }
    return nearest;
}

int32_t cli_vanishing_place(const asj_vanishing_points *points, int32_t number, double place[2])
{
    const double *p = points->points[number].point;
    if (!(fabs(p[2]) * FARTHEST > hypot(p[0], p[1])))
        return 0;
    place[0] = p[0] / p[2];
    place[1] = p[1] / p[2];
    return 1;
}
