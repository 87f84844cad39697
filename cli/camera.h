/* SPDX-License-Identifier: BSD-2-Clause */
/* Cameras on the command line. */
#ifndef ASJ_CLI_CAMERA_H
#define ASJ_CLI_CAMERA_H

#include <asj/geometry.h>
#include <asj/image.h>

#define CLI_LONGEST_FOCAL 1e7 /* px */

/* Reads FX,FY,CX,CY in px; says what is wrong and returns CLI_USAGE when they are no camera. */
int cli_take_camera(const char *command, const char *name, const char *text, asj_camera *camera);

/* Whether this can be the camera of an image of that size: numbers in another order, or of the picture at another size, give poses
 * that are wrong without a sign of it. `message` says why not, and what is likely. */
enum { CLI_CAMERA_GOOD = 0, CLI_CAMERA_DOUBTFUL, CLI_CAMERA_WRONG };
int cli_judge_camera(const asj_camera *camera, const asj_image *image, char *message, size_t size);

#endif
