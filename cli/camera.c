/* SPDX-License-Identifier: BSD-2-Clause */
/* FX,FY,CX,CY: a pin-hole camera in px. */
#include "camera.h"
#include "common.h"
#include "message.h"
#include "parse.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FARTHEST 0.25 /* of a side, from the middle to the principal point: beyond it few pictures are, but some cut ones */
#define SQUAREST 1.1  /* one focal length over the other: swapped numbers have the ratio of the sides here */

int cli_take_camera(const char *command, const char *name, const char *text, asj_camera *camera)
{
    char copy[256], *at = copy;
    double values[4];
    if (strlen(text) < sizeof copy) {
        int count = 0;
        strcpy(copy, text);
        while (at && count < 4) {
            char *comma = strchr(at, ',');
            if (comma)
                *comma = 0;
            if (!cli_parse_number(at, count < 2 ? 1 : -CLI_LONGEST_FOCAL, CLI_LONGEST_FOCAL, &values[count]))
                break;
            count++;
            at = comma ? comma + 1 : NULL;
        }
        if (count == 4 && !at) {
            *camera = (asj_camera){values[0], values[1], values[2], values[3]};
            return CLI_SUCCESS;
        }
    }
    return cli_usage_error(command, "--%s: '%s' is not FX,FY,CX,CY in px, with focal lengths of 1 to %g", name, text,
                           (double)CLI_LONGEST_FOCAL);
}

/* Pixel centres are at integers, or half a pixel farther for COLMAP: neither is told apart here. */
static int is_inside(double x, double y, const asj_image *image)
{
    return x >= -0.5 && y >= -0.5 && x <= image->width && y <= image->height;
}

static int is_central(const asj_camera *camera, const asj_image *image)
{
    return fabs(camera->cx - 0.5 * image->width) <= FARTHEST * image->width + 0.5 &&
           fabs(camera->cy - 0.5 * image->height) <= FARTHEST * image->height + 0.5;
}

int cli_judge_camera(const asj_camera *camera, const asj_image *image, char *message, size_t size)
{
    static const char swapped[] = "FX,FY,CX,CY: is this CX,CY,FX,FY?", resized[] = "is it a camera of the picture at another size?";
    const int width = (int)image->width, height = (int)image->height;
    const int oblong = fmax(camera->fx, camera->fy) > SQUAREST * fmin(camera->fx, camera->fy);
    if (!is_inside(camera->cx, camera->cy, image)) {
        snprintf(message, size, "the principal point %g,%g lies outside of the image of %d x %d pixels; %s", camera->cx, camera->cy,
                 width, height, is_inside(camera->fx, camera->fy, image) ? swapped : resized);
        return CLI_CAMERA_WRONG;
    }
    if (!is_central(camera, image)) {
        snprintf(message, size, "the principal point %g,%g is far from the middle of the image of %d x %d pixels: %s", camera->cx,
                 camera->cy, width, height, oblong ? swapped : resized);
        return CLI_CAMERA_DOUBTFUL;
    }
    if (oblong) {
        snprintf(message, size, "the focal lengths %g and %g differ; %s", camera->fx, camera->fy, swapped);
        return CLI_CAMERA_DOUBTFUL;
    }
    return CLI_CAMERA_GOOD;
}
