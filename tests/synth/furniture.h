/* SPDX-License-Identifier: BSD-2-Clause */
/* What rooms are made of. Everything is a rectangle on a face; a face is a plane with an origin and two axes, seen from the side
 * of u x v (y down, so that u right and v down is seen from the near side of z). */
#ifndef ASJ_TESTS_SYNTH_FURNITURE_H
#define ASJ_TESTS_SYNTH_FURNITURE_H

#include "room.h"

typedef struct room_face {
    synth_vector origin, u, v; /* u, v of length 1 */
    double light;              /* factor on all grey levels */
} room_face;

typedef struct room_box {
    double x0, x1, top, bottom, z0, z1; /* heights above the floor: top > bottom >= 0 */
} room_box;

enum { ROOM_FRONT, ROOM_LEFT, ROOM_RIGHT, ROOM_TOP };

synth_vector room_vector(double x, double y, double z);

/* Surfaces that follow belong to a new object; see synth_object. */
void room_begin_object(synth_room *room, synth_vector middle, synth_vector group, int32_t rank);

void room_add_polygon(synth_room *room, const room_face *f, const synth_point *uv, int32_t count, double gray);
void room_add_rectangle(synth_room *room, const room_face *f, double u0, double v0, double u1, double v1, double gray);

/* A rectangle with a rim of `rim` metres in another grey. */
void room_add_framed(synth_room *room, const room_face *f, double u0, double v0, double u1, double v1, double rim,
                     double rim_gray, double gray);

/* A box as an object of its own, and the sides of it that may be seen. */
void room_add_box(synth_room *room, const room_box *b, synth_vector group, int32_t rank, double gray);
room_face room_box_face(const room_box *b, int side);
synth_vector room_box_middle(const room_box *b);

#endif
