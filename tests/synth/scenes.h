/* SPDX-License-Identifier: BSD-2-Clause */
/* Makers of test scenes. Each initialises the scene; free it with synth_scene_free(). The seed decides everything that is
 * random. */
#ifndef ASJ_TESTS_SYNTH_SCENES_H
#define ASJ_TESTS_SYNTH_SCENES_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Three parallelograms in 320 x 240, sides 30 .. 90 px, opening 60 .. 120 deg, any rotation, at least 12 px apart and from the
 * border, `contrast` grey levels above or below the background (90 .. 165), at random. */
void synth_parallelograms(synth_scene *scene, double contrast, uint64_t seed);

/* One junction of two to five branches in 200 x 200, with openings of at least 40 deg and more than 20 deg from straight where
 * two branches only, neighbouring greys at least `step` apart, branches 70 px long. */
void synth_random_star(synth_scene *scene, double step, uint64_t seed);

/* One rectangle with the given corner, sides and rotation (rad). */
void synth_add_rectangle(synth_scene *scene, synth_point corner, double width, double height, double angle, double gray);

/* `count` sectors around a point, sector i from angles[i] to angles[i + 1] in rising order, grays[i] each, `radius` px long; a
 * gray below 0 leaves the sector out. With angles {0, pi/2}, grays {200, -1}: an L; {0, pi/2, pi}: a T; four: an X; {a, b, c}:
 * a Y. */
void synth_add_star(synth_scene *scene, synth_point centre, const double *angles, const double *grays, int32_t count,
                    double radius);

enum { SYNTH_CHECKERBOARD = 0, SYNTH_RANDOM_TILES = 1 };

/* 5 x 5 tiles, sides 32 .. 42 px (each row and column its own), turned by up to 20 deg, in 320 x 300 grey 128. Checkerboard: 90
 * and 190; random: each tile 40 .. 215. */
void synth_tiles(synth_scene *scene, int32_t kind, uint64_t seed);

/* A straight border over most of the image with tiles 32 .. 42 px wide leaning on one side, each of its own grey: T-junctions
 * along it. */
void synth_border(synth_scene *scene, uint64_t seed);

#define SYNTH_GRID_LINES 10

/* Five by five thin lines (2 px, dark on light), 32 .. 42 px apart. `ends` receives the two ends of the centre line of each:
 * that is the truth (synth_truth_of_lines()), since the two edges of such a line cannot be told apart. */
void synth_line_grid(synth_scene *scene, synth_point ends[2 * SYNTH_GRID_LINES], uint64_t seed);

#ifdef __cplusplus
}
#endif
#endif
