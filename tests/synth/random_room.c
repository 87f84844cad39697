/* SPDX-License-Identifier: BSD-2-Clause */
/* Rooms without end, to choose parameters on and to judge by: a shell, things on its walls, boxes on its floor. Four kinds in turn
 * (seed modulo 4):
 *
 *   0 bare       few things, edges of a few grey levels
 *   1 repeated   grids of like panes, tiles, shelves and doors
 *   2 furnished  many boxes in front of each other and of the walls
 *   3 pictures   walls with pictures, posters, windows of all sizes
 *
 * Boxes stand in slabs of depth that do not overlap, and side by side in a slab, so that sorting them is exact: slabs by their
 * distance, boxes of a slab from the sides to the middle.
 *
 * No call has more than one random number among its arguments: their order is the compiler's choice, and the room would be, too. */
#include "furniture.h"
#include "random.h"

#include <math.h>
#include <string.h>

#define KINDS 4
#define NEAR_END (-3.0)

typedef struct plan {
    synth_room *room;
    synth_random random;
    int kind;
    double wide, high, deep; /* m */
} plan;

static double between(plan *p, double low, double high)
{
    return synth_random_between(&p->random, low, high);
}

static int chance(plan *p, double share)
{
    return synth_random_unit(&p->random) < share;
}

static int whole(plan *p, int low, int high)
{
    return low + (int)(synth_random_unit(&p->random) * (high - low + 1));
}

/* A grey that differs from the one behind it: little in a bare room. */
static double against(plan *p, double gray)
{
    const double step = p->kind == 0 ? between(p, 6, 25) : between(p, 10, 80);
    const int up = gray < 60 || (gray < 200 && chance(p, 0.5));
    return up ? fmin(gray + step, 245) : fmax(gray - step, 25);
}

/* ---- on a wall: a rectangle u0 .. u1, v0 .. v1 of the wall to fill ---- */

static void add_picture(plan *p, const room_face *f, double u0, double v0, double u1, double v1, double behind)
{
    const double rim = between(p, 0.02, 0.06), frame = against(p, behind), inside = against(p, frame);
    room_add_framed(p->room, f, u0, v0, u1, v1, rim, frame, inside);
    const double width = u1 - u0 - 2 * rim, height = v1 - v0 - 2 * rim;
    for (int i = whole(p, 1, 5); i > 0; i--) { /* shapes inside the frame */
        const double x = u0 + rim + width * between(p, 0.05, 0.6), y = v0 + rim + height * between(p, 0.05, 0.6);
        const double w = width * between(p, 0.1, 0.35), h = height * between(p, 0.1, 0.35), lean = between(p, -0.3, 0.3);
        const synth_point shape[4] = {{x, y}, {x + w, y + lean * h * 0.1}, {x + w * (1 - fabs(lean)), y + h},
                                      {x, y + h * (1 - lean * 0.2)}};
        const double gray = against(p, inside);
        room_add_polygon(p->room, f, shape, chance(p, 0.5) ? 3 : 4, gray);
    }
}

static void add_grid(plan *p, const room_face *f, double u0, double v0, double u1, double v1, double behind)
{
    const int columns = whole(p, 2, 5), lines = whole(p, 1, 4), random = p->kind == 3 && chance(p, 0.5);
    const double rim = between(p, 0.015, 0.05), bars = against(p, behind), pane = against(p, bars);
    const double width = (u1 - u0 - rim) / columns, height = (v1 - v0 - rim) / lines;
    room_add_rectangle(p->room, f, u0, v0, u1, v1, bars);
    for (int i = 0; i < columns * lines; i++) {
        const double x = u0 + rim + i % columns * width, y = v0 + rim + (double)(i / columns) * height;
        room_add_rectangle(p->room, f, x, y, x + width - rim, y + height - rim, random ? against(p, bars) : pane);
    }
}

