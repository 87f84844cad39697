/* SPDX-License-Identifier: BSD-2-Clause */
/* Options of the geometry, and the names of its models and answers. */
#include "geometry_options.h"
#include "core/number_text.h"
#include "core/reserved.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define LEAST_FOCAL_SD 1e-4 /* less is exact */

void asj_geometry_options_init(asj_geometry_options *options)
{
    if (!options)
        return;
    memset(options, 0, sizeof *options);
    options->model = ASJ_GEOMETRY_AUTO;
    options->samples = 1000;
    options->seed = 1;
    options->epsilon = 1e-7;
    options->location_sd = 1.5;
    options->angle_sd = 9;
    options->scale_sd = 0.22;
    options->aspects[0] = options->aspects[1] = 1;
}

static int32_t within(double value, double low, double high)
{
    return value >= low && value <= high;
}

int32_t asj_camera_can_be(const asj_camera *c)
{
    const int32_t is_known = !(c->fx == 0 && c->fy == 0); /* where it is not, nobody asks for the principal point */
    return !is_known || (within(c->fx, 1, 1e7) && within(c->fy, 1, 1e7) && within(c->cx, -1e7, 1e7) && within(c->cy, -1e7, 1e7));
}

int32_t asj_camera_is_known(const asj_camera *c)
{
    return c->fx > 0;
}

int32_t asj_cameras_are_known(const asj_geometry_options *options)
{
    return asj_camera_is_known(&options->cameras[0]) && asj_camera_is_known(&options->cameras[1]);
}

int32_t asj_asks_homographies(const asj_geometry_options *options)
{
    return options->model == ASJ_GEOMETRY_AUTO || options->model == ASJ_GEOMETRY_HOMOGRAPHY;
}

int32_t asj_finds_focal(const asj_geometry_options *options)
{
    const int32_t asked = options->find_focal || (asj_cameras_are_known(options) && options->focal_sd >= LEAST_FOCAL_SD);
    return asked && options->model <= ASJ_GEOMETRY_ESSENTIAL;
}

int32_t asj_geometry_is_open(const asj_geometry *geometry)
{
    return geometry->status == ASJ_GEOMETRY_AMBIGUOUS || geometry->status == ASJ_GEOMETRY_DEGENERATE;
}

/* None, or three of length 1 at right angles. */
static int directions_are_sound(const double d[9])
{
    double most = 0, wrong = 0;
    for (int32_t k = 0; k < 9; k++) {
        if (!within(fabs(d[k]), 0, 2))
            return 0;
        most = fmax(most, fabs(d[k]));
    }
    for (int32_t i = 0; i < 3; i++)
        for (int32_t k = 0; k <= i; k++)
            wrong = fmax(wrong, fabs(asj_dot3(d + 3 * i, d + 3 * k) - (i == k)));
    return most == 0 || wrong < 1e-3;
}

static asj_status check_number(asj_context *context, const char *name, double value, double least, double most)
{
    if (within(value, least, most))
        return ASJ_OK;
    return asj_fail(context, ASJ_ERROR_OPTION, "%s of the geometry is %s, not %s .. %s", name, ASJ_TEXT_NINE(value),
                    ASJ_TEXT(least), ASJ_TEXT(most));
}

static asj_status check_deviations(asj_context *context, const asj_geometry_options *o)
{
    asj_status status = check_number(context, "location_sd", o->location_sd, 0.1, 10);
    if (status == ASJ_OK)
        status = check_number(context, "angle_sd", o->angle_sd, 1, 45);
    return status == ASJ_OK ? check_number(context, "scale_sd", o->scale_sd, 0.02, 1) : status;
}

