/* SPDX-License-Identifier: BSD-2-Clause */
/* The sample room: its furniture and the viewpoints. */
#include "furniture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HIGH = 26, WIDE = 50, DEEP = 62 }; /* decimetres */

/* ---- the room ---- */

/* Things on the back wall: u from the left corner, v down from the ceiling. */
static void add_door(synth_room *room, const room_face *wall, double u)
{
    const double v = 0.55, bottom = 2.6;
    room_add_rectangle(room, wall, u - 0.09, v - 0.09, u + 0.99, bottom, 214.0);
    room_add_rectangle(room, wall, u, v, u + 0.9, bottom, 120.0);
    room_add_rectangle(room, wall, u + 0.015, v + 0.015, u + 0.885, bottom - 0.01, 188.0);
    for (int i = 0; i < 2; i++) {
        const double left = u + 0.12 + 0.37 * i;
        room_add_framed(room, wall, left, v + 0.14, left + 0.29, v + 0.85, 0.025, 166.0, 196.0);
        room_add_framed(room, wall, left, v + 1.06, left + 0.29, v + 1.9, 0.025, 166.0, 196.0);
    }
    room_add_rectangle(room, wall, u + 0.79, v + 0.93, u + 0.86, v + 0.99, 70.0);
}

static void add_picture(synth_room *room, const room_face *wall, double u, double v)
{
    room_add_framed(room, wall, u, v, u + 1.1, v + 0.8, 0.05, 52.0, 222.0);
    room_add_rectangle(room, wall, u + 0.14, v + 0.13, u + 0.96, v + 0.67, 168.0);
    const synth_point hill[3] = {{u + 0.14, v + 0.67}, {u + 0.4, v + 0.3}, {u + 0.7, v + 0.67}};
    const synth_point far_hill[4] = {{u + 0.38, v + 0.67}, {u + 0.66, v + 0.41}, {u + 0.96, v + 0.52}, {u + 0.96, v + 0.67}};
    const synth_point sun[6] = {{u + 0.75, v + 0.2}, {u + 0.81, v + 0.18}, {u + 0.86, v + 0.21},
                                {u + 0.85, v + 0.27}, {u + 0.79, v + 0.29}, {u + 0.75, v + 0.25}};
    room_add_polygon(room, wall, far_hill, 4, 128.0);
    room_add_polygon(room, wall, hill, 3, 92.0);
    room_add_polygon(room, wall, sun, 6, 236.0);
}

/* A poster of 6 x 4 fields: the textured patch. */
static void add_poster(synth_room *room, const room_face *wall, double u, double v)
{
    static const double grays[24] = {60, 190, 120, 210, 90, 150, 200, 100, 170, 70, 140, 220,
                                     130, 215, 80, 160, 205, 95, 180, 85, 225, 110, 65, 175};
    room_add_rectangle(room, wall, u - 0.04, v - 0.04, u + 0.76, v + 0.52, 232.0);
    for (int i = 0; i < 24; i++) {
        const int column = i % 6, line = i / 6;
        room_add_rectangle(room, wall, u + 0.12 * column, v + 0.12 * line, u + 0.12 * (column + 1), v + 0.12 * (line + 1),
                           grays[i]);
    }
}

static void add_window(synth_room *room, const room_face *wall, double u, double v)
{
    room_add_rectangle(room, wall, u - 0.1, v - 0.1, u + 1.6, v + 1.3, 226.0);
    room_add_rectangle(room, wall, u - 0.02, v - 0.02, u + 1.52, v + 1.22, 175.0);
    for (int i = 0; i < 4; i++) {
        const double left = u + 0.78 * (i % 2), top = v + 0.63 * (i / 2);
        room_add_rectangle(room, wall, left, top, left + 0.72, top + 0.57, 246.0);
    }
    room_add_rectangle(room, wall, u - 0.18, v + 1.3, u + 1.68, v + 1.37, 140.0);
}

static void add_shell(synth_room *room)
{
    const double high = 0.1 * HIGH, wide = 0.1 * WIDE, deep = 0.1 * DEEP, near_end = -3.0;
    const room_face floor = {{0, 0, deep}, {1, 0, 0}, {0, 0, -1}, 1.0}, ceiling = {{0, -high, near_end}, {1, 0, 0}, {0, 0, 1}, 1.0};
    const room_face back = {{0, -high, deep}, {1, 0, 0}, {0, 1, 0}, 1.0};
    const room_face left = {{0, -high, near_end}, {0, 0, 1}, {0, 1, 0}, 0.9};
    const room_face right = {{wide, -high, deep}, {0, 0, -1}, {0, 1, 0}, 0.84};
    const double length = deep - near_end;
    room_begin_object(room, room_vector(0.5 * wide, 0, 100), room_vector(0.5 * wide, 0, 100), 0);
    room_add_rectangle(room, &floor, 0, 0, wide, length, 108.0);
    room_add_framed(room, &floor, 0.8, 1.1, 3.6, 4.0, 0.12, 72.0, 138.0);
    room_add_framed(room, &floor, 1.1, 1.4, 3.3, 3.7, 0.05, 96.0, 150.0);
    room_add_rectangle(room, &ceiling, 0, 0, wide, length, 226.0);
    for (int i = 0; i < 3; i++) /* shallow beams: edges of 8 grey levels */
        room_add_rectangle(room, &ceiling, 0, 3.9 + 1.6 * i, wide, 4.2 + 1.6 * i, 218.0);
    room_add_rectangle(room, &back, 0, 0, wide, high, 176.0);
    room_add_rectangle(room, &back, 3.15, 0.35, 4.35, 2.2, 182.0); /* a panel that hardly shows */
    room_add_rectangle(room, &back, 0, high - 0.1, wide, high, 208.0);
    add_door(room, &back, 0.55);
    add_picture(room, &back, 1.85, 0.7);
    add_poster(room, &back, 3.38, 0.75);
    room_add_rectangle(room, &left, 0, 0, length, high, 184.0);
    room_add_rectangle(room, &left, 0, high - 0.1, length, high, 216.0);
    add_window(room, &left, 6.3, 0.65);
    room_add_rectangle(room, &right, 0, 0, length, high, 180.0);
    room_add_rectangle(room, &right, 0, high - 0.1, length, high, 214.0);
    room_add_framed(room, &right, 3.3, 0.75, 3.95, 1.6, 0.05, 78.0, 205.0);
    room_add_rectangle(room, &right, 3.45, 0.95, 3.8, 1.4, 130.0);
}

