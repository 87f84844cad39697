/* SPDX-License-Identifier: BSD-2-Clause */
/* The room: hidden surfaces, corners and the map between views, each against rays. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "random.h"
#include "render.h"
#include "room.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define VIEWS 6
#define WIDTH 1052
#define HEIGHT 780

typedef struct fixture {
    synth_room room;
    synth_view views[VIEWS];
} fixture;

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g is not within %g of %.12g", value, tolerance, expected);
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    if (!f || synth_room_make(&f->room) != 0)
        return -1;
    for (int32_t i = 0; i < VIEWS; i++) {
        const synth_camera camera = synth_room_camera(i, WIDTH, HEIGHT);
        if (synth_view_make(&f->room, &camera, 3.0, &f->views[i]) != 0)
            return -1;
    }
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    for (int i = 0; i < VIEWS; i++)
        synth_view_free(&f->views[i]);
    synth_room_free(&f->room);
    free(f);
    return 0;
}

/* Project and look back: the ray through the image of a point meets that point or something nearer. */
static void projection_and_rays_agree(void **state)
{
    fixture *f = *state;
    for (int v = 0; v < VIEWS; v++)
        for (int32_t i = 0; i < f->room.surface_count; i++) {
            synth_point image;
            synth_vector met;
            const synth_vector p = f->room.surfaces[i].corners[0];
            if (!synth_camera_project(&f->views[v].camera, p, &image))
                continue;
            synth_point again;
            assert_true(synth_room_trace(&f->room, &f->views[v].camera, image.x, image.y, &met) >= 0);
            assert_int_equal(synth_camera_project(&f->views[v].camera, met, &again), 1);
            assert_near(again.x, image.x, 1e-6);
            assert_near(again.y, image.y, 1e-6);
        }
}

/* The painter's order is right: what the picture shows is what the ray meets first. */
static void nothing_hidden_is_painted(void **state)
{
    fixture *f = *state;
    synth_random random;
    synth_random_seed(&random, 1);
    for (int v = 0; v < VIEWS; v++)
        for (int i = 0; i < 4000; i++) {
            synth_vector met;
            const double x = synth_random_between(&random, 0.0, WIDTH - 1.0), y = synth_random_between(&random, 0.0, HEIGHT - 1.0);
            const int32_t top = synth_scene_top(&f->views[v].scene, x, y);
            assert_true(top >= 0);
            assert_int_equal(f->views[v].scene.polygons[top].tag, synth_room_trace(&f->room, &f->views[v].camera, x, y, &met));
        }
}

/* Random rooms: the same, from two viewpoints each; every seed is another room, and the same one again. */
static void random_rooms_are_painted_right(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 2);
    for (uint64_t seed = 0; seed < 16; seed++) {
        synth_room room, again;
        assert_int_equal(synth_room_random(&room, seed), 0);
        assert_int_equal(synth_room_random(&again, seed), 0);
        assert_int_equal(room.surface_count, again.surface_count);
        assert_memory_equal(room.surfaces, again.surfaces, (size_t)room.surface_count * sizeof *room.surfaces);
        synth_room_free(&again);
        for (int32_t v = 0; v < 2; v++) {
            synth_view view;
            const synth_camera camera = synth_room_random_camera(seed, v, WIDTH, HEIGHT);
            assert_int_equal(synth_view_make(&room, &camera, 3.0, &view), 0);
            for (int i = 0; i < 1000; i++) {
                synth_vector met;
                const double x = synth_random_between(&random, 0.0, WIDTH - 1.0);
                const double y = synth_random_between(&random, 0.0, HEIGHT - 1.0);
                const int32_t top = synth_scene_top(&view.scene, x, y);
                assert_true(top >= 0);
                assert_int_equal(view.scene.polygons[top].tag, synth_room_trace(&room, &camera, x, y, &met));
            }
            synth_view_free(&view);
        }
        synth_room_free(&room);
    }
}

static void corners_lie_where_they_project(void **state)
{
    fixture *f = *state;
    for (int v = 0; v < VIEWS; v++) {
        const synth_view *view = &f->views[v];
        int32_t corners = 0, hidings = 0;
        for (int32_t i = 0; i < view->truth.count; i++) {
            if (!view->corners[i].is_corner) {
                hidings++;
                continue;
            }
            synth_point image;
            corners++;
            assert_int_equal(synth_camera_project(&view->camera, view->corners[i].point, &image), 1);
            assert_near(image.x, view->truth.junctions[i].x, 1e-6);
            assert_near(image.y, view->truth.junctions[i].y, 1e-6);
            assert_true(synth_room_visible(&f->room, &view->camera, view->corners[i].point));
        }
        assert_true(corners > 120);
        assert_true(hidings > 20);
    }
}

