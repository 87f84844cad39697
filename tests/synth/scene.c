/* SPDX-License-Identifier: BSD-2-Clause */
/* The list of polygons, and ear clipping for polygons that are not convex (Meisters 1975: every simple polygon has an ear). */
#include "scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

synth_paint synth_flat(double gray)
{
    const synth_paint paint = {gray, 0.0, 0.0, 0.0, 0.0};
    return paint;
}

double synth_paint_at(const synth_paint *paint, double x, double y)
{
    return paint->gray + paint->slope_x * (x - paint->x0) + paint->slope_y * (y - paint->y0);
}

void synth_scene_init(synth_scene *scene, int32_t width, int32_t height, double background)
{
    memset(scene, 0, sizeof *scene);
    scene->width = width;
    scene->height = height;
    scene->background = synth_flat(background);
}

void synth_scene_free(synth_scene *scene)
{
    free(scene->polygons);
    scene->polygons = NULL;
    scene->count = scene->capacity = 0;
}

static double turn(synth_point a, synth_point b, synth_point c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static double signed_area(const synth_point *corners, int32_t count)
{
    double twice = 0.0;
    for (int32_t i = 1; i + 1 < count; i++)
        twice += turn(corners[0], corners[i], corners[i + 1]);
    return 0.5 * twice;
}

static void add_convex(synth_scene *scene, const synth_point *corners, int32_t count, synth_paint paint, int32_t tag)
{
    if (scene->count == scene->capacity) {
        const int32_t capacity = scene->capacity ? 2 * scene->capacity : 32;
        synth_polygon *grown = realloc(scene->polygons, (size_t)capacity * sizeof *grown);
        if (!grown) {
            scene->failed = 1;
            return;
        }
        scene->polygons = grown;
        scene->capacity = capacity;
    }
    synth_polygon *polygon = &scene->polygons[scene->count++];
    memset(polygon, 0, sizeof *polygon);
    memcpy(polygon->corners, corners, (size_t)count * sizeof *corners);
    polygon->count = count;
    polygon->paint = paint;
    polygon->tag = tag;
}

/* Copies the corners with positive area and without repetitions. */
static int32_t tidy(const synth_point *corners, int32_t count, synth_point *out)
{
    const int forward = signed_area(corners, count) > 0.0;
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        const synth_point p = corners[forward ? i : count - 1 - i];
        if (kept == 0 || p.x != out[kept - 1].x || p.y != out[kept - 1].y)
            out[kept++] = p;
    }
    while (kept > 1 && out[kept - 1].x == out[0].x && out[kept - 1].y == out[0].y)
        kept--;
    return kept;
}

/* Right turns below rounding noise count as straight. Every corner to the left of no edge and area > 0: convex, since the
 * polygon is simple. */
static int is_convex(const synth_point *corners, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        const synth_point a = corners[i], b = corners[(i + 1) % count], c = corners[(i + 2) % count];
        const double scale = (fabs(b.x - a.x) + fabs(b.y - a.y)) * (fabs(c.x - b.x) + fabs(c.y - b.y));
        if (turn(a, b, c) < -1e-9 * scale)
            return 0;
    }
    return 1;
}

static int inside_triangle(synth_point a, synth_point b, synth_point c, synth_point p)
{
    return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

static int is_ear(const synth_point *ring, int32_t count, int32_t i)
{
    const synth_point a = ring[(i + count - 1) % count], b = ring[i], c = ring[(i + 1) % count];
    if (turn(a, b, c) <= 0.0)
        return 0;
    for (int32_t k = 0; k < count; k++) {
        const int32_t distance = (k - i + count) % count;
        if (distance <= 1 || distance == count - 1)
            continue;
        if (inside_triangle(a, b, c, ring[k]))
            return 0;
    }
    return 1;
}

static void add_triangles(synth_scene *scene, synth_point *ring, int32_t count, synth_paint paint, int32_t tag)
{
    while (count >= 3) {
        int32_t ear = 0;
        while (ear < count && !is_ear(ring, count, ear))
            ear++;
        if (ear == count) { /* only straight corners left: drop one; otherwise the polygon crosses itself */
            ear = 0;
            while (ear < count && turn(ring[(ear + count - 1) % count], ring[ear], ring[(ear + 1) % count]) != 0.0)
                ear++;
            if (ear == count) {
                scene->failed = 1;
                return;
            }
        } else {
            const synth_point triangle[3] = {ring[(ear + count - 1) % count], ring[ear], ring[(ear + 1) % count]};
            add_convex(scene, triangle, 3, paint, tag);
        }
        memmove(&ring[ear], &ring[ear + 1], (size_t)(count - 1 - ear) * sizeof *ring);
        count--;
    }
}

void synth_scene_add(synth_scene *scene, const synth_point *corners, int32_t count, synth_paint paint, int32_t tag)
{
    if (count < 3 || fabs(signed_area(corners, count)) < 1e-12)
        return;
    synth_point *ring = malloc((size_t)count * sizeof *ring);
    if (!ring) {
        scene->failed = 1;
        return;
    }
    const int32_t kept = tidy(corners, count, ring);
    if (kept <= SYNTH_MAX_CORNERS && is_convex(ring, kept))
        add_convex(scene, ring, kept, paint, tag);
    else
        add_triangles(scene, ring, kept, paint, tag);
    free(ring);
}

int32_t synth_scene_top(const synth_scene *scene, double x, double y)
{
    const synth_point p = {x, y};
    for (int32_t i = scene->count - 1; i >= 0; i--) {
        const synth_polygon *polygon = &scene->polygons[i];
        int inside = 1;
        for (int32_t k = 0; k < polygon->count && inside; k++)
            inside = turn(polygon->corners[k], polygon->corners[(k + 1) % polygon->count], p) >= 0.0;
        if (inside)
            return i;
    }
    return -1;
}

double synth_scene_gray(const synth_scene *scene, double x, double y)
{
    const int32_t top = synth_scene_top(scene, x, y);
    return synth_paint_at(top < 0 ? &scene->background : &scene->polygons[top].paint, x, y);
}
