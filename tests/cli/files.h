/* SPDX-License-Identifier: BSD-2-Clause */
/* Files for the tests of asj-cli: a small scene, and files that are broken in many ways. */
#ifndef ASJ_TEST_FILES_H
#define ASJ_TEST_FILES_H

#include <stddef.h>

/* The scene: a bright rectangle on a dark ground, with smooth edges. */
enum { SCENE_WIDTH = 320, SCENE_HEIGHT = 240, SCENE_LEFT = 80, SCENE_RIGHT = 240, SCENE_TOP = 60, SCENE_BOTTOM = 180 };
void write_scene(const char *path);

/* Two bright and two dark quarters that meet in the middle: one junction of four branches. */
void write_crossing(const char *path);

/* Two views of a wall with a dozen rectangles, SCENE_WIDTH x SCENE_HEIGHT: what lies at x, y in the first lies at
 * VIEW_SCALE x + VIEW_X, VIEW_SCALE y + VIEW_Y in the second. */
#define VIEW_SCALE 1.12
#define VIEW_X (-21.0)
#define VIEW_Y (-12.0)
void write_views(const char *first, const char *second);
int make_views(void **state); /* before a group of tests: first.png and second.png */
void write_flat_views(const char *first, const char *second, int rows); /* so many rows are one, as of a wall seen from below */
void write_tiled_views(const char *first, const char *second); /* as above, of a wall with 35 rectangles */

void write_coloured_views(const char *first, const char *second); /* PPM, in colours of one luma */
void write_smooth_colours(const char *path, int change);              /* PPM, from the left to the right side */

/* The scene in 16-bit samples of which this is white. */
void write_deep_scene(const char *path, int white);

/* The scene in floats of which this is white, as PFM. */
void write_float_scene(const char *path, float white);

/* A PNG of one grey level. */
void write_constant(const char *path, int width, int height);

/* .. with a pixel that is one brighter. */
void write_nearly_constant(const char *path, int width, int height);

/* A PNG of random grey levels, which takes long to look at. */
void write_noise(const char *path, int width, int height);

void write_bytes(const char *path, const void *bytes, size_t size);
char *read_bytes(const char *path, size_t *size); /* with a zero behind; NULL = no such file; to be freed */

/* The beginning of a PNG that declares this size; its checksums are right. */
void write_png_header(const char *path, unsigned width, unsigned height);

/* Copies of a file: its first `size` bytes, or with byte `position` changed. */
void write_part(const char *path, const char *source, size_t size);
void write_damaged(const char *path, const char *source, size_t position);

/* Number of files in a folder, hidden ones included. */
int count_files(const char *folder);

int exists(const char *path);

#endif
