/* SPDX-License-Identifier: BSD-2-Clause */
/* Focal lengths from EXIF data are 35 mm equivalents in whole millimetres as a rule, of a lens that changes with the distance that
 * it is focused at: they are about right, and what they are is found with the motion (--focal-sd).
 *
 * A camera is, in this order: what --camera1 or --camera2 says; --focal; with a geometry that uses cameras and no --focal none, the
 * focal length of the image's EXIF data. All but the first have the middle of the image as principal point. Cameras count when both
 * are known. --focal estimate leaves them open. */
#include "match_cameras.h"
#include "camera.h"
#include "message.h"

#include <math.h>
#include <stdio.h>

#define WIDEST 150.0 /* degrees that a pin-hole camera can show in practice: a picture of a fisheye lens is none, */
#define NARROWEST 0.5 /* .. and a telescope has it */

static int uses_cameras(int32_t model)
{
    return model == ASJ_GEOMETRY_AUTO || model == ASJ_GEOMETRY_ESSENTIAL;
}

static asj_camera of_focal(double focal, const asj_image *image)
{
    return (asj_camera){focal, focal, 0.5 * (image->width - 1), 0.5 * (image->height - 1)};
}

static void take_exif(const cli_match_arguments *arguments, const cli_match_input *input, asj_camera *camera)
{
    if (!input->image || camera->fx > 0)
        return;
    if (input->image->focal_length > 0)
        *camera = of_focal((double)input->image->focal_length, &input->image->image);
    else if (input->image->focal_source == ASJ_EXIF_FOCAL_UNUSABLE && !arguments->common.quiet)
        cli_note("%s: EXIF data not used: damaged, of a larger picture, or of a focal length that cannot be", input->name);
}

static int both_from_exif(const cli_match_arguments *arguments)
{
    const int given = arguments->cameras[0].fx > 0 || arguments->cameras[1].fx > 0;
    return !given && (arguments->focal_from == CLI_FOCAL_EXIF || arguments->focal_from == CLI_FOCAL_AUTO);
}

static void say_exif(const cli_match_arguments *arguments, const cli_match_input inputs[2], const asj_geometry_options *options)
{
    char known[40] = "";
    if (options->focal_sd > 0)
        snprintf(known, sizeof known, ", known to %.3g %%", 100 * options->focal_sd);
    for (int v = 0; v < 2; v++)
        if (!(arguments->cameras[v].fx > 0) && !arguments->common.quiet)
            cli_note("%s: focal length %.0f px, from EXIF data%s%s", inputs[v].name, options->cameras[v].fx,
                     inputs[v].image->focal_source == ASJ_EXIF_FOCAL_FILM ? " (35 mm equivalent)" : "", known);
}

/* A focal length in mm, or of a smaller picture, is a camera of which hardly anything else would tell. */
static void doubt(const cli_match_arguments *arguments, const cli_match_input inputs[2], const asj_geometry_options *options)
{
    const double degrees = 180 / 3.14159265358979323846;
    for (int v = 0; v < 2 && !arguments->common.quiet; v++) {
        const asj_image *image = &inputs[v].pixels;
        const double angle = 2 * degrees * atan2(image->width, 2 * options->cameras[v].fx);
        if (angle > WIDEST || angle < NARROWEST)
            cli_note("%s: a focal length of %g px means a view of %.3g degrees: is it in pixels of this image?", inputs[v].name,
                     options->cameras[v].fx, angle);
    }
}

/* The cameras of the command line. */
static int check_given(const cli_match_arguments *arguments, const cli_match_input inputs[2])
{
    char message[256] = "";
    int result = CLI_SUCCESS;
    for (int v = 0; v < 2; v++) {
        const asj_camera *camera = &arguments->cameras[v];
        const int verdict = camera->fx > 0 ? cli_judge_camera(camera, &inputs[v].pixels, message, sizeof message) : CLI_CAMERA_GOOD;
        if (verdict == CLI_CAMERA_WRONG)
            cli_error("%s: --camera%d: %s", inputs[v].name, v + 1, message);
        else if (verdict == CLI_CAMERA_DOUBTFUL && !arguments->common.quiet)
            cli_note("asj-cli match: warning: %s: --camera%d: %s", inputs[v].name, v + 1, message);
        result = verdict == CLI_CAMERA_WRONG ? CLI_FAILED : result;
    }
    return result;
}

/* One camera without the other, or none where they must be. */
static int fail(const cli_match_arguments *arguments, const cli_match_input inputs[2], const asj_geometry_options *options)
{
    const int missing = options->cameras[0].fx > 0 ? 1 : 0;
    if (arguments->focal_from == CLI_FOCAL_EXIF)
        return cli_usage_error("match", "--focal exif: %s has no focal length in its EXIF data", inputs[missing].name);
    if (arguments->geometry == ASJ_GEOMETRY_ESSENTIAL && !(options->cameras[0].fx > 0) && !(options->cameras[1].fx > 0))
        return cli_usage_error("match", "--geometry essential needs --camera1 and --camera2, --focal, or EXIF data in both");
    return cli_usage_error("match", "--camera%d is missing (or --focal, or EXIF data in %s)", missing + 1, inputs[missing].name);
}

int cli_match_cameras(const cli_match_arguments *arguments, const cli_match_input inputs[2], asj_geometry_options *options)
{
    const int32_t from = arguments->focal_from;
    const int exif = from == CLI_FOCAL_EXIF || (from == CLI_FOCAL_AUTO && uses_cameras(arguments->geometry));
    options->model = arguments->geometry;
    options->find_focal = from == CLI_FOCAL_ESTIMATE;
    if (options->find_focal)
        return CLI_SUCCESS;
    if (check_given(arguments, inputs) != CLI_SUCCESS)
        return CLI_FAILED;
    for (int v = 0; v < 2; v++) {
        options->cameras[v] = arguments->cameras[v];
        if (from == CLI_FOCAL_GIVEN && !(options->cameras[v].fx > 0))
            options->cameras[v] = of_focal(arguments->focal, &inputs[v].pixels);
        if (exif)
            take_exif(arguments, &inputs[v], &options->cameras[v]);
    }
    if (options->cameras[0].fx > 0 && options->cameras[1].fx > 0) {
        if (uses_cameras(options->model))
            options->focal_sd = arguments->focal_sd >= 0 ? arguments->focal_sd : both_from_exif(arguments) ? CLI_EXIF_FOCAL_SD : 0;
        if (exif)
            say_exif(arguments, inputs, options);
        doubt(arguments, inputs, options);
        return CLI_SUCCESS;
    }
    const int given = arguments->cameras[0].fx > 0 || arguments->cameras[1].fx > 0;
    if (given || from == CLI_FOCAL_EXIF || arguments->geometry == ASJ_GEOMETRY_ESSENTIAL)
        return fail(arguments, inputs, options);
    if (arguments->focal_sd > 0)
        return cli_usage_error("match", "--focal-sd changes nothing: no focal lengths are known");
    for (int v = 0; v < 2; v++) /* one alone is of no use */
        options->cameras[v] = (asj_camera){0, 0, 0, 0};
    return CLI_SUCCESS;
}