asj_status asj_geometry_request_check(asj_context *context, const asj_geometry_options *o)
{
    for (int32_t v = 0; v < 2; v++) {
        const asj_camera *c = &o->cameras[v];
        if (!asj_camera_can_be(c))
            return asj_fail(context, ASJ_ERROR_OPTION, "camera %d cannot be: fx %s, fy %s, cx %s, cy %s", (int)v + 1,
                            ASJ_TEXT(c->fx), ASJ_TEXT(c->fy), ASJ_TEXT(c->cx), ASJ_TEXT(c->cy));
        if (!within(o->aspects[v], 0.01, 100))
            return asj_fail(context, ASJ_ERROR_OPTION, "pixels of image %d cannot be: aspect %s", (int)v + 1,
                            ASJ_TEXT_NINE(o->aspects[v]));
        if (!directions_are_sound(o->directions[v]))
            return asj_fail(context, ASJ_ERROR_OPTION, "the directions of image %d are not three at right angles", (int)v + 1);
    }
    if (o->model < ASJ_GEOMETRY_NONE || o->model > ASJ_GEOMETRY_HOMOGRAPHY)
        return asj_fail(context, ASJ_ERROR_OPTION, "no such geometry: %d", (int)o->model);
    if (o->find_focal < 0 || o->find_focal > 1)
        return asj_fail(context, ASJ_ERROR_OPTION, "find_focal is %d, not 0 or 1", (int)o->find_focal);
    if (o->find_focal && (asj_camera_is_known(&o->cameras[0]) || asj_camera_is_known(&o->cameras[1])))
        return asj_fail(context, ASJ_ERROR_OPTION, "find_focal: the focal length of a camera is given");
    if (!within(o->focal_sd, 0, 0.25))
        return asj_fail(context, ASJ_ERROR_OPTION, "focal_sd is %s, not 0 .. 0.25", ASJ_TEXT_NINE(o->focal_sd));
    if (o->find_focal && o->focal_sd > 0)
        return asj_fail(context, ASJ_ERROR_OPTION, "focal_sd is of focal lengths that are given: find_focal has none");
    if (!asj_is_zero(o->reserved, sizeof o->reserved) || o->reserved_integer)
        return asj_fail(context, ASJ_ERROR_OPTION, ASJ_RESERVED_MESSAGE);
    if (o->find_focal && o->model > ASJ_GEOMETRY_ESSENTIAL)
        return asj_fail(context, ASJ_ERROR_OPTION, "find_focal: only model auto and essential have a focal length");
    if (o->model == ASJ_GEOMETRY_ESSENTIAL && !o->find_focal && !asj_cameras_are_known(o))
        return asj_fail(context, ASJ_ERROR_OPTION, "an essential matrix needs both cameras");
    if (o->samples < 1 || o->samples > 100000)
        return asj_fail(context, ASJ_ERROR_OPTION, "samples of the geometry is %d, not 1 .. 100000", (int)o->samples);
    const asj_status status = check_number(context, "epsilon", o->epsilon, 1e-12, 1);
    return status == ASJ_OK ? check_deviations(context, o) : status;
}

asj_status asj_geometry_options_check(asj_context *context, const asj_geometry_options *options)
{
    for (int32_t v = 0; v < 2; v++)
        if (options->widths[v] < 1 || options->heights[v] < 1)
            return asj_fail(context, ASJ_ERROR_OPTION, "image %d has no size", (int)v + 1);
    return asj_geometry_request_check(context, options);
}

const char *asj_geometry_model_name(int32_t model)
{
    static const char *const names[] = {"none", "auto", "essential", "fundamental", "homography"};
    return model >= ASJ_GEOMETRY_NONE && model <= ASJ_GEOMETRY_HOMOGRAPHY ? names[model] : "unknown";
}

const char *asj_geometry_status_name(int32_t status)
{
    static const char *const names[] = {"not asked", "accepted", "chance", "too few", "ambiguous", "degenerate"};
    return status >= ASJ_GEOMETRY_NOT_ASKED && status <= ASJ_GEOMETRY_DEGENERATE ? names[status] : "unknown";
}
