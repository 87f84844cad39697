/* SPDX-License-Identifier: BSD-2-Clause */
/* Viewpoints far apart, and what cameras make of them.
 *
 * A camera stands anywhere in the free part of the room (in front of the boxes, as the painter's order needs), looks anywhere, and
 * what it sees in its middle is the target. A second one stands somewhere else and looks nearly there too. Kept are pairs that see
 * the target under 30 to 70 degrees, at distances with a ratio up to 2.5; which angle and which ratio is drawn first, so that the
 * hard ones are as frequent as the easy ones.
 *
 * Colour: every object and every wall has a tint of its own, its surfaces lie around it; grey levels stay those of the room, as far
 * as they can. */
#include "wide_pair.h"
#include "random.h"
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE (3.14159265358979323846 / 180.0)
#define TRIALS 20000
#define LEAST_CORNERS 40 /* a bare wall shows nothing to anybody */
#define GRID 24 /* points along a side for the common area */

static double between(synth_random *random, double low, double high)
{
    return synth_random_between(random, low, high);
}

static double square(double x)
{
    return x * x;
}

static double distance(synth_vector a, synth_vector b)
{
    return sqrt(square(a.x - b.x) + square(a.y - b.y) + square(a.z - b.z));
}

/* Degrees between the directions from `target` to a and b. */
static double angle_at(synth_vector target, synth_vector a, synth_vector b)
{
    const double x = (a.x - target.x) * (b.x - target.x), y = (a.y - target.y) * (b.y - target.y);
    const double z = (a.z - target.z) * (b.z - target.z), dot = x + y + z;
    return acos(fmax(-1, fmin(1, dot / (distance(target, a) * distance(target, b) + 1e-12)))) / DEGREE;
}

/* The free part of a room: what its corners span, less what its boxes take. */
typedef struct space {
    double wide, high, near_end, front;
} space;

static space free_space(const synth_room *room)
{
    space s = {0, 0, 0, 1e9};
    for (int32_t i = 0; i < room->surface_count; i++)
        for (int32_t k = 0; k < room->surfaces[i].count; k++) {
            const synth_vector p = room->surfaces[i].corners[k];
            s.wide = fmax(s.wide, p.x);
            s.high = fmax(s.high, -p.y);
            s.near_end = fmin(s.near_end, p.z);
            if (room->surfaces[i].object > 0)
                s.front = fmin(s.front, p.z);
        }
    double deep = 0;
    for (int32_t i = 0; i < room->surface_count; i++)
        for (int32_t k = 0; k < room->surfaces[i].count; k++)
            deep = fmax(deep, room->surfaces[i].corners[k].z);
    s.front = fmin(s.front, deep - 1.0) - 0.5;
    return s;
}

static synth_vector anywhere(const space *s, synth_random *random)
{
    const double x = between(random, 0.3, s->wide - 0.3), y = between(random, -1.8, -1.1);
    const synth_vector p = {x, y, between(random, s->near_end + 0.2, s->front)};
    return p;
}

static synth_camera stand(synth_vector position, double yaw, double pitch, double roll, double focal)
{
    const synth_camera camera = {position, yaw, pitch, roll, focal, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT};
    return camera;
}

static synth_camera look_at(synth_vector position, synth_vector target, double roll, double focal)
{
    const double x = target.x - position.x, y = target.y - position.y, z = target.z - position.z;
    return stand(position, atan2(x, z), atan2(y, hypot(x, z)), roll, focal);
}

/* Does the camera see a wall all over? Behind the near end there is nothing. */
static int sees_everywhere(const synth_room *room, const synth_camera *camera)
{
    for (int i = 0; i < 9; i++) {
        synth_vector met;
        const double x = i % 3 * 0.5 * (camera->width - 1), y = (double)(i / 3) * 0.5 * (camera->height - 1);
        if (synth_room_trace(room, camera, x, y, &met) < 0)
            return 0;
    }
    return 1;
}

static double common_share(const synth_room *room, const synth_camera *from, const synth_camera *to)
{
    int seen = 0;
    for (int i = 0; i < GRID * GRID; i++) {
        synth_point image;
        const double x = (i % GRID + 0.5) * from->width / GRID, y = ((double)(i / GRID) + 0.5) * from->height / GRID;
        seen += synth_room_transfer(room, from, x, y, to, &image);
    }
    return (double)seen / (GRID * GRID);
}

