/* SPDX-License-Identifier: BSD-2-Clause */
/* From the room to a picture: cull what faces away, sort objects far to near (exact here: see the test that traces rays), clip
 * to the field of view, project, paint. And back: rays, visibility, corners. */
#include "room.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NEAR 0.05     /* m */
#define BEYOND 4.0    /* px outside the image up to where surfaces are kept */
#define SAME_POINT 1e-5 /* m */

static synth_vector minus(synth_vector a, synth_vector b)
{
    const synth_vector v = {a.x - b.x, a.y - b.y, a.z - b.z};
    return v;
}

static double dot(synth_vector a, synth_vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double distance(synth_vector a, synth_vector b)
{
    const synth_vector d = minus(a, b);
    return sqrt(dot(d, d));
}

/* World to camera. Yaw about y (down): looking right turns +x into the view; pitch about x: looking down turns +y into it. */
static synth_vector to_camera(const synth_camera *c, synth_vector p)
{
    const synth_vector d = minus(p, c->position);
    const double x1 = cos(c->yaw) * d.x - sin(c->yaw) * d.z, z1 = sin(c->yaw) * d.x + cos(c->yaw) * d.z;
    const double y2 = cos(c->pitch) * d.y - sin(c->pitch) * z1, z2 = sin(c->pitch) * d.y + cos(c->pitch) * z1;
    const synth_vector q = {cos(c->roll) * x1 + sin(c->roll) * y2, -sin(c->roll) * x1 + cos(c->roll) * y2, z2};
    return q;
}

static synth_vector to_world_direction(const synth_camera *c, synth_vector q)
{
    const double x1 = cos(c->roll) * q.x - sin(c->roll) * q.y, y2 = sin(c->roll) * q.x + cos(c->roll) * q.y;
    const double y1 = cos(c->pitch) * y2 + sin(c->pitch) * q.z, z1 = -sin(c->pitch) * y2 + cos(c->pitch) * q.z;
    const synth_vector d = {cos(c->yaw) * x1 + sin(c->yaw) * z1, y1, -sin(c->yaw) * x1 + cos(c->yaw) * z1};
    return d;
}

static synth_point to_image(const synth_camera *c, synth_vector q)
{
    const synth_point p = {c->focal * q.x / q.z + 0.5 * (c->width - 1), c->focal * q.y / q.z + 0.5 * (c->height - 1)};
    return p;
}

int synth_camera_project(const synth_camera *camera, synth_vector point, synth_point *image)
{
    const synth_vector q = to_camera(camera, point);
    if (q.z < NEAR)
        return 0;
    *image = to_image(camera, q);
    return 1;
}

/* ---- rays ---- */

/* Distance in multiples of `direction` at which the ray meets the surface, or a negative number. */
static double meets(const synth_surface *s, synth_vector from, synth_vector direction)
{
    const double along = dot(s->normal, direction);
    if (along >= -1e-12)
        return -1.0;
    const double t = dot(s->normal, minus(s->corners[0], from)) / along;
    const synth_vector p = {from.x + t * direction.x, from.y + t * direction.y, from.z + t * direction.z};
    double sign = 0.0;
    for (int32_t i = 0; i < s->count; i++) {
        const synth_vector e = minus(s->corners[(i + 1) % s->count], s->corners[i]), d = minus(p, s->corners[i]);
        const synth_vector cross = {e.y * d.z - e.z * d.y, e.z * d.x - e.x * d.z, e.x * d.y - e.y * d.x};
        const double side = dot(cross, s->normal);
        if (fabs(side) < 1e-12)
            continue;
        if (side * sign < 0.0)
            return -1.0;
        sign = side;
    }
    return t;
}

/* Of surfaces in one plane the later one lies on top. */
static int32_t first_hit(const synth_room *room, synth_vector from, synth_vector direction, double *t)
{
    int32_t best = -1;
    for (int32_t i = 0; i < room->surface_count; i++) {
        const double hit = meets(&room->surfaces[i], from, direction);
        if (hit > 0.0 && (best < 0 || hit < *t * (1.0 + 1e-9))) {
            best = i;
            *t = hit;
        }
    }
    return best;
}

int32_t synth_room_trace(const synth_room *room, const synth_camera *camera, double x, double y, synth_vector *point)
{
    const synth_vector q = {(x - 0.5 * (camera->width - 1)) / camera->focal, (y - 0.5 * (camera->height - 1)) / camera->focal, 1.0};
    const synth_vector d = to_world_direction(camera, q);
    double t = 0.0;
    const int32_t surface = first_hit(room, camera->position, d, &t);
    point->x = camera->position.x + t * d.x;
    point->y = camera->position.y + t * d.y;
    point->z = camera->position.z + t * d.z;
    return surface;
}

int synth_room_visible(const synth_room *room, const synth_camera *camera, synth_vector point)
{
    double t = 0.0;
    return first_hit(room, camera->position, minus(point, camera->position), &t) < 0 || t > 1.0 - 1e-6;
}

int synth_room_transfer(const synth_room *room, const synth_camera *from, double x, double y, const synth_camera *to,
                        synth_point *image)
{
    synth_vector point;
    const int32_t surface = synth_room_trace(room, from, x, y, &point);
    if (surface < 0 || !synth_camera_project(to, point, image))
        return 0;
    if (image->x < -0.5 || image->y < -0.5 || image->x > to->width - 0.5 || image->y > to->height - 0.5)
        return 0;
    return dot(room->surfaces[surface].normal, minus(to->position, point)) > 0.0 && synth_room_visible(room, to, point);
}

/* F = K2^-T [e]x R2 R1' K1^-1 with e = R2 (C1 - C2): column k of it is F applied to the k-th unit vector of the first image. */
void synth_fundamental(const synth_camera *first, const synth_camera *second, double f[9])
{
    const synth_vector e = to_camera(second, first->position);
    const double cx1 = 0.5 * (first->width - 1), cy1 = 0.5 * (first->height - 1);
    const double cx2 = 0.5 * (second->width - 1), cy2 = 0.5 * (second->height - 1);
    const synth_vector units[3] = {{1.0 / first->focal, 0, 0}, {0, 1.0 / first->focal, 0},
                                   {-cx1 / first->focal, -cy1 / first->focal, 1}};
    double largest = 0.0;
    for (int k = 0; k < 3; k++) {
        const synth_vector d = to_world_direction(first, units[k]);
        synth_vector point = {second->position.x + d.x, second->position.y + d.y, second->position.z + d.z};
        point = to_camera(second, point); /* the rotation alone, since it starts at the camera */
        const synth_vector n = {e.y * point.z - e.z * point.y, e.z * point.x - e.x * point.z, e.x * point.y - e.y * point.x};
        f[k] = n.x / second->focal;
        f[3 + k] = n.y / second->focal;
        f[6 + k] = n.z - cx2 * f[k] - cy2 * f[3 + k];
    }
    for (int k = 0; k < 9; k++)
        largest = fmax(largest, fabs(f[k]));
    for (int k = 0; k < 9 && largest > 0.0; k++)
        f[k] /= largest;
}

double synth_off_epipolar_line(const double f[9], double x1, double y1, double x2, double y2)
{
    const double a = f[0] * x1 + f[1] * y1 + f[2], b = f[3] * x1 + f[4] * y1 + f[5], c = f[6] * x1 + f[7] * y1 + f[8];
    return fabs(a * x2 + b * y2 + c) / sqrt(a * a + b * b);
}

/* Columns of R2 R1' are the axes of the first camera as the second one sees them; t = R2 (C1 - C2). */
void synth_relative_pose(const synth_camera *first, const synth_camera *second, double rotation[9], double translation[3])
{
    const synth_vector t = to_camera(second, first->position);
    const double length = sqrt(dot(t, t));
    for (int k = 0; k < 3; k++) {
        const synth_vector axis = {k == 0, k == 1, k == 2}, d = to_world_direction(first, axis);
        const synth_vector at = {second->position.x + d.x, second->position.y + d.y, second->position.z + d.z};
        const synth_vector seen = to_camera(second, at);
        rotation[k] = seen.x;
        rotation[3 + k] = seen.y;
        rotation[6 + k] = seen.z;
    }
    const double over = length > 0 ? 1 / length : 0;
    translation[0] = t.x * over;
    translation[1] = t.y * over;
    translation[2] = t.z * over;
}

synth_pose_error synth_pose_off(const synth_camera *first, const synth_camera *second, const double rotation[9],
                                const double translation[3])
{
    const double degree = 3.14159265358979323846 / 180;
    double r[9], t[3], trace = 0, along = 0;
    synth_relative_pose(first, second, r, t);
    for (int k = 0; k < 9; k++)
        trace += r[k] * rotation[k];
    for (int k = 0; k < 3; k++)
        along += t[k] * translation[k];
    return (synth_pose_error){acos(fmax(-1, fmin(1, (trace - 1) / 2))) / degree, acos(fmax(-1, fmin(1, along))) / degree};
}

/* ---- the picture ---- */

/* Light falls from the window's side and fades towards the back and the floor, a few grey levels a metre. */
static double shade(const synth_surface *s, synth_vector p)
{
    return s->gray - 2.0 * (p.x - 2.5) - 3.0 * (p.z - 3.0) - 3.0 * (p.y + 1.3);
}

/* Keeps the part of the polygon where plane . q + offset >= 0, in camera coordinates; world points go along. */
static int32_t clip(const synth_vector *in, const synth_vector *in_world, int32_t count, synth_vector plane, double offset,
                    synth_vector *out, synth_vector *out_world)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        const int32_t k = (i + 1) % count;
        const double a = dot(plane, in[i]) + offset, b = dot(plane, in[k]) + offset;
        if (a >= 0.0 && kept < SYNTH_MAX_CORNERS) {
            out[kept] = in[i];
            out_world[kept++] = in_world[i];
        }
        if (((a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)) && kept < SYNTH_MAX_CORNERS) {
            const double t = a / (a - b);
            const synth_vector d = minus(in[k], in[i]), w = minus(in_world[k], in_world[i]);
            const synth_vector cut = {in[i].x + t * d.x, in[i].y + t * d.y, in[i].z + t * d.z};
            const synth_vector cut_world = {in_world[i].x + t * w.x, in_world[i].y + t * w.y, in_world[i].z + t * w.z};
            out[kept] = cut;
            out_world[kept++] = cut_world;
        }
    }
    return kept;
}

