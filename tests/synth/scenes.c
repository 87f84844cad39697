/* SPDX-License-Identifier: BSD-2-Clause */
#include "scenes.h"

#include "random.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846
#define CLEARANCE 12.0
#define TILES 5

static double degrees(double value)
{
    return value * (PI / 180.0);
}

static synth_point turned(synth_point centre, double u, double v, double angle)
{
    const synth_point p = {centre.x + u * cos(angle) - v * sin(angle), centre.y + u * sin(angle) + v * cos(angle)};
    return p;
}

/* ---- parallelograms ---- */

/* Separating axes: the largest gap between two convex quadrilaterals along any edge normal; at most their distance. */
static double gap_along(const synth_point *a, const synth_point *b)
{
    double gap = -HUGE_VAL;
    for (int i = 0; i < 4; i++) {
        const synth_point p = a[i], q = a[(i + 1) % 4];
        const double length = hypot(q.x - p.x, q.y - p.y), nx = (q.y - p.y) / length, ny = -(q.x - p.x) / length;
        double amin = HUGE_VAL, amax = -HUGE_VAL, bmin = HUGE_VAL, bmax = -HUGE_VAL;
        for (int k = 0; k < 4; k++) {
            const double s = a[k].x * nx + a[k].y * ny, t = b[k].x * nx + b[k].y * ny;
            amin = fmin(amin, s);
            amax = fmax(amax, s);
            bmin = fmin(bmin, t);
            bmax = fmax(bmax, t);
        }
        gap = fmax(gap, fmax(bmin - amax, amin - bmax));
    }
    return gap;
}

static int fits(const synth_scene *scene, const synth_point *corners)
{
    for (int k = 0; k < 4; k++)
        if (corners[k].x < CLEARANCE || corners[k].y < CLEARANCE || corners[k].x > scene->width - 1 - CLEARANCE ||
            corners[k].y > scene->height - 1 - CLEARANCE)
            return 0;
    for (int32_t i = 0; i < scene->count; i++)
        if (fmax(gap_along(corners, scene->polygons[i].corners), gap_along(scene->polygons[i].corners, corners)) < CLEARANCE)
            return 0;
    return 1;
}

void synth_parallelograms(synth_scene *scene, double contrast, uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    const double background = synth_random_between(&random, 90.0, 165.0);
    synth_scene_init(scene, 320, 240, background);
    for (int tries = 0; scene->count < 3 && tries < 100000 && !scene->failed; tries++) {
        if (tries % 1000 == 999) /* the first ones may leave no room */
            scene->count = 0;
        synth_point corner;
        corner.x = synth_random_between(&random, 0.0, 320.0);
        corner.y = synth_random_between(&random, 0.0, 240.0);
        const double side_a = synth_random_between(&random, 30.0, 90.0);
        const double side_b = synth_random_between(&random, 30.0, 90.0);
        const double angle = synth_random_between(&random, 0.0, 2.0 * PI);
        const double opening = degrees(synth_random_between(&random, 60.0, 120.0));
        const double sign = synth_random_unit(&random) < 0.5 ? -1.0 : 1.0;
        const synth_point a = turned(corner, side_a, 0.0, angle), b = turned(corner, side_b, 0.0, angle + opening);
        const synth_point corners[4] = {corner, a, {a.x + b.x - corner.x, a.y + b.y - corner.y}, b};
        if (fits(scene, corners))
            synth_scene_add(scene, corners, 4, synth_flat(background + sign * contrast), scene->count);
    }
}

void synth_add_rectangle(synth_scene *scene, synth_point corner, double width, double height, double angle, double gray)
{
    const synth_point corners[4] = {corner, turned(corner, width, 0.0, angle), turned(corner, width, height, angle),
                                    turned(corner, 0.0, height, angle)};
    synth_scene_add(scene, corners, 4, synth_flat(gray), scene->count);
}

/* ---- stars ---- */

void synth_add_star(synth_scene *scene, synth_point centre, const double *angles, const double *grays, int32_t count,
                    double radius)
{
    for (int32_t i = 0; i < count; i++) {
        if (grays[i] < 0.0)
            continue;
        const double from = angles[i];
        double to = angles[(i + 1) % count];
        while (to <= from)
            to += 2.0 * PI;
        /* The rim is drawn in chords of at most 100 deg: a sector of more than 180 deg is a polygon too, and no rim corner is
         * shallow. */
        synth_point corners[12];
        const int32_t steps = (int32_t)ceil((to - from) / degrees(100.0) - 1e-9);
        int32_t n = 0;
        corners[n++] = centre;
        for (int32_t k = 0; k <= steps && n < 12; k++)
            corners[n++] = turned(centre, radius, 0.0, from + (to - from) * k / steps);
        synth_scene_add(scene, corners, n, synth_flat(grays[i]), scene->count);
    }
}