static int shows(const synth_room *room, const synth_camera *camera, synth_vector point)
{
    synth_point p;
    return synth_camera_project(camera, point, &p) && p.x > 0 && p.y > 0 && p.x < camera->width - 1 && p.y < camera->height - 1 &&
           synth_room_visible(room, camera, point);
}

/* Corners of surfaces that both cameras see. */
static int32_t common_corners(const synth_room *room, const synth_camera cameras[2])
{
    int32_t count = 0;
    for (int32_t i = 0; i < room->surface_count; i++)
        for (int32_t k = 0; k < room->surfaces[i].count; k++) {
            const synth_vector corner = room->surfaces[i].corners[k];
            count += shows(room, &cameras[0], corner) && shows(room, &cameras[1], corner);
        }
    return count;
}

/* Do both cameras see enough, and the same? Sets what the pair says of that. */
static int is_good(synth_wide_pair *pair, synth_vector target)
{
    const synth_camera *a = &pair->cameras[0], *b = &pair->cameras[1];
    if (fabs(b->yaw) > 80 * DEGREE || !synth_room_visible(&pair->room, b, target) || !sees_everywhere(&pair->room, a) ||
        !sees_everywhere(&pair->room, b))
        return 0;
    pair->angle = angle_at(target, a->position, b->position);
    pair->scale = distance(target, a->position) / distance(target, b->position);
    pair->common = fmin(common_share(&pair->room, a, b), common_share(&pair->room, b, a));
    pair->corners = common_corners(&pair->room, pair->cameras);
    return pair->common > 0.15 && pair->corners >= LEAST_CORNERS;
}

/* Camera 1, anywhere, and what it has in the middle of its image; 0: nothing. */
static int place_first(synth_wide_pair *pair, const space *s, double focal, synth_random *random, synth_vector *target)
{
    synth_camera *a = &pair->cameras[0];
    /* one after the other: the order of a call's arguments is the compiler's choice */
    const double roll = between(random, -5, 5) * DEGREE, pitch = between(random, -5, 20) * DEGREE;
    const double yaw = between(random, -50, 50) * DEGREE;
    *a = stand(anywhere(s, random), yaw, pitch, roll, focal);
    return synth_room_trace(&pair->room, a, 0.5 * (a->width - 1), 0.5 * (a->height - 1), target) >= 0;
}

static int find_cameras(synth_wide_pair *pair, synth_random *random)
{
    const space s = free_space(&pair->room);
    const double angle = between(random, 30, 70), scale = exp(between(random, -log(2.5), log(2.5)));
    const double focal = between(random, 0.8, 1.15) * SYNTH_WIDE_WIDTH;
    for (int i = 0; i < TRIALS; i++) {
        synth_vector target;
        synth_camera *a = &pair->cameras[0], *b = &pair->cameras[1];
        const double loose = 1 + 9.0 * i / TRIALS; /* what was drawn need not fit the room */
        if (!place_first(pair, &s, focal, random, &target))
            continue;
        const synth_vector position = anywhere(&s, random);
        pair->angle = angle_at(target, a->position, position);
        pair->scale = distance(target, a->position) / distance(target, position);
        if (pair->angle < 30 || pair->angle > 70 || fabs(pair->angle - angle) > 4 * loose || fabs(log(pair->scale)) > log(2.5) ||
            fabs(log(pair->scale / scale)) > 0.1 * loose || distance(target, position) < 1 || distance(target, a->position) < 1)
            continue;
        *b = look_at(position, target, between(random, -5, 5) * DEGREE, focal);
        b->yaw += between(random, -8, 8) * DEGREE;
        b->pitch += between(random, -5, 5) * DEGREE;
        if (is_good(pair, target))
            return 0;
    }
    return -1;
}

/* A step in any direction, as far as puts the target under `angle` or less. */
static synth_vector step_from(const synth_camera *camera, synth_vector target, double angle, synth_random *random)
{
    const double length = distance(target, camera->position) * angle * DEGREE;
    const double around = between(random, 0, 360) * DEGREE, up = between(random, -1, 1), flat = sqrt(1 - up * up);
    const synth_vector p = camera->position;
    return (synth_vector){p.x + length * flat * cos(around), p.y + length * up, p.z + length * flat * sin(around)};
}

