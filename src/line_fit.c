/* SPDX-License-Identifier: BSD-2-Clause */
/* Weighted line fit to an edge, the work of steps 3 and 5 (replaces the paper's search over +-0.1 rad, which is kept as the option
 * refinement = search: refine.c).
 *
 * In the frame of the branch (t along u, s along n = u turned by +90 degrees) samples lie at t = first, first + 1, .. and s = -w ..
 * w. Each has the weight of its raw gradient's agreement with the branch, w(t, s) = max(|g.n| - |g.u|, 0), the same form as the
 * junction-ness. Per t: centroid c(t) = sum w s / sum w and weight W(t) = sum w. Weighted least squares c = a + b t gives the line;
 * it is repeated around the line found, in a narrower band.
 *
 * The two signs of g.n (dark to bright, bright to dark) are fitted apart. Indoor scenes are full of narrow bands, the two edges of
 * a door jamb or a skirting board, and a fit that mixes them follows neither. The stronger sign gives the line; when both are
 * strong and no more than THIN px apart all along, the branch is a thin line, and the middle of both is taken.
 *
 * Covariance: with residuals e(t), variance s^2 = sum W e^2 / (n - 2) per unit of weight; then cov(a, b) = s^2 (X' W X)^-1.
 * Neighbouring samples share pixels, so s^2 is multiplied by factors that make errors and stated uncertainties agree on synthetic
 * scenes (tests/accuracy). */
#include "line_fit.h"

#include <math.h>

#define MAX_SAMPLES 96
#define OFFSET_CORRELATION 3.0
#define ANGLE_CORRELATION 10.0
#define LEAST_ERROR 0.03 /* px: systematic error of a centroid (sampling, interpolation), at either end of a line */
#define THIN 4.5

typedef struct samples {
    int32_t count;
    double mass;
    double t[MAX_SAMPLES], centroid[MAX_SAMPLES], weight[MAX_SAMPLES];
} samples;

typedef struct line {
    double a, b; /* s = a + b t */
    double a_variance, b_variance;
} line;

static void add_sample(samples *out, double t, double sum, double moment)
{
    if (sum <= 0)
        return;
    out->t[out->count] = t;
    out->centroid[out->count] = moment / sum;
    out->weight[out->count++] = sum;
    out->mass += sum;
}

/* Samples the band around a line: those whose gradient points along +n into out[1], along -n into out[0]. */
static void collect(const asj_frame *frame, double x, double y, double ux, double uy, const asj_line_range *range,
                    double half_width, const line *around, samples out[2])
{
    const int32_t reach = (int32_t)ceil(half_width);
    double step = (range->last - range->first) / (MAX_SAMPLES - 1);
    if (step < 1)
        step = 1;
    out[0].count = out[1].count = 0;
    out[0].mass = out[1].mass = 0;
    for (int32_t k = 0; k < MAX_SAMPLES && range->first + k * step <= range->last + 1e-9; k++) {
        const double t = range->first + k * step, middle = around->a + around->b * t;
        double sum[2] = {0, 0}, moment[2] = {0, 0};
        for (int32_t i = -reach; i <= reach; i++) {
            double s = middle + half_width * i / reach, gx, gy;
            asj_gradient_sample(frame, x + t * ux - s * uy, y + t * uy + s * ux, &gx, &gy);
            double across = gy * ux - gx * uy, weight = fabs(across) - fabs(gx * ux + gy * uy);
            if (weight > 0) {
                sum[across > 0] += weight;
                moment[across > 0] += weight * s;
            }
        }
        add_sample(&out[0], t, sum[0], moment[0]);
        add_sample(&out[1], t, sum[1], moment[1]);
    }
}

/* Weighted least squares; returns 0 when the samples do not determine a line. */
static int solve(const samples *in, line *out)
{
    double w = 0, wt = 0, wtt = 0, wc = 0, wtc = 0, error = 0;
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
    for (int32_t i = 0; i < in->count; i++) {
        double e = in->centroid[i] - out->a - out->b * in->t[i];
        error += in->weight[i] * e * e;
    }
    const double variance = error / (in->count - 2), span = in->t[in->count - 1] - in->t[0];
    out->a_variance = OFFSET_CORRELATION * variance * wtt / determinant + LEAST_ERROR * LEAST_ERROR;
    out->b_variance = ANGLE_CORRELATION * variance * w / determinant + 2 * LEAST_ERROR * LEAST_ERROR / (span * span);
    return 1;
}

/* The line of the stronger sign, or the middle of a thin line's two edges. *apart is the distance between those, else 0. */
static int choose(const samples list[2], const asj_line_range *range, line *found, double *apart)
{
    const int strong = list[1].mass > list[0].mass;
    line lines[2];
    *apart = 0;
    if (!solve(&list[strong], &lines[strong]))
        return 0;
    *found = lines[strong];
    if (list[!strong].mass < 0.4 * list[strong].mass || !solve(&list[!strong], &lines[!strong]))
        return 1;
    double near = fabs(lines[1].a - lines[0].a + (lines[1].b - lines[0].b) * range->first);
    double far = fabs(lines[1].a - lines[0].a + (lines[1].b - lines[0].b) * range->last);
    if (near > THIN || far > THIN)
        return 1;
    *apart = 0.5 * (near + far);
    found->a = 0.5 * (lines[0].a + lines[1].a);
    found->b = 0.5 * (lines[0].b + lines[1].b);
    found->a_variance = 0.25 * (lines[0].a_variance + lines[1].a_variance);
    found->b_variance = 0.25 * (lines[0].b_variance + lines[1].b_variance);
    return 1;
}

int asj_line_fit(const asj_frame *frame, double x, double y, const asj_line_range *range, asj_draft_branch *branch)
{
    const double ux = cos(branch->angle), uy = sin(branch->angle);
    line found = {branch->offset, 0, 0, 0};
    double apart = 0;
    samples list[2];
    for (int32_t i = 0; i < range->iterations; i++) {
        double half_width = range->half_width[i] + 0.5 * apart;
        collect(frame, x, y, ux, uy, range, half_width < 4.5 ? half_width : 4.5, &found, list);
        if (!choose(list, range, &found, &apart))
            return 0;
    }
    if (!(fabs(found.b) < 1))
        return 0;
    branch->angle = asj_angle_wrap(branch->angle + atan(found.b));
    branch->offset = found.a / sqrt(1 + found.b * found.b);
    branch->offset_variance = found.a_variance;
    branch->angle_variance = found.b_variance;
    return 1;
}
