/* SPDX-License-Identifier: BSD-2-Clause */
/* Angles: radians in [0, 2 pi) from +x towards +y. */
#ifndef ASJ_SRC_CORE_ANGLE_H
#define ASJ_SRC_CORE_ANGLE_H

#define ASJ_PI 3.14159265358979323846
#define ASJ_TWO_PI (2 * ASJ_PI)
#define ASJ_DEGREE (ASJ_PI / 180) /* radians: options are in degrees */

#endif
