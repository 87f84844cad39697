/* SPDX-License-Identifier: BSD-2-Clause */
/* The direction of two matched branches, from both images. */
#ifndef ASJ_SRC_COMMON_DIRECTION_H
#define ASJ_SRC_COMMON_DIRECTION_H

#include <stdint.h>

/* branch[n]: from the location of a match to the end of a branch in image n, px; sd[n]: standard deviation of its direction, rad,
 * 0 = not known; map: the match's, by rows, from image 1 to image 2. Turns both branches, which keep their lengths, and returns 1.
 * They stay as they are, and it returns 0, when one of the deviations is not known, or a branch or the map is degenerate. */
int32_t asj_common_direction(const double map[4], const double sd[2], double branch[2][2]);

#endif
