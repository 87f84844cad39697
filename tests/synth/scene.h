/* SPDX-License-Identifier: BSD-2-Clause */
/* Synthetic scenes: filled polygons painted one over the other. Pixel centres lie at integers, x right, y down, so the image covers
 * [-0.5, width - 0.5] x [-0.5, height - 0.5]. Grey levels are 0 .. 255. */
#ifndef ASJ_TESTS_SYNTH_SCENE_H
#define ASJ_TESTS_SYNTH_SCENE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Most corners of a convex polygon. */
#define SYNTH_MAX_CORNERS 12

typedef struct synth_point {
    double x, y;
} synth_point;

/* A linear shade: gray + slope_x (x - x0) + slope_y (y - y0). Slopes 0 = flat. */
typedef struct synth_paint {
    double gray;
    double slope_x, slope_y; /* grey levels per pixel */
    double x0, y0;
} synth_paint;

/* A convex polygon; corners run so that the signed area is positive (clockwise on the screen). */
typedef struct synth_polygon {
    synth_point corners[SYNTH_MAX_CORNERS];
    int32_t count;
    int32_t tag; /* whatever the maker of the scene wants to find again */
    synth_paint paint;
} synth_polygon;

typedef struct synth_scene {
    synth_polygon *polygons; /* later ones hide earlier ones */
    int32_t count, capacity;
    int32_t width, height;
    synth_paint background;
    int32_t failed;          /* sticky: out of memory or a polygon that cannot be; rendering such a scene fails */
} synth_scene;

/* A flat paint. */
synth_paint synth_flat(double gray);

/* Grey level of a paint at a point. */
double synth_paint_at(const synth_paint *paint, double x, double y);

void synth_scene_init(synth_scene *scene, int32_t width, int32_t height, double background);
void synth_scene_free(synth_scene *scene);

/* Adds a simple polygon (no holes, no self-crossings; either sense of rotation). A convex one with at most SYNTH_MAX_CORNERS
 * corners stays one polygon; every other is cut into triangles, which makes no difference to the picture. Corners that repeat
 * or that lie on a straight edge are fine. Polygons of no area are left out. */
void synth_scene_add(synth_scene *scene, const synth_point *corners, int32_t count, synth_paint paint, int32_t tag);

/* Index of the polygon seen at a point, -1 for the background; and the grey level there. */
int32_t synth_scene_top(const synth_scene *scene, double x, double y);
double synth_scene_gray(const synth_scene *scene, double x, double y);

#ifdef __cplusplus
}
#endif
#endif
