/* SPDX-License-Identifier: BSD-2-Clause */
/* What the images and the upsampled ones of two views match, with a geometry and without, found once; and changes of it. */
#ifndef ASJ_TESTS_UPSAMPLED_RESULTS_H
#define ASJ_TESTS_UPSAMPLED_RESULTS_H

#include "core/angle.h"
#include "core/context.h"
#include "upsampled_views.h"
#include "geometry/model.h"
#include "geometry/small_matrix.h"
#include "match/upsampled_geometry.h"
#include "match/result_changes.h"
#include "room.h"

static inline asj_camera camera_of(int32_t n)
{
    const double focal = synth_room_camera(n, WIDTH, HEIGHT).focal;
    return (asj_camera){focal, focal, 0.5 * (WIDTH - 1), 0.5 * (HEIGHT - 1)};
}

/* Of the upsampled images what lies in the left part of the first one, so that the images have matches that they have not. */
static inline asj_match_result *match_known(asj_context *context, int32_t upsampled, int32_t with_geometry,
                                            const asj_known_matches *known)
{
    const asj_detection *a = upsampled ? views[0].upsampled : views[0].plain, *b = upsampled ? views[1].upsampled : views[1].plain;
    asj_junction *left = calloc(a->junction_count, sizeof *left);
    asj_match_options options;
    asj_match_result *result = NULL;
    size_t count = 0;
    assert_non_null(left);
    for (uint32_t k = 0; k < a->junction_count; k++)
        if (!upsampled || a->junctions[k].x < 0.7 * WIDTH)
            left[count++] = a->junctions[k];
    asj_match_options_init(&options);
    options.geometry.model = with_geometry ? ASJ_GEOMETRY_ESSENTIAL : ASJ_GEOMETRY_NONE;
    for (int32_t n = 0; n < 2; n++)
        options.geometry.cameras[n] = camera_of(n);
    const asj_match_source sources[2] = {{&views[0].image, left, count}, {&views[1].image, b->junctions, b->junction_count}};
    const asj_status status = upsampled ? asj_match_look(context, sources, &options, 1, known, NULL, &result)
                                        : asj_match(context, &views[0].image, left, count, &views[1].image, b->junctions,
                                                    b->junction_count, &options, &result);
    assert_int_equal(status, ASJ_OK);
    assert_int_equal(result->geometry.status, with_geometry ? ASJ_GEOMETRY_ACCEPTED : ASJ_GEOMETRY_NOT_ASKED);
    free(left);
    return result;
}

static asj_match_result *found[2][2]; /* of the images and of the upsampled ones, without a geometry and with one */

static inline int find_all(void **state)
{
    const int failed = make_views(state);
    for (int32_t k = 0; k < 4 && !failed; k++)
        found[k / 2][k % 2] = match_known(((unit_fixture *)*state)->context, k / 2, k % 2, NULL);
    return failed;
}

static inline int free_all(void **state)
{
    for (int32_t k = 0; k < 4; k++)
        asj_match_result_free(&found[k / 2][k % 2]);
    return free_views(state);
}

static inline void *copy(asj_memory *memory, const void *list, size_t count, size_t size)
{
    void *copied = asj_allocate(memory, count, size);
    assert_non_null(copied);
    memcpy(copied, list, count * size);
    return copied;
}

/* That one, to be changed and freed, as if the context had just made it. */
static inline asj_match_result *match(asj_context *context, int32_t upsampled, int32_t with_geometry)
{
    const asj_own_result *from = (const asj_own_result *)found[upsampled][with_geometry];
    asj_memory memory = {.allocator = context->memory.allocator};
    asj_own_result *r = copy(&memory, from, 1, sizeof *r);
    r->memory = memory;
    r->matches = copy(&memory, from->matches, from->count, sizeof *r->matches);
    r->rejected = copy(&memory, from->rejected, from->shown.rejected_count, sizeof *r->rejected);
    r->l1 = copy(&memory, from->l1, from->shown.l_junction_count1, sizeof *r->l1);
    r->l2 = copy(&memory, from->l2, from->shown.l_junction_count2, sizeof *r->l2);
    for (int32_t side = 0; side < 2; side++)
        r->places[side] = copy(&memory, from->places[side], from->count, sizeof *r->places[side]);
    r->shown.matches = r->matches;
    r->shown.rejected = r->shown.rejected_count ? r->rejected : NULL;
    r->shown.l_junctions1 = r->l1;
    r->shown.l_junctions2 = r->l2;
    r->shown.origin = (uint64_t)(uintptr_t)r;
    return &r->shown;
}

/* The pose is turned about the optical axis, and its standard deviations are those of before times `sd`. */
static inline void change_pose(asj_match_result *r, double degrees, double sd)
{
    asj_geometry *g = &r->geometry;
    const double c = cos(degrees * ASJ_DEGREE), s = sin(degrees * ASJ_DEGREE);
    for (int k = 0; k < 3; k++) {
        const double x = g->rotation[k], y = g->rotation[3 + k];
        g->rotation[k] = c * x - s * y;
        g->rotation[3 + k] = s * x + c * y;
    }
    for (int k = 0; k < 36; k++)
        g->covariance[k] *= sd * sd;
}

/* Its rival has that pose, turned likewise. */
static inline void set_rival(asj_match_result *r, const asj_geometry *pose, double degrees)
{
    asj_match_result turned = {.geometry = *pose};
    change_pose(&turned, degrees, 1);
    memcpy(r->geometry.rival_rotation, turned.geometry.rotation, sizeof turned.geometry.rotation);
    memcpy(r->geometry.rival_translation, turned.geometry.translation, sizeof turned.geometry.translation);
}

static inline double sd_of_rotation(const asj_match_result *r)
{
    return sqrt(r->geometry.covariance[14]) / ASJ_DEGREE; /* about the optical axis, degrees */
}

/* All matches, by a period along their epipolar lines in image 2, so that no geometry contradicts them and none comes again. */
static inline void move_along_lines(asj_match_result *r)
{
    const double *f = r->geometry.matrix;
    asj_junction_match *list = (asj_junction_match *)(uintptr_t)r->matches;
    for (uint32_t k = 0; k < r->match_count; k++) {
        const double x = (double)list[k].x1, y = (double)list[k].y1;
        const double a = f[0] * x + f[1] * y + f[2], b = f[3] * x + f[4] * y + f[5], length = hypot(a, b);
        list[k].x2 += (float)(25 * b / length);
        list[k].y2 -= (float)(25 * a / length);
    }
}

/* Its geometry is none that is accepted. */
static inline void leave_open(asj_match_result *r, int32_t status)
{
    r->geometry.status = status;
    r->geometry.has_pose = 0;
    ((asj_own_result *)r)->is_known = 0;
}

#endif
