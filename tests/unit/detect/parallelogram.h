/* SPDX-License-Identifier: BSD-2-Clause */
/* A parallelogram on grey level 90: a corner that is not on a pixel, with two sides of known length and direction. */
#ifndef ASJ_TESTS_PARALLELOGRAM_H
#define ASJ_TESTS_PARALLELOGRAM_H

#include "unit_test.h"

enum { SIZE = 121 };

static const double corner_x = 60.3, corner_y = 59.6, sides[2] = {45, 38}, angles[2] = {0.3, 1.7};

static int set_up_parallelogram(void **state, double level)
{
    synth_scene scene;
    synth_scene_init(&scene, SIZE, SIZE, 90);
    const double ax = sides[0] * cos(angles[0]), ay = sides[0] * sin(angles[0]);
    const double bx = sides[1] * cos(angles[1]), by = sides[1] * sin(angles[1]);
    const synth_point corners[4] = {{corner_x, corner_y}, {corner_x + ax, corner_y + ay}, {corner_x + ax + bx, corner_y + ay + by},
                                    {corner_x + bx, corner_y + by}};
    synth_scene_add(&scene, corners, 4, synth_flat(level), 0);
    return unit_set_up_scene(state, &scene, 1, 2);
}

#endif
