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

static int is_central(double x, double y, const asj_image *image)
{
    return fabs(x - 0.5 * image->width) <= FARTHEST * image->width + 0.5 &&
           fabs(y - 0.5 * image->height) <= FARTHEST * image->height + 0.5;
}

int cli_judge_camera(const asj_camera *camera, const asj_image *image, char *message, size_t size)
{
    const double fx = camera->fx, fy = camera->fy, cx = camera->cx, cy = camera->cy;
    const int inside = is_inside(cx, cy, image), central = is_central(cx, cy, image);
    const int oblong = fmax(fx, fy) > SQUAREST * fmin(fx, fy);
    /* the other order would be a camera, and this one is hardly one */
    const int swapped = cx > 0 && cy > 0 && (inside ? oblong && is_central(fx, fy, image) : is_inside(fx, fy, image));
    if (central && !swapped)
        return CLI_CAMERA_GOOD;
    snprintf(message, size, "%s; %s", central ? "the focal lengths differ" : inside ? "the principal point is far from the middle" :
             "the principal point is outside of the image", swapped ? "FX,FY,CX,CY: is this CX,CY,FX,FY?" :
             "is it the camera of the picture at another size, or before it was cut?");
    char *end = message + strlen(message);
    snprintf(end, size - (size_t)(end - message), " (%g,%g,%g,%g, image %d x %d)", fx, fy, cx, cy, (int)image->width,
             (int)image->height);
    return swapped && !inside ? CLI_CAMERA_WRONG : CLI_CAMERA_DOUBTFUL;
}