static int find_near_cameras(synth_wide_pair *pair, synth_random *random)
{
    const space s = free_space(&pair->room);
    const double angle = exp(between(random, log(1), log(15))), focal = between(random, 0.8, 1.15) * SYNTH_WIDE_WIDTH;
    for (int i = 0; i < TRIALS; i++) {
        synth_vector target;
        synth_camera *a = &pair->cameras[0], *b = &pair->cameras[1];
        if (!place_first(pair, &s, focal, random, &target))
            continue;
        const synth_vector position = step_from(a, target, angle, random);
        if (distance(target, position) < 1 || distance(target, a->position) < 1)
            continue;
        *b = look_at(position, target, between(random, -5, 5) * DEGREE, focal);
        b->yaw += between(random, -4, 4) * DEGREE;
        b->pitch += between(random, -4, 4) * DEGREE;
        if (is_good(pair, target))
            return 0;
    }
    return -1;
}

/* The same place, turned: to the sides by up to 25 degrees, up and down by 10, about its axis by 10. */
static int find_turned_cameras(synth_wide_pair *pair, synth_random *random)
{
    const space s = free_space(&pair->room);
    const double focal = between(random, 0.8, 1.15) * SYNTH_WIDE_WIDTH;
    for (int i = 0; i < TRIALS; i++) {
        synth_vector target;
        synth_camera *a = &pair->cameras[0], *b = &pair->cameras[1];
        if (!place_first(pair, &s, focal, random, &target))
            continue;
        const double yaw = between(random, -25, 25), pitch = between(random, -10, 10), roll = between(random, -10, 10);
        *b = stand(a->position, a->yaw + yaw * DEGREE, a->pitch + pitch * DEGREE, a->roll + roll * DEGREE, focal);
        if (distance(target, a->position) >= 1 && is_good(pair, target))
            return 0;
    }
    return -1;
}

static void set_exposure(synth_exposure *e, synth_random *random)
{
    const double shake = between(random, -1, 1) > 0.2 ? between(random, 0, 5) : 0, direction = between(random, 0, 360) * DEGREE;
    e->gain = between(random, 0.7, 1.3);
    for (int c = 0; c < 3; c++)
        e->white[c] = between(random, 0.85, 1.15);
    e->gamma = between(random, 0.85, 1.15);
    e->blur = between(random, 0.6, 1.6);
    e->shake[0] = shake * cos(direction);
    e->shake[1] = shake * sin(direction);
    e->noise = between(random, 1, 4);
    e->noise_seed = synth_random_bits(random);
}

typedef int finder(synth_wide_pair *pair, synth_random *random);

static int make(synth_wide_pair *pair, uint64_t seed, finder *find)
{
    synth_random random;
    memset(pair, 0, sizeof *pair);
    if (synth_room_random(&pair->room, seed) != 0)
        return -1;
    pair->seed = seed;
    synth_random_seed(&random, seed * 8 + 0x77696465);
    if (find(pair, &random) != 0) {
        synth_wide_pair_free(pair);
        return -1;
    }
    for (int v = 0; v < 2; v++)
        set_exposure(&pair->exposures[v], &random);
    return 0;
}

int synth_wide_pair_make(synth_wide_pair *pair, uint64_t seed)
{
    return make(pair, seed, find_cameras);
}

int synth_near_pair_make(synth_wide_pair *pair, uint64_t seed)
{
    return make(pair, seed, find_near_cameras);
}

int synth_turned_pair_make(synth_wide_pair *pair, uint64_t seed)
{
    return make(pair, seed, find_turned_cameras);
}

void synth_wide_pair_free(synth_wide_pair *pair)
{
    synth_room_free(&pair->room);
}

/* ---- the picture ---- */

/* What a channel of a surface is multiplied by: the tint of its object, or of its wall (surfaces of one plane), and a little of its
 * own. The channels' weights sum to one in grey: 0.299 R + 0.587 G + 0.114 B. */