/* Against the right wall: four doors with rims and handles, on a plinth. */
static void add_cupboard(synth_room *room)
{
    const room_box plinth = {4.42, 5.0, 0.08, 0.0, 3.45, 5.35}, body = {4.38, 5.0, 1.95, 0.08, 3.4, 5.4};
    room_add_box(room, &plinth, room_box_middle(&body), 0, 64.0);
    room_add_box(room, &body, room_box_middle(&body), 1, 134.0);
    const room_face doors = room_box_face(&body, ROOM_LEFT);
    for (int i = 0; i < 4; i++) {
        const double u = 0.05 + 0.97 * (i % 2), v = i < 2 ? 0.06 : 0.92, height = i < 2 ? 0.8 : 0.9;
        room_add_framed(room, &doors, u, v, u + 0.93, v + height, 0.09, 152.0, 172.0);
        const double handle = i % 2 ? u + 0.02 : u + 0.87;
        room_add_rectangle(room, &doors, handle, v + 0.3, handle + 0.04, v + 0.5, 44.0);
    }
    const room_face side = room_box_face(&body, ROOM_FRONT);
    room_add_framed(room, &side, 0.08, 0.1, 0.54, 1.77, 0.02, 112.0, 140.0);
}

static void add_table(synth_room *room)
{
    const room_box top = {1.55, 2.95, 0.74, 0.69, 3.5, 4.4};
    const synth_vector middle = room_box_middle(&top);
    for (int i = 0; i < 4; i++) {
        const double x = i % 2 ? 2.82 : 1.62, z = i / 2 ? 3.57 : 4.27;
        const room_box leg = {x, x + 0.06, 0.69, 0.0, z, z + 0.06};
        room_add_box(room, &leg, middle, 3 * (i / 2), 84.0);
    }
    const room_box carton = {1.95, 2.45, 0.42, 0.0, 3.75, 4.15}; /* under the table, between its legs */
    room_add_box(room, &carton, middle, 2, 158.0);
    room_add_box(room, &top, middle, 4, 118.0);
    const room_box book = {1.75, 2.1, 0.8, 0.74, 3.75, 4.05}, vase = {2.5, 2.66, 1.06, 0.74, 3.9, 4.06};
    room_add_box(room, &book, middle, 5, 190.0);
    room_add_box(room, &vase, middle, 5, 70.0);
}

static void add_chest(synth_room *room)
{
    const room_box chest = {0.55, 1.3, 0.55, 0.0, 2.75, 3.35};
    room_add_box(room, &chest, room_box_middle(&chest), 0, 150.0);
    const room_face front = room_box_face(&chest, ROOM_FRONT), side = room_box_face(&chest, ROOM_RIGHT);
    const room_face top = room_box_face(&chest, ROOM_TOP);
    room_add_framed(room, &front, 0.05, 0.05, 0.7, 0.26, 0.015, 96.0, 166.0);
    room_add_framed(room, &front, 0.05, 0.3, 0.7, 0.51, 0.015, 96.0, 166.0);
    room_add_rectangle(room, &front, 0.33, 0.13, 0.42, 0.17, 50.0);
    room_add_rectangle(room, &front, 0.33, 0.38, 0.42, 0.42, 50.0);
    room_add_rectangle(room, &side, 0.06, 0.06, 0.54, 0.5, 128.0);
    room_add_rectangle(room, &top, 0.1, 0.1, 0.4, 0.45, 196.0);
}

int synth_room_make(synth_room *room)
{
    memset(room, 0, sizeof *room);
    add_shell(room);
    add_cupboard(room);
    add_table(room);
    add_chest(room);
    if (room->failed)
        synth_room_free(room);
    return room->failed ? -1 : 0;
}

void synth_room_free(synth_room *room)
{
    free(room->surfaces);
    free(room->objects);
    room->surfaces = NULL;
    room->objects = NULL;
    room->surface_count = room->object_count = 0;
    room->surface_capacity = room->object_capacity = 0;
}

synth_camera synth_room_camera(int32_t index, int32_t width, int32_t height)
{
    const double scale = (double)width / 1052.0, degree = 3.14159265358979323846 / 180.0;
    synth_camera camera = {{2.35, -1.45, 0.55}, -1.0 * degree, 6.0 * degree, 0.0, 780.0 * scale, width, height};
    if (index == 1) {
        camera.position = room_vector(2.95, -1.55, 0.95);
        camera.yaw = -9.0 * degree;
        camera.pitch = 8.0 * degree;
        camera.roll = 1.5 * degree;
    } else if (index > 1) { /* a walk around the first viewpoint */
        camera.position.x += 0.55 * sin(1.7 * index);
        camera.position.y += 0.12 * sin(2.3 * index);
        camera.position.z += 0.35 * sin(1.1 * index);
        camera.yaw -= 7.0 * degree * sin(1.7 * index);
        camera.pitch += 2.0 * degree * sin(0.7 * index);
        camera.roll = 2.0 * degree * sin(3.1 * index);
    }
    return camera;
}