static int32_t clip_to_view(const synth_camera *c, synth_vector *q, synth_vector *world, int32_t count)
{
    const double sx = (0.5 * c->width + BEYOND) / c->focal, sy = (0.5 * c->height + BEYOND) / c->focal;
    const synth_vector planes[5] = {{0, 0, 1}, {1, 0, sx}, {-1, 0, sx}, {0, 1, sy}, {0, -1, sy}};
    for (int i = 0; i < 5 && count >= 3; i++) {
        synth_vector clipped[SYNTH_MAX_CORNERS], clipped_world[SYNTH_MAX_CORNERS];
        count = clip(q, world, count, planes[i], i == 0 ? -NEAR : 0.0, clipped, clipped_world);
        memcpy(q, clipped, sizeof clipped);
        memcpy(world, clipped_world, sizeof clipped_world);
    }
    return count;
}

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* The linear paint closest to the shade at the corners (least squares, Cramer's rule on the normal equations about the mean). */
static synth_paint fit_paint(const synth_surface *s, const synth_point *image, const synth_vector *world, int32_t count)
{
    synth_paint paint = synth_flat(0.0);
    for (int32_t i = 0; i < count; i++) {
        paint.x0 += image[i].x / count;
        paint.y0 += image[i].y / count;
    }
    double xx[3] = {0.0}, xy[3] = {0.0}, one[3] = {0.0}, right[3] = {0.0};
    for (int32_t i = 0; i < count; i++) {
        const double v[3] = {image[i].x - paint.x0, image[i].y - paint.y0, 1.0}, gray = shade(s, world[i]);
        for (int k = 0; k < 3; k++) {
            xx[k] += v[0] * v[k];
            xy[k] += v[1] * v[k];
            one[k] += v[2] * v[k];
            right[k] += gray * v[k];
        }
    }
    const double d = determinant(xx, xy, one);
    if (fabs(d) > 1e-9) { /* the matrix is symmetric: replacing a row is as good as replacing a column */
        paint.slope_x = determinant(right, xy, one) / d;
        paint.slope_y = determinant(xx, right, one) / d;
        paint.gray = determinant(xx, xy, right) / d;
    } else {
        paint.gray = right[2] / count;
    }
    return paint;
}

static void paint_surface(const synth_room *room, int32_t index, const synth_camera *camera, synth_scene *scene)
{
    const synth_surface *s = &room->surfaces[index];
    if (dot(s->normal, minus(camera->position, s->corners[0])) <= 0.0)
        return;
    synth_vector q[SYNTH_MAX_CORNERS], world[SYNTH_MAX_CORNERS];
    synth_point image[SYNTH_MAX_CORNERS];
    for (int32_t i = 0; i < s->count; i++) {
        world[i] = s->corners[i];
        q[i] = to_camera(camera, s->corners[i]);
    }
    const int32_t count = clip_to_view(camera, q, world, s->count);
    if (count < 3)
        return;
    for (int32_t i = 0; i < count; i++)
        image[i] = to_image(camera, q[i]);
    synth_scene_add(scene, image, count, fit_paint(s, image, world, count), index);
}

typedef struct order {
    double group, own;
    int32_t rank, object;
} order;

static int compare_order(const void *a, const void *b)
{
    const order *p = a, *q = b;
    if (p->group != q->group)
        return p->group > q->group ? -1 : 1;
    if (p->rank != q->rank)
        return p->rank < q->rank ? -1 : 1;
    if (p->own != q->own)
        return p->own > q->own ? -1 : 1;
    return p->object - q->object;
}

static int paint_room(const synth_room *room, const synth_camera *camera, synth_scene *scene)
{
    order *orders = malloc(((size_t)room->object_count + 1) * sizeof *orders);
    if (!orders)
        return -1;
    for (int32_t i = 0; i < room->object_count; i++) {
        const synth_object *o = &room->objects[i];
        const order item = {distance(o->group, camera->position), distance(o->middle, camera->position), o->rank, i};
        orders[i] = item;
    }
    qsort(orders, (size_t)room->object_count, sizeof *orders, compare_order);
    for (int32_t i = 0; i < room->object_count; i++)
        for (int32_t k = 0; k < room->surface_count; k++)
            if (room->surfaces[k].object == orders[i].object)
                paint_surface(room, k, camera, scene);
    free(orders);
    return scene->failed ? -1 : 0;
}

/* ---- corners ---- */

/* A junction is a point of the room when all that is seen around it goes through one point of the room, or when the nearest
 * thing seen has a corner there. Otherwise something hides something. */
static synth_corner corner_at(const synth_room *room, const synth_camera *camera, const synth_true_junction *junction)
{
    synth_corner corner = {{0.0, 0.0, 0.0}, 0, 0};
    const synth_vector q = {(junction->x - 0.5 * (camera->width - 1)) / camera->focal,
                            (junction->y - 0.5 * (camera->height - 1)) / camera->focal, 1.0};
    const synth_vector d = to_world_direction(camera, q);
    double nearest = HUGE_VAL, farthest = 0.0;
    for (int i = 0; i < 32; i++) {
        synth_vector seen;
        const double a = (i + 0.5) * 3.14159265358979323846 / 16.0;
        const int32_t surface = synth_room_trace(room, camera, junction->x + 5e-3 * cos(a), junction->y + 5e-3 * sin(a), &seen);
        if (surface < 0)
            continue;
        const synth_surface *s = &room->surfaces[surface];
        const double t = dot(s->normal, minus(s->corners[0], camera->position)) / dot(s->normal, d);
        nearest = fmin(nearest, t);
        farthest = fmax(farthest, t);
    }
    corner.point.x = camera->position.x + nearest * d.x;
    corner.point.y = camera->position.y + nearest * d.y;
    corner.point.z = camera->position.z + nearest * d.z;
    corner.is_corner = farthest - nearest < SAME_POINT;
    for (int32_t i = 0; i < room->surface_count && !corner.is_corner; i++)
        for (int32_t k = 0; k < room->surfaces[i].count; k++)
            corner.is_corner |= distance(room->surfaces[i].corners[k], corner.point) < SAME_POINT;
    return corner;
}

int synth_view_paint(const synth_room *room, const synth_camera *camera, synth_view *view)
{
    memset(view, 0, sizeof *view);
    view->camera = *camera;
    synth_scene_init(&view->scene, camera->width, camera->height, 0.0);
    const int result = paint_room(room, camera, &view->scene);
    if (result != 0)
        synth_view_free(view);
    return result;
}

int synth_view_make(const synth_room *room, const synth_camera *camera, double min_contrast, synth_view *view)
{
    int result = synth_view_paint(room, camera, view);
    if (result == 0)
        result = synth_truth_of_scene(&view->scene, min_contrast, &view->truth);
    if (result == 0 && !(view->corners = malloc(((size_t)view->truth.count + 1) * sizeof *view->corners)))
        result = -1;
    for (int32_t i = 0; result == 0 && i < view->truth.count; i++)
        view->corners[i] = corner_at(room, camera, &view->truth.junctions[i]);
    if (result != 0)
        synth_view_free(view);
    return result;
}

void synth_view_free(synth_view *view)
{
    synth_scene_free(&view->scene);
    synth_truth_free(&view->truth);
    free(view->corners);
    view->corners = NULL;
}

int32_t synth_correspondences(const synth_view *first, const synth_view *second, synth_correspondence *out, int32_t capacity)
{
    int32_t count = 0;
    for (int32_t i = 0; i < first->truth.count; i++)
        for (int32_t k = 0; k < second->truth.count; k++) {
            if (!first->corners[i].is_corner || !second->corners[k].is_corner ||
                distance(first->corners[i].point, second->corners[k].point) > 2.0 * SAME_POINT)
                continue;
            if (count < capacity) {
                out[count].first = i;
                out[count].second = k;
            }
            count++;
        }
    return count;
}