static void add_door(plan *p, const room_face *f, double u0, double v0, double u1, double behind)
{
    const double frame = against(p, behind), leaf = against(p, frame), bottom = p->high;
    room_add_rectangle(p->room, f, u0, v0, u1, bottom, frame);
    room_add_rectangle(p->room, f, u0 + 0.06, v0 + 0.06, u1 - 0.06, bottom - 0.01, leaf);
    if (chance(p, 0.7))
        room_add_framed(p->room, f, u0 + 0.18, v0 + 0.2, u1 - 0.18, v0 + 0.9, 0.025, against(p, leaf), leaf);
    if (chance(p, 0.7))
        room_add_framed(p->room, f, u0 + 0.18, v0 + 1.1, u1 - 0.18, bottom - 0.2, 0.025, against(p, leaf), leaf);
    room_add_rectangle(p->room, f, u1 - 0.16, v0 + 0.95, u1 - 0.09, v0 + 1.0, against(p, leaf));
}

/* Things side by side along a wall from u0 to u1. */
static void furnish_wall(plan *p, const room_face *f, double u0, double u1, double behind)
{
    const double crowd = p->kind == 0 ? 0.35 : p->kind == 3 ? 1 : 0.7;
    for (double u = u0 + between(p, 0.1, 0.5); u < u1 - 0.6;) {
        const double width = fmin(between(p, 0.5, 1.5), u1 - 0.1 - u), top = between(p, 0.3, 0.9);
        const double bottom = fmin(top + between(p, 0.4, 1.2), p->high - 0.2);
        if (chance(p, crowd)) {
            if (chance(p, 0.25))
                add_door(p, f, u, p->high - 2.05, u + fmin(width, 0.95), behind);
            else if (chance(p, p->kind == 1 ? 0.8 : 0.4))
                add_grid(p, f, u, top, u + width, bottom, behind);
            else
                add_picture(p, f, u, top, u + width, bottom, behind);
        }
        u += width + between(p, 0.15, 0.6);
    }
}

static void add_shell(plan *p)
{
    const double length = p->deep - NEAR_END;
    const room_face floor = {{0, 0, p->deep}, {1, 0, 0}, {0, 0, -1}, 1.0};
    const room_face ceiling = {{0, -p->high, NEAR_END}, {1, 0, 0}, {0, 0, 1}, 1.0};
    const room_face back = {{0, -p->high, p->deep}, {1, 0, 0}, {0, 1, 0}, 1.0};
    const room_face left = {{0, -p->high, NEAR_END}, {0, 0, 1}, {0, 1, 0}, 0.93};
    const room_face right = {{p->wide, -p->high, p->deep}, {0, 0, -1}, {0, 1, 0}, 0.88};
    const double wall = between(p, 130, 210), ground = between(p, 70, 150);
    room_begin_object(p->room, room_vector(0.5 * p->wide, 0, 100), room_vector(0.5 * p->wide, 0, 100), 0);
    room_add_rectangle(p->room, &floor, 0, 0, p->wide, length, ground);
    if (p->kind == 1 || chance(p, 0.3)) { /* tiles: every second one in another grey */
        const double side = between(p, 0.4, 0.8), gray = against(p, ground);
        for (int i = 0; i < 16; i++)
            for (int k = i % 2; (k + 1) * side < p->wide; k += 2)
                room_add_rectangle(p->room, &floor, k * side, i * side, (k + 1) * side, (i + 1) * side, gray);
    } else if (chance(p, 0.6)) {
        const double inside = against(p, ground), frame = against(p, ground), v1 = between(p, 2.5, 4.0);
        room_add_framed(p->room, &floor, 0.6, 1.0, between(p, 2.0, p->wide - 0.5), v1, 0.12, frame, inside);
    }
    room_add_rectangle(p->room, &ceiling, 0, 0, p->wide, length, fmin(wall + between(p, 8, 40), 240));
    for (int i = whole(p, 0, 4); i > 0; i--) {
        const double u = between(p, 0.3, p->wide - 1), v = between(p, 4.5, length - 1);
        const double gray = against(p, wall), v1 = v + between(p, 0.3, 0.8);
        room_add_rectangle(p->room, &ceiling, u, v, u + between(p, 0.3, 0.8), v1, gray);
    }
    const room_face *const walls[3] = {&back, &left, &right};
    const double from[3] = {0, 5.0, 0}, to[3] = {p->wide, length, 4.2};
    for (int i = 0; i < 3; i++) {
        const double gray = wall * between(p, 0.96, 1.04), end = i == 0 ? p->wide : length;
        room_add_rectangle(p->room, walls[i], 0, 0, end, p->high, gray);
        if (chance(p, 0.7))
            room_add_rectangle(p->room, walls[i], 0, p->high - 0.1, end, p->high, against(p, gray));
        furnish_wall(p, walls[i], from[i], to[i], gray);
    }
}

