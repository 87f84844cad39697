/* SPDX-License-Identifier: BSD-2-Clause */
/* A furnished room in three dimensions, seen by a pin-hole camera: the sample scene of the demo, and pairs of views with exact
 * correspondences, parallax and occlusion.
 *
 * World: metres, x right, y down (the floor is y = 0, heights are negative), z away from the viewer.
 * Camera: a point p has camera coordinates R (p - position), R = roll(z) pitch(x) yaw(y); positive yaw turns to the right,
 * positive pitch looks down. Image: x = focal X / Z + (width - 1) / 2, y likewise, pixel centres at integers. */
#ifndef ASJ_TESTS_SYNTH_ROOM_H
#define ASJ_TESTS_SYNTH_ROOM_H

#include "truth.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SYNTH_ROOM_CORNERS 6

typedef struct synth_vector {
    double x, y, z;
} synth_vector;

typedef struct synth_camera {
    synth_vector position; /* m */
    double yaw, pitch, roll; /* rad */
    double focal;          /* px */
    int32_t width, height;
} synth_camera;

/* A flat convex piece of the room. */
typedef struct synth_surface {
    synth_vector corners[SYNTH_ROOM_CORNERS];
    int32_t count;
    int32_t object;
    synth_vector normal;   /* towards the side from which it is seen */
    double gray;           /* at the room's middle; see shade() in view.c */
} synth_surface;

/* Surfaces that hide each other in the order of their list, seen from anywhere in front. */
typedef struct synth_object {
    synth_vector middle;   /* for sorting: of the object, and of the group it belongs to */
    synth_vector group;
    int32_t rank;          /* within the group: higher ones are in front of lower ones */
    int32_t reserved;
} synth_object;

typedef struct synth_room {
    synth_surface *surfaces;
    synth_object *objects;
    int32_t surface_count, surface_capacity;
    int32_t object_count, object_capacity;
    int32_t failed;
    int32_t reserved;
} synth_room;

/* What is known of one junction of a view beyond its place in the picture. */
typedef struct synth_corner {
    synth_vector point;    /* m, when is_corner */
    int32_t is_corner;     /* 1 = a point of the room; 0 = a T where one thing hides another */
    int32_t reserved;
} synth_corner;

typedef struct synth_view {
    synth_camera camera;
    synth_scene scene;     /* the tag of a polygon is the index of its surface */
    synth_truth truth;
    synth_corner *corners; /* one for each junction of the truth */
} synth_view;

typedef struct synth_correspondence {
    int32_t first, second; /* indices into the two views' truth */
} synth_correspondence;

/* 0, or -1 (memory). */
int synth_room_make(synth_room *room);
void synth_room_free(synth_room *room);

/* The two viewpoints of the demo and the matching tests, 0 and 1, and further ones for any other number: between and around
 * them. */
synth_camera synth_room_camera(int32_t index, int32_t width, int32_t height);

/* Another room for every seed, of four kinds in turn: bare, repeated things, furnished, pictures. 0, or -1 (memory). And a
 * viewpoint in it for every index. */
int synth_room_random(synth_room *room, uint64_t seed);
synth_camera synth_room_random_camera(uint64_t seed, int32_t index, int32_t width, int32_t height);

/* The picture's polygons alone, nearest last. 0, or -1. */
int synth_view_paint(const synth_room *room, const synth_camera *camera, synth_view *view);

/* The picture's polygons, nearest last, and its junctions: edges with a step of at least `min_contrast` grey levels. 0, or -1. */
int synth_view_make(const synth_room *room, const synth_camera *camera, double min_contrast, synth_view *view);
void synth_view_free(synth_view *view);

/* Where a point appears; 0 when it is behind the camera. Neither hidden surfaces nor the image border matter here. */
int synth_camera_project(const synth_camera *camera, synth_vector point, synth_point *image);

/* Index of the first surface on the ray through an image point, and the point met; -1 when there is none. */
int32_t synth_room_trace(const synth_room *room, const synth_camera *camera, double x, double y, synth_vector *point);

/* 1 when nothing stands between the camera and a point. */
int synth_room_visible(const synth_room *room, const synth_camera *camera, synth_vector point);

/* Where the surface seen at (x, y) by `from` appears in `to`: 1 when it is visible there and inside the image, else 0. */
int synth_room_transfer(const synth_room *room, const synth_camera *from, double x, double y, const synth_camera *to,
                        synth_point *image);

/* F with x2' F x1 = 0 for the images x1, x2 of one point in two cameras; row by row, largest entry 1 or -1. */
void synth_fundamental(const synth_camera *first, const synth_camera *second, double f[9]);

/* px from (x2, y2) to the epipolar line of (x1, y1). */
double synth_off_epipolar_line(const double f[9], double x1, double y1, double x2, double y2);

/* x2 ~ R x1 + t in camera coordinates: R row by row, |t| = 1, or 0 when both stand at one place. */
void synth_relative_pose(const synth_camera *first, const synth_camera *second, double rotation[9], double translation[3]);

/* Degrees: how far a rotation and the direction of a translation of length 1 are from those of two cameras. */
typedef struct synth_pose_error {
    double rotation, translation;
} synth_pose_error;
synth_pose_error synth_pose_off(const synth_camera *first, const synth_camera *second, const double rotation[9],
                                const double translation[3]);

/* Junctions of two views that are the same point of the room. Writes at most `capacity` and returns how many there are. */
int32_t synth_correspondences(const synth_view *first, const synth_view *second, synth_correspondence *out, int32_t capacity);

#ifdef __cplusplus
}
#endif
#endif