/* Every correspondence is one point of the room, and moves as far as parallax has it: not all by the same amount. */
static void correspondences_are_points_of_the_room(void **state)
{
    fixture *f = *state;
    static synth_correspondence pairs[1000];
    for (int v = 1; v < VIEWS; v++) {
        const synth_view *a = &f->views[0], *b = &f->views[v];
        const int32_t count = synth_correspondences(a, b, pairs, 1000);
        double low = HUGE_VAL, high = -HUGE_VAL;
        assert_in_range(count, 80, 1000);
        for (int32_t i = 0; i < count; i++) {
            const synth_true_junction *p = &a->truth.junctions[pairs[i].first], *q = &b->truth.junctions[pairs[i].second];
            synth_point image;
            assert_int_equal(synth_camera_project(&b->camera, a->corners[pairs[i].first].point, &image), 1);
            assert_near(image.x, q->x, 2e-2);
            assert_near(image.y, q->y, 2e-2);
            low = fmin(low, q->x - p->x);
            high = fmax(high, q->x - p->x);
            for (int32_t k = 0; k < i; k++)
                assert_true(pairs[k].first != pairs[i].first && pairs[k].second != pairs[i].second);
        }
        assert_true(high - low > 20.0);
        double f9[9];
        synth_fundamental(&a->camera, &b->camera, f9);
        for (int32_t i = 0; i < count; i++) {
            const synth_true_junction *p = &a->truth.junctions[pairs[i].first], *q = &b->truth.junctions[pairs[i].second];
            const double l[3] = {f9[0] * p->x + f9[1] * p->y + f9[2], f9[3] * p->x + f9[4] * p->y + f9[5],
                                 f9[6] * p->x + f9[7] * p->y + f9[8]};
            assert_near((l[0] * q->x + l[1] * q->y + l[2]) / hypot(l[0], l[1]), 0.0, 2e-2);
        }
    }
    assert_int_equal(synth_correspondences(&f->views[0], &f->views[1], pairs, 0),
                     synth_correspondences(&f->views[0], &f->views[1], pairs, 1000));
}

/* There and back again ends where it began, on the same surface, which has the same grey but for the linear fit of its shade. */
static void transfer_is_its_own_inverse(void **state)
{
    fixture *f = *state;
    synth_random random;
    synth_random_seed(&random, 5);
    int seen = 0, hidden = 0;
    for (int i = 0; i < 4000; i++) {
        synth_point there, back;
        const synth_view *a = &f->views[0], *b = &f->views[1];
        const double x = synth_random_between(&random, 0.0, WIDTH - 1.0), y = synth_random_between(&random, 0.0, HEIGHT - 1.0);
        if (!synth_room_transfer(&f->room, &a->camera, x, y, &b->camera, &there)) {
            hidden++;
            continue;
        }
        seen++;
        assert_int_equal(synth_room_transfer(&f->room, &b->camera, there.x, there.y, &a->camera, &back), 1);
        assert_near(back.x, x, 1e-6);
        assert_near(back.y, y, 1e-6);
        assert_near(synth_scene_gray(&b->scene, there.x, there.y), synth_scene_gray(&a->scene, x, y), 6.0);
    }
    assert_true(seen > 2500);
    assert_true(hidden > 200);
}

static void the_sample_picture_is_known(void **state)
{
    fixture *f = *state;
    uint8_t *pixels = synth_photograph(&f->views[0].scene, 0.9, 2.0, 1);
    assert_non_null(pixels);
    const uint64_t checksum = synth_checksum(pixels, (size_t)WIDTH * HEIGHT);
    free(pixels);
    assert_true(checksum == UINT64_C(0xee8333fd39534752));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(projection_and_rays_agree),
        cmocka_unit_test(nothing_hidden_is_painted),
        cmocka_unit_test(random_rooms_are_painted_right),
        cmocka_unit_test(corners_lie_where_they_project),
        cmocka_unit_test(correspondences_are_points_of_the_room),
        cmocka_unit_test(transfer_is_its_own_inverse),
        cmocka_unit_test(the_sample_picture_is_known),
    };
    return cmocka_run_group_tests_name("room", tests, set_up, tear_down);
}
