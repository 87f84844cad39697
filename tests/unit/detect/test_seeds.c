/* SPDX-License-Identifier: BSD-2-Clause */
/* Candidates from line segments: pairs whose places are known, and pictures. */
#include "detect/detect_options.h"
#include "detect/seeds.h"
#include "unit_test.h"

static asj_line_segment segment(double x1, double y1, double x2, double y2)
{
    return (asj_line_segment){x1, y1, x2, y2, 2, -10};
}

/* Two segments that end `apart` before the corner of an angle: their lines meet in the corner. */
static void test_meet(void **state)
{
    (void)state;
    for (int n = 0; n < 72; n++)
        for (int degrees = 10; degrees < 180; degrees += 20) {
            const double turn = n * UNIT_PI / 36, opening = degrees * UNIT_PI / 180, apart = 5;
            const double ax = cos(turn), ay = sin(turn), bx = cos(turn + opening), by = sin(turn + opening);
            const asj_line_segment a = segment(20 + apart * ax, 30 + apart * ay, 20 + 40 * ax, 30 + 40 * ay);
            const asj_line_segment b = segment(20 + 60 * bx, 30 + 60 * by, 20 + apart * bx, 30 + apart * by);
            double x = 0, y = 0;
            const int opens = degrees > 20 && degrees < 160;
            assert_int_equal(asj_seeds_meet(&a, &b, apart + 0.01, &x, &y), opens);
            assert_int_equal(asj_seeds_meet(&b, &a, apart + 0.01, &x, &y), opens);
            assert_int_equal(asj_seeds_meet(&a, &b, apart - 0.01, &x, &y), 0);
            if (opens) {
                unit_near("x", n, degrees, x, 20, 1e-9);
                unit_near("y", n, degrees, y, 30, 1e-9);
            }
        }
    const asj_line_segment point = segment(3, 3, 3, 3), line = segment(0, 0, 10, 0);
    double x, y;
    assert_int_equal(asj_seeds_meet(&point, &line, 50, &x, &y), 0);
}

static void test_ends_at(void **state)
{
    (void)state;
    const asj_line_segment along = segment(10, 20, 50, 20), across = segment(30, 24, 30, 60), beside = segment(10, 22, 50, 23);
    assert_true(asj_seeds_ends_at(&across, 30, 24, &along, 4));
    assert_false(asj_seeds_ends_at(&across, 30, 24, &along, 3.9));
    assert_true(asj_seeds_ends_at(&across, 53, 24, &along, 5)); /* 3 px beyond its end, 4 px beside it */
    assert_false(asj_seeds_ends_at(&across, 53, 24, &along, 4.9));
    assert_false(asj_seeds_ends_at(&beside, 10, 22, &along, 40)); /* nearly parallel */
}

enum { WIDTH = 110, HEIGHT = 97 };

/* How many candidates a picture has, and how many of them lie within `near` px of one of the places. */
static void count(synth_scene *scene, double noise, const synth_point *places, int place_count, double near, int *all, int *inside)
{
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_detect_options options;
    asj_frame frame;
    assert_int_equal(asj_detect_options_preset(&options, ASJ_PRESET_PAPER), ASJ_OK);
    unit_frame_of(context, scene, 1, noise, &options, &frame);
    uint16_t *masks = malloc((size_t)frame.blocks * HEIGHT * sizeof *masks);
    assert_non_null(masks);
    assert_int_equal(asj_seeds_mark(context, &frame, &options, masks), ASJ_OK);
    *all = *inside = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < ASJ_LANES * frame.blocks; x++) {
            if (!(masks[y * frame.blocks + x / ASJ_LANES] >> x % ASJ_LANES & 1))
                continue;
            assert_true(x < WIDTH);
            ++*all;
            for (int i = 0; i < place_count; i++)
                if (hypot(x - places[i].x, y - places[i].y) <= near) {
                    ++*inside;
                    break;
                }
        }
    free(masks);
    asj_frame_free(&context->memory, &frame);
    unit_context_free(&counter, &context);
}

/* Seeds are at the corners of a rectangle, and only there. */
static void test_rectangle(void **state)
{
    const synth_point corners[4] = {{29.5, 19.5}, {79.5, 19.5}, {79.5, 64.5}, {29.5, 64.5}};
    synth_scene scene;
    int all, inside;
    (void)state;
    synth_scene_init(&scene, WIDTH, HEIGHT, 150);
    synth_add_rectangle(&scene, corners[0], 50, 45, 0, 60);
    count(&scene, 2, corners, 4, 9, &all, &inside);
    assert_in_range(all, 4 * 29, 4 * 120); /* a disc of radius 3 has 29 pixels */
    assert_int_equal(inside, all);
    for (int i = 0; i < 4; i++) {
        synth_scene_init(&scene, WIDTH, HEIGHT, 150);
        synth_add_rectangle(&scene, corners[0], 50, 45, 0, 60);
        count(&scene, 2, &corners[i], 1, 2, &all, &inside);
        assert_in_range(inside, 9, 13); /* all that is so near the corner */
    }
}

/* One straight edge has none. */
static void test_edge(void **state)
{
    (void)state;
    for (int n = 0; n < 8; n++) {
        synth_scene scene;
        int all, inside;
        synth_scene_init(&scene, WIDTH, HEIGHT, 150);
        const double c = 300 * cos(n * 0.4), s = 300 * sin(n * 0.4);
        const synth_point half[4] = {{55 - c, 48 - s}, {55 + c, 48 + s}, {55 + c - s, 48 + s + c}, {55 - c - s, 48 - s + c}};
        synth_scene_add(&scene, half, 4, synth_flat(70), 0);
        count(&scene, 1, NULL, 0, 0, &all, &inside);
        assert_int_equal(all, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_meet),
        cmocka_unit_test(test_ends_at),
        cmocka_unit_test(test_rectangle),
        cmocka_unit_test(test_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
