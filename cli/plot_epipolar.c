/* SPDX-License-Identifier: BSD-2-Clause */
/* l2 = F x1 in image 2 and l1 = F' x2 in image 1 (x2' F x1 = 0), and where they meet the edges of the image: the line
 * a x + b y + c = 0 as p + t d with its point p nearest the middle of the image, the range of t cut at each of the four edges
 * (Liang and Barsky 1984). */
#include "plot_epipolar.h"

#include <math.h>

int cli_epipolar_line(const asj_geometry *geometry, int v, double x, double y, double width, double height, double ends[4])
{
    const double *f = geometry->matrix, at[3] = {x, y, 1};
    double line[3];
    for (int k = 0; k < 3; k++)
        line[k] = v == 1 ? f[3 * k] * at[0] + f[3 * k + 1] * at[1] + f[3 * k + 2] : f[k] * at[0] + f[3 + k] * at[1] + f[6 + k];
    const double length = hypot(line[0], line[1]);
    if (!(length > 0) || !isfinite(line[2] / length))
        return 0;
    const double n[2] = {line[0] / length, line[1] / length}, middle[2] = {0.5 * (width - 1), 0.5 * (height - 1)};
    const double away = n[0] * middle[0] + n[1] * middle[1] + line[2] / length;
    const double p[2] = {middle[0] - away * n[0], middle[1] - away * n[1]}, d[2] = {-n[1], n[0]}, sides[2] = {width, height};
    double first = -width - height, last = width + height;
    for (int k = 0; k < 2; k++) {
        const double low = -0.5 - p[k], high = sides[k] - 0.5 - p[k];
        if (fabs(d[k]) < 1e-12) {
            if (low > 0 || high < 0)
                return 0;
            continue;
        }
        first = fmax(first, fmin(low / d[k], high / d[k]));
        last = fmin(last, fmax(low / d[k], high / d[k]));
    }
    for (int k = 0; k < 2; k++) {
        ends[k] = p[k] + first * d[k];
        ends[2 + k] = p[k] + last * d[k];
    }
    return last > first;
}

/* How far two lines across one image are from each other: the larger distance of their ends. */
static double line_distance(const double a[4], const double b[4])
{
    const double same = fmax(hypot(a[0] - b[0], a[1] - b[1]), hypot(a[2] - b[2], a[3] - b[3]));
    const double turned = fmax(hypot(a[0] - b[2], a[1] - b[3]), hypot(a[2] - b[0], a[3] - b[1]));
    return fmin(same, turned);
}

/* Gonzalez, Clustering to minimize the maximum intercluster distance (1985). */
void cli_epipolar_spread(cli_epipolar_pair *pairs, size_t count, size_t most)
{
    for (size_t k = 0; k < count; k++)
        pairs[k].distance = HUGE_VAL;
    for (size_t chosen = 0; chosen < count && chosen < most; chosen++) {
        cli_epipolar_pair *next = &pairs[0];
        for (size_t k = 1; k < count; k++)
            if (pairs[k].distance > next->distance)
                next = &pairs[k];
        next->distance = -1;
        for (size_t k = 0; k < count; k++) {
            const double distance = line_distance(next->ends[0], pairs[k].ends[0]) +
                                    line_distance(next->ends[1], pairs[k].ends[1]);
            pairs[k].distance = fmin(pairs[k].distance, distance);
        }
    }
}