/* ---- on the floor ---- */

/* Doors, drawers or nothing on the side that faces the viewer. */
static void dress(plan *p, const room_face *f, double width, double height, double gray)
{
    const int columns = whole(p, 1, width > 0.8 ? 3 : 1), lines = whole(p, 1, height > 0.6 ? 4 : 2);
    const double w = width / columns, h = height / lines, rim = between(p, 0.01, 0.04);
    const double edge = against(p, gray), handle = against(p, gray), panel = against(p, edge);
    for (int i = 0; i < columns * lines; i++) {
        const double u = i % columns * w + 0.03, v = (double)(i / columns) * h + 0.03;
        if (w < 0.2 || h < 0.15)
            return;
        room_add_framed(p->room, f, u, v, u + w - 0.06, v + h - 0.06, rim, edge, panel);
        room_add_rectangle(p->room, f, u + 0.5 * w - 0.07, v + 0.06, u + 0.5 * w - 0.01, v + 0.09, handle);
    }
}

static void add_slab(plan *p, double z, double depth)
{
    const synth_vector group = room_vector(0.5 * p->wide, -1.4, z + 0.5 * depth);
    for (double x = between(p, 0.1, 1.0); x < p->wide - 0.5;) {
        const double width = fmin(between(p, 0.4, 1.3), p->wide - 0.1 - x), height = between(p, 0.35, p->kind == 2 ? 1.9 : 1.2);
        const room_box b = {x, x + width, height, 0.0, z, z + depth};
        const double gray = against(p, chance(p, 0.5) ? 150 : 100);
        room_add_box(p->room, &b, group, 0, gray);
        if (!p->room->failed) /* by x alone */
            p->room->objects[p->room->object_count - 1].middle = room_vector(x + 0.5 * width, -1.4, z + 0.5 * depth);
        for (int side = ROOM_FRONT; side <= ROOM_RIGHT; side++)
            if (chance(p, p->kind == 0 ? 0.3 : 0.8)) {
                const room_face f = room_box_face(&b, side);
                dress(p, &f, side == ROOM_FRONT ? width : depth, height, gray);
            }
        x += width + between(p, 0.2, p->kind == 2 ? 1.0 : 2.5);
    }
}

int synth_room_random(synth_room *room, uint64_t seed)
{
    plan p = {.room = room, .kind = (int)(seed % KINDS)};
    memset(room, 0, sizeof *room);
    synth_random_seed(&p.random, seed + 0x726f6f6d);
    p.wide = between(&p, 4.0, 6.0);
    p.high = between(&p, 2.4, 2.9);
    p.deep = between(&p, 5.0, 7.0);
    add_shell(&p);
    const int slabs = p.kind == 2 ? 3 : p.kind == 3 ? 1 : whole(&p, 0, 2);
    for (int i = slabs - 1; i >= 0; i--) {
        const double depth = between(&p, 0.35, 0.7);
        add_slab(&p, p.deep - (slabs - i) * 1.1 + between(&p, 0, 0.3), depth);
    }
    if (room->failed)
        synth_room_free(room);
    return room->failed ? -1 : 0;
}

synth_camera synth_room_random_camera(uint64_t seed, int32_t index, int32_t width, int32_t height)
{
    const double degree = 3.14159265358979323846 / 180.0;
    synth_random random;
    synth_random_seed(&random, seed * 64 + (uint64_t)index + 0x63616d);
    const double aside = synth_random_between(&random, -0.8, 0.8);
    synth_camera camera = {{2.5 + aside, 0, 0}, 0, 0, 0, 780.0 * width / 1052.0, width, height};
    camera.position.y = -1.45 + synth_random_between(&random, -0.2, 0.2);
    camera.position.z = synth_random_between(&random, -0.4, 1.0);
    camera.yaw = (synth_random_between(&random, -8, 8) - 8 * aside) * degree;
    camera.pitch = synth_random_between(&random, 2, 9) * degree;
    camera.roll = synth_random_between(&random, -3, 3) * degree;
    return camera;
}
