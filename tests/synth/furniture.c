/* SPDX-License-Identifier: BSD-2-Clause */
#include "furniture.h"

#include <stdlib.h>
#include <string.h>

synth_vector room_vector(double x, double y, double z)
{
    const synth_vector v = {x, y, z};
    return v;
}

static synth_vector on_face(const room_face *f, double u, double v)
{
    return room_vector(f->origin.x + u * f->u.x + v * f->v.x, f->origin.y + u * f->u.y + v * f->v.y,
                  f->origin.z + u * f->u.z + v * f->v.z);
}

static void *grow(synth_room *room, void *items, int32_t count, int32_t *capacity, size_t size)
{
    if (count < *capacity)
        return items;
    const int32_t larger = *capacity ? 2 * *capacity : 64;
    void *grown = realloc(items, (size_t)larger * size);
    if (!grown) {
        room->failed = 1;
        return items;
    }
    *capacity = larger;
    return grown;
}

void room_begin_object(synth_room *room, synth_vector middle, synth_vector group, int32_t rank)
{
    room->objects = grow(room, room->objects, room->object_count, &room->object_capacity, sizeof *room->objects);
    if (room->failed)
        return;
    const synth_object object = {middle, group, rank, 0};
    room->objects[room->object_count++] = object;
}

void room_add_polygon(synth_room *room, const room_face *f, const synth_point *uv, int32_t count, double gray)
{
    room->surfaces = grow(room, room->surfaces, room->surface_count, &room->surface_capacity, sizeof *room->surfaces);
    if (room->failed || count > SYNTH_ROOM_CORNERS)
        return;
    synth_surface *s = &room->surfaces[room->surface_count++];
    memset(s, 0, sizeof *s);
    for (int32_t i = 0; i < count; i++)
        s->corners[i] = on_face(f, uv[i].x, uv[i].y);
    s->count = count;
    s->object = room->object_count - 1;
    /* v x u points to the viewer: u right (x), v down (y) gives v x u = -z, towards smaller z. */
    s->normal = room_vector(f->v.y * f->u.z - f->v.z * f->u.y, f->v.z * f->u.x - f->v.x * f->u.z,
                            f->v.x * f->u.y - f->v.y * f->u.x);
    s->gray = gray * f->light;
}

void room_add_rectangle(synth_room *room, const room_face *f, double u0, double v0, double u1, double v1, double gray)
{
    const synth_point uv[4] = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
    room_add_polygon(room, f, uv, 4, gray);
}

void room_add_framed(synth_room *room, const room_face *f, double u0, double v0, double u1, double v1, double rim,
                     double rim_gray, double gray)
{
    room_add_rectangle(room, f, u0, v0, u1, v1, rim_gray);
    room_add_rectangle(room, f, u0 + rim, v0 + rim, u1 - rim, v1 - rim, gray);
}

/* ---- boxes ---- */

room_face room_box_face(const room_box *b, int side)
{
    const room_face faces[4] = {
        {{b->x0, -b->top, b->z0}, {1, 0, 0}, {0, 1, 0}, 1.0},
        {{b->x0, -b->top, b->z1}, {0, 0, -1}, {0, 1, 0}, 0.82},
        {{b->x1, -b->top, b->z0}, {0, 0, 1}, {0, 1, 0}, 0.72},
        {{b->x0, -b->top, b->z1}, {1, 0, 0}, {0, 0, -1}, 1.18},
    };
    return faces[side];
}

void room_add_box(synth_room *room, const room_box *b, synth_vector group, int32_t rank, double gray)
{
    room_begin_object(room, room_vector(0.5 * (b->x0 + b->x1), -0.5 * (b->top + b->bottom), 0.5 * (b->z0 + b->z1)), group, rank);
    for (int side = ROOM_FRONT; side <= ROOM_TOP; side++) {
        const room_face f = room_box_face(b, side);
        const double u = side == ROOM_LEFT || side == ROOM_RIGHT ? b->z1 - b->z0 : b->x1 - b->x0;
        const double v = side == ROOM_TOP ? b->z1 - b->z0 : b->top - b->bottom;
        room_add_rectangle(room, &f, 0.0, 0.0, u, v, gray);
    }
}

synth_vector room_box_middle(const room_box *b)
{
    return room_vector(0.5 * (b->x0 + b->x1), -0.5 * (b->top + b->bottom), 0.5 * (b->z0 + b->z1));
}
