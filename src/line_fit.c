/* SPDX-License-Identifier: BSD-2-Clause */
/* Weighted line fit to an edge, the work of steps 3 and 5 (replaces the paper's search over +-0.1 rad, which is kept as the option
 * refinement = search: refine.c).
 *
 * In the frame of the branch (t along u, s along n = u turned by +90 degrees) samples lie at t = first, first + 1, .. and s = -w .. w.
 * Each has the weight of its raw gradient's agreement with the branch, w(t, s) = max(|g.n| - |g.u|, 0), the same form as the
 * junction-ness. Per t: centroid c(t) = sum w s / sum w and weight W(t) = sum w. Weighted least squares c = a + b t gives the line; it
 * is repeated around the line found, in a narrower band.
 *
 * Covariance: with residuals e(t) and W scaled to mean 1, variance s^2 = sum W e^2 / (n - 2) per sample; then cov(a, b) =
 * s^2 (X' W X)^-1. Neighbouring samples share pixels, so s^2 is multiplied by CORRELATION, measured on synthetic scenes. */
#include "line_fit.h"

#include <math.h>

#define MAX_SAMPLES 96
#define CORRELATION 2.0

typedef struct samples {
    int32_t count;
    double t[MAX_SAMPLES], centroid[MAX_SAMPLES], weight[MAX_SAMPLES];
} samples;

typedef struct line {
    double a, b; /* s = a + b t */
} line;

static void collect(const asj_frame *frame, double x, double y, double ux, double uy, const asj_line_range *range,
                    double half_width, line around, samples *out)
{
    double step = (range->last - range->first) / (MAX_SAMPLES - 1);
    if (step < 1)
        step = 1;
    out->count = 0;
    for (double t = range->first; t <= range->last + 1e-9 && out->count < MAX_SAMPLES; t += step) {
        double middle = around.a + around.b * t, sum = 0, moment = 0;
        const int32_t reach = (int32_t)ceil(half_width);
        for (int32_t i = -reach; i <= reach; i++) {
            double s = middle + half_width * i / reach, gx, gy;
            asj_gradient_sample(frame, x + t * ux - s * uy, y + t * uy + s * ux, &gx, &gy);
            double weight = fabs(gy * ux - gx * uy) - fabs(gx * ux + gy * uy);
            if (weight > 0) {
                sum += weight;
                moment += weight * s;
            }
        }
        if (sum <= 0)
            continue;
        out->t[out->count] = t;
        out->centroid[out->count] = moment / sum;
        out->weight[out->count++] = sum;
    }
}

/* Weighted least squares; returns 0 when the samples do not determine a line. */
static int solve(const samples *in, line *out, double covariance[3])
{
    double w = 0, wt = 0, wtt = 0, wc = 0, wtc = 0;
    for (int32_t i = 0; i < in->count; i++) {
        double weight = in->weight[i], t = in->t[i], c = in->centroid[i];
        w += weight;
        wt += weight * t;
        wtt += weight * t * t;
        wc += weight * c;
        wtc += weight * t * c;
    }
    double determinant = w * wtt - wt * wt;
    if (in->count < 3 || !(determinant > 1e-9 * w * wtt))
        return 0;
    out->a = (wtt * wc - wt * wtc) / determinant;
    out->b = (w * wtc - wt * wc) / determinant;
    double error = 0;
    for (int32_t i = 0; i < in->count; i++) {
        double e = in->centroid[i] - out->a - out->b * in->t[i];
        error += in->weight[i] * e * e;
    }
    double variance = CORRELATION * error / (in->count - 2) + 1e-6 * w / in->count;
    covariance[0] = variance * wtt / determinant;
    covariance[1] = -variance * wt / determinant;
    covariance[2] = variance * w / determinant;
    return 1;
}

int asj_line_fit(const asj_frame *frame, double x, double y, const asj_line_range *range, asj_draft_branch *branch)
{
    double ux = cos(branch->angle), uy = sin(branch->angle);
    line found = {branch->offset, 0};
    double covariance[3] = {0, 0, 0};
    samples list;
    for (int32_t i = 0; i < range->iterations; i++) {
        collect(frame, x, y, ux, uy, range, range->half_width[i], found, &list);
        if (!solve(&list, &found, covariance))
            return 0;
    }
    if (!(fabs(found.b) < 1))
        return 0;
    branch->angle = asj_angle_wrap(branch->angle + atan(found.b));
    branch->offset = found.a / sqrt(1 + found.b * found.b);
    branch->offset_variance = covariance[0];
    branch->angle_variance = covariance[2];
    return 1;
}