static double tint(const synth_wide_pair *pair, int32_t surface, int channel)
{
    const synth_surface *s = &pair->room.surfaces[surface];
    synth_random random;
    double own[3], sum = 0;
    const uint64_t side = s->normal.x > 0.5 ? 1 : s->normal.x < -0.5 ? 2 : 0;
    const uint64_t wall = side ? side : s->normal.y > 0.5 ? 3 : s->normal.y < -0.5 ? 4 : 5;
    const uint64_t thing = s->object > 0 ? 16 + (uint64_t)s->object : wall;
    synth_random_seed(&random, pair->seed * 4099 + thing);
    for (int c = 0; c < 3; c++)
        own[c] = between(&random, 0.85, 1.15);
    synth_random_seed(&random, pair->seed * 4099 + 4096 + (uint64_t)surface);
    const double strength = between(&random, 0, 1) < 0.3 ? 0.4 : 0.1;
    for (int c = 0; c < 3; c++) {
        static const double weights[3] = {0.299, 0.587, 0.114};
        own[c] *= 1 + strength * between(&random, -1, 1);
        sum += weights[c] * own[c];
    }
    return own[channel] / sum;
}

/* Mean along the way that the picture moves: samples half a pixel apart, bilinear. */
static int shake_picture(double *samples, int32_t width, int32_t height, const double way[2])
{
    const int steps = (int)ceil(2 * hypot(way[0], way[1])) + 1;
    double *copy = malloc((size_t)width * (size_t)height * sizeof *copy);
    if (!copy)
        return -1;
    memcpy(copy, samples, (size_t)width * (size_t)height * sizeof *copy);
    for (int32_t y = 0; y < height && steps > 1; y++)
        for (int32_t x = 0; x < width; x++) {
            double sum = 0;
            for (int k = 0; k < steps; k++) {
                const double t = (double)k / (steps - 1) - 0.5;
                const double u = fmax(0, fmin(width - 1.001, x + t * way[0])), v = fmax(0, fmin(height - 1.001, y + t * way[1]));
                const double *p = copy + (size_t)v * (size_t)width + (size_t)u;
                const double a = u - floor(u), b = v - floor(v);
                sum += (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * p[width] + a * p[width + 1]);
            }
            samples[(size_t)y * (size_t)width + (size_t)x] = sum / steps;
        }
    free(copy);
    return 0;
}

static int channel(const synth_wide_pair *pair, const synth_exposure *e, synth_view *view, int c, double *samples)
{
    synth_scene scene = view->scene;
    scene.polygons = malloc(((size_t)scene.count + 1) * sizeof *scene.polygons);
    if (!scene.polygons)
        return -1;
    for (int32_t i = 0; i < scene.count; i++) {
        synth_paint *paint = &scene.polygons[i].paint;
        scene.polygons[i] = view->scene.polygons[i];
        const double factor = tint(pair, scene.polygons[i].tag, c);
        paint->gray *= factor;
        paint->slope_x *= factor;
        paint->slope_y *= factor;
    }
    const size_t count = (size_t)scene.width * (size_t)scene.height;
    int result = synth_render(&scene, samples);
    for (size_t i = 0; i < count && result == 0; i++)
        samples[i] = 255 * pow(fmax(samples[i], 0) / 255, e->gamma) * e->gain * e->white[c];
    if (result == 0)
        result = shake_picture(samples, scene.width, scene.height, e->shake);
    if (result == 0)
        result = synth_blur(samples, scene.width, scene.height, e->blur);
    if (result == 0)
        synth_add_noise(samples, count, e->noise, e->noise_seed + (uint64_t)c);
    free(scene.polygons);
    return result;
}

uint8_t *synth_wide_picture(const synth_wide_pair *pair, int32_t which)
{
    const synth_camera *camera = &pair->cameras[which];
    const size_t count = (size_t)camera->width * (size_t)camera->height;
    synth_view view;
    if (synth_view_paint(&pair->room, camera, &view) != 0)
        return NULL;
    double *samples = malloc(count * sizeof *samples);
    uint8_t *plane = malloc(count), *pixels = malloc(3 * count);
    int result = samples && plane && pixels ? 0 : -1;
    for (int c = 0; c < 3 && result == 0; c++) {
        result = channel(pair, &pair->exposures[which], &view, c, samples);
        if (result != 0)
            break;
        synth_to_gray8(samples, count, plane);
        for (size_t i = 0; i < count; i++)
            pixels[3 * i + (size_t)c] = plane[i];
    }
    synth_view_free(&view);
    free(samples);
    free(plane);
    if (result != 0) {
        free(pixels);
        pixels = NULL;
    }
    return pixels;
}