void synth_random_star(synth_scene *scene, double step, uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    const int32_t count = 2 + (int32_t)(seed % 4);
    double angles[5], grays[5], smallest;
    do { /* openings of at least 40 deg, and an L not straight */
        smallest = HUGE_VAL;
        angles[0] = synth_random_between(&random, 0.0, 2.0 * PI);
        for (int32_t i = 1; i < count; i++)
            angles[i] = angles[i - 1] + synth_random_between(&random, degrees(40.0), degrees(180.0));
        for (int32_t i = 0; i < count; i++)
            smallest = fmin(smallest, i + 1 < count ? angles[i + 1] - angles[i] : angles[0] + 2.0 * PI - angles[i]);
    } while (smallest < degrees(40.0) || (count == 2 && fabs(angles[1] - angles[0] - PI) < degrees(20.0)));
    for (int32_t i = 0; i < count; i++) {
        int clear;
        do {
            grays[i] = synth_random_between(&random, 40.0, 215.0);
            clear = fabs(grays[i] - 20.0) >= step && (i == 0 || fabs(grays[i] - grays[i - 1]) >= step);
            clear = clear && (i < count - 1 || fabs(grays[i] - grays[0]) >= step);
        } while (!clear);
    }
    synth_scene_init(scene, 200, 200, 20.0);
    synth_point centre;
    centre.x = synth_random_between(&random, 95.0, 105.0);
    centre.y = synth_random_between(&random, 95.0, 105.0);
    synth_add_star(scene, centre, angles, grays, count, 70.0);
}

/* ---- boards ---- */

/* TILES + 1 positions, 32 .. 42 apart, around 0. */
static void positions(synth_random *random, double *at)
{
    at[0] = 0.0;
    for (int i = 1; i <= TILES; i++)
        at[i] = at[i - 1] + synth_random_between(random, 32.0, 42.0);
    const double half = 0.5 * at[TILES];
    for (int i = 0; i <= TILES; i++)
        at[i] -= half;
}

static synth_point middle(synth_random *random)
{
    synth_point p;
    p.x = 159.5 + synth_random_between(random, -6.0, 6.0);
    p.y = 119.5 + synth_random_between(random, -6.0, 6.0);
    return p;
}

/* A board of up to 210 px needs room when it is turned: the image is 320 x 300 for boards. */
static synth_point board_middle(synth_random *random)
{
    synth_point p = middle(random);
    p.y += 30.0;
    return p;
}

static void add_tile(synth_scene *scene, synth_point centre, double angle, double u0, double v0, double u1, double v1, double gray)
{
    const synth_point corners[4] = {turned(centre, u0, v0, angle), turned(centre, u1, v0, angle), turned(centre, u1, v1, angle),
                                    turned(centre, u0, v1, angle)};
    synth_scene_add(scene, corners, 4, synth_flat(gray), scene->count);
}

void synth_tiles(synth_scene *scene, int32_t kind, uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    synth_scene_init(scene, 320, 300, 128.0);
    double u[TILES + 1], v[TILES + 1];
    positions(&random, u);
    positions(&random, v);
    const synth_point centre = board_middle(&random);
    const double angle = degrees(synth_random_between(&random, -20.0, 20.0));
    for (int j = 0; j < TILES; j++)
        for (int i = 0; i < TILES; i++) {
            const double random_gray = synth_random_between(&random, 40.0, 215.0);
            const double gray = kind == SYNTH_CHECKERBOARD ? ((i + j) % 2 ? 190.0 : 90.0) : random_gray;
            add_tile(scene, centre, angle, u[i], v[j], u[i + 1], v[j + 1], gray);
        }
}

void synth_border(synth_scene *scene, uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    synth_scene_init(scene, 320, 240, 128.0);
    double u[TILES + 1];
    positions(&random, u);
    const synth_point centre = middle(&random);
    const double angle = degrees(synth_random_between(&random, -20.0, 20.0));
    /* The floor below the border is darker than every tile and than the background, so the border has a step everywhere. */
    add_tile(scene, centre, angle, u[0] - 20.0, 0.0, u[TILES] + 20.0, 45.0, 60.0);
    double last = 128.0;
    for (int i = 0; i < TILES; i++) {
        double gray = last;
        while (fabs(gray - last) < 20.0 || fabs(gray - 128.0) < 20.0)
            gray = synth_random_between(&random, 90.0, 220.0);
        last = gray;
        const double height = synth_random_between(&random, 0.0, 4.0) + (i % 2 ? 30.0 : 46.0);
        add_tile(scene, centre, angle, u[i], -height, u[i + 1], 0.0, gray);
    }
}

void synth_line_grid(synth_scene *scene, synth_point ends[2 * SYNTH_GRID_LINES], uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    synth_scene_init(scene, 320, 300, 190.0);
    double u[TILES + 1], v[TILES + 1];
    positions(&random, u);
    positions(&random, v);
    const synth_point centre = board_middle(&random);
    const double angle = degrees(synth_random_between(&random, -20.0, 20.0));
    for (int i = 0; i < TILES; i++) {
        const double u0 = u[0], u1 = u[TILES - 1], v0 = v[0], v1 = v[TILES - 1];
        add_tile(scene, centre, angle, u[i] - 1.0, v0, u[i] + 1.0, v1, 80.0);
        add_tile(scene, centre, angle, u0, v[i] - 1.0, u1, v[i] + 1.0, 80.0);
        ends[4 * i] = turned(centre, u[i], v0, angle);
        ends[4 * i + 1] = turned(centre, u[i], v1, angle);
        ends[4 * i + 2] = turned(centre, u0, v[i], angle);
        ends[4 * i + 3] = turned(centre, u1, v[i], angle);
    }
}
