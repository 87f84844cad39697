/* SPDX-License-Identifier: BSD-2-Clause */
/* Cameras on the command line. */
#ifndef ASJ_CLI_CAMERA_H
#define ASJ_CLI_CAMERA_H

#include <asj/geometry.h>

#define CLI_LONGEST_FOCAL 1e7 /* px */

/* Reads FX,FY,CX,CY in px; says what is wrong and returns CLI_USAGE when they are no camera. */
int cli_take_camera(const char *command, const char *name, const char *text, asj_camera *camera);

#endif
