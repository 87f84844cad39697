/* SPDX-License-Identifier: BSD-2-Clause */
#include "fuzz.h"

#include <math.h>

/* A power of ten between two, or, once in a while, what no range allows. */
static double power(fuzz_bytes *bytes, double least, double most)
{
    const unsigned part = fuzz_pair(bytes);
    if (part == 257)
        return (fuzz_byte(bytes) & 1) ? (double)NAN : -1;
    return fmin(fmax(pow(10, least + part / 65535.0 * (most - least)), pow(10, least)), pow(10, most));
}

static double signed_power(fuzz_bytes *bytes, double most)
{
    const double sign = (fuzz_byte(bytes) & 1) ? -1 : 1;
    return sign * power(bytes, 0, most);
}

static void set_cameras(fuzz_bytes *bytes, unsigned what, asj_geometry_options *options)
{
    for (int v = 0; v < 2; v++) {
        asj_camera *camera = &options->cameras[v];
        camera->fx = camera->fy = power(bytes, 0, 7);
        if (what & 1)
            camera->fy = power(bytes, 0, 7);
        camera->cx = signed_power(bytes, 7);
        camera->cy = signed_power(bytes, 7);
    }
}

/* A rotation about each axis, one after the other. */
static void set_directions(fuzz_bytes *bytes, double d[9])
{
    for (int k = 0; k < 9; k++)
        d[k] = k % 4 == 0;
    for (int axis = 0; axis < 3; axis++) {
        const double angle = fuzz_byte(bytes) / 255.0 * 6.2832, c = cos(angle), s = sin(angle);
        for (int column = 0; column < 3; column++) {
            double *one = &d[3 * axis + column], *other = &d[3 * ((axis + 1) % 3) + column];
            const double a = *one, b = *other;
            *one = c * a - s * b;
            *other = s * a + c * b;
        }
    }
}

void fuzz_geometry_options(fuzz_bytes *bytes, asj_geometry_options *options)
{
    const unsigned what = fuzz_byte(bytes), more = fuzz_byte(bytes);
    if (what & 1)
        set_cameras(bytes, what & 2, options);
    if (what & 4)
        options->focal_sd = fuzz_byte(bytes) / 255.0 * 0.251;
    if (what & 8)
        options->find_focal = 1; /* with a camera it is refused */
    for (int v = 0; v < 2; v++) {
        if (what & 16)
            options->aspects[v] = power(bytes, -2, 2);
        if (what & 32)
            set_directions(bytes, options->directions[v]);
        if (more & 1) {
            options->widths[v] = (int32_t)fuzz_pair(bytes); /* 0 is refused */
            options->heights[v] = (more & 2) ? INT32_MAX - (int32_t)fuzz_pair(bytes) : (int32_t)fuzz_pair(bytes);
        }
    }
    if (what & 64) {
        options->location_sd = power(bytes, -1, 1);
        options->angle_sd = power(bytes, 0, log10(45));
        options->scale_sd = power(bytes, log10(0.02), 0);
    }
    if (what & 128)
        options->epsilon = power(bytes, -12, 0);
}

static void check_numbers(const double *numbers, int count)
{
    for (int k = 0; k < count; k++)
        fuzz_check(isfinite(numbers[k]), "a geometry that is not finite");
}

void fuzz_check_geometry(const asj_geometry *g)
{
    double norm = 0;
    fuzz_check(g->status >= ASJ_GEOMETRY_NOT_ASKED && g->status <= ASJ_GEOMETRY_DEGENERATE, "an unknown status");
    fuzz_check(*asj_geometry_model_name(g->model) != 'u', "an unknown model");
    check_numbers(g->matrix, 9);
    check_numbers(g->rotation, 9);
    check_numbers(g->translation, 3);
    check_numbers(g->covariance, 36);
    check_numbers(g->rival_rotation, 9);
    check_numbers(g->rival_translation, 3);
    check_numbers(&g->log10_nfa, 1);
    check_numbers(&g->rival_log10_nfa, 1);
    check_numbers(&g->inliers, 1);
    check_numbers(&g->focal_sd, 1);
    check_numbers(&g->picture_agreement, 1);
    check_numbers(&g->picture_knowledge, 1);
    for (int k = 0; k < 9; k++)
        norm += g->matrix[k] * g->matrix[k];
    fuzz_check(g->status != ASJ_GEOMETRY_ACCEPTED || fabs(norm - 1) < 1e-6, "a matrix that is not of norm 1");
    fuzz_check(!g->has_pose || !g->only_turns, "a pose of a camera that only turns");
    for (int k = 0; k < 6; k++)
        fuzz_check(g->covariance[7 * k] >= 0, "a negative variance");
}
