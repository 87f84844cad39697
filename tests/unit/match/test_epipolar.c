/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/epipolar.c: matches on two walls seen by a camera that moves sideways and forwards; some are off their lines. */
#include "match/epipolar.h"
#include "unit_test.h"

enum { SIDE = 8, COUNT = SIDE * SIDE };

static asj_l_junction l[2][COUNT];
static uint32_t locations[COUNT];
static uint8_t octaves[COUNT];
static int32_t home;
static size_t later; /* so many of the choices come after the test */
static asj_candidate candidates[COUNT];
static asj_choice choices[COUNT];

/* A point at depth z, 500 px of focal length, middle at (320, 240); the camera moves by (0.5, 0, 0.3). */
static void project(double x, double y, double z, double to[2])
{
    to[0] = 320 + 500 * x / z;
    to[1] = 240 + 500 * y / z;
}

static void place(int32_t k)
{
    const double x = 0.4 * (k % SIDE - 3.5), y = 0.35 * (k / SIDE - 3.5), z = k % 2 ? 4 : 6 + x;
    double p[2], q[2];
    project(x, y, z, p);
    project(x - 0.5, y, z - 0.3, q);
    l[0][k] = (asj_l_junction){.x = (float)p[0], .y = (float)p[1]};
    l[1][k] = (asj_l_junction){.x = (float)q[0], .y = (float)q[1]};
    locations[k] = (uint32_t)k;
    candidates[k] = (asj_candidate){.i = (uint32_t)k, .j = (uint32_t)k, .map = {{z / (z - 0.3), 0, 0, z / (z - 0.3)},
                                                                             {(z - 0.3) / z, 0, 0, (z - 0.3) / z}}};
    choices[k] = (asj_choice){(uint32_t)k, 2, 0};
}

/* The map of match 3 keeps no area. */
static int32_t collapse;

/* Every `each`-th match is moved by 9 px down in image 2, away from its line. Returns how many stay; *moved: of those. */
static size_t stay(int32_t count, int32_t each, int32_t neighbours, int32_t *moved)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_options options;
    asj_image_features image[2];
    asj_match_options_init(&options);
    options.verify_neighbours = neighbours;
    memset(image, 0, sizeof image);
    for (int32_t k = 0; k < COUNT; k++) {
        place(k);
        l[1][k].y += each && k % each == 0 ? 9 : 0;
    }
    if (collapse)
        candidates[3].map = (asj_linear){{1e-4, 0, 0, 1e-4}, {1e4, 0, 0, 1e4}};
    for (int32_t side = 0; side < 2; side++) {
        image[side].l_junctions.l = l[side];
        image[side].l_junctions.location = locations;
        image[side].l_junctions.octave = octaves;
        image[side].l_junctions.home = home;
        image[side].l_junctions.count = image[side].l_junctions.location_count = COUNT;
        image[side].pyramid.width[0] = 640;
        image[side].pyramid.height[0] = 480;
    }
    asj_match_run run = {.context = context, .options = &options, .image = {&image[0], &image[1]},
                         .candidates = {candidates, COUNT, COUNT}, .choices = {choices, (size_t)count - later}};
    assert_int_equal(asj_verify_epipolar(&run), ASJ_OK);
    const size_t accepted = run.choices.count;
    for (size_t n = (size_t)count - later; n < (size_t)count; n++)
        choices[run.choices.count++] = (asj_choice){(uint32_t)n, 2, 0};
    asj_drop_off_lines(&run, accepted);
    *moved = 0;
    for (size_t n = 0; n < run.choices.count; n++)
        *moved += each && (int32_t)choices[n].candidate % each == 0;
    unit_context_free(&counter, &context);
    return run.choices.count;
}

static void what_leaves_its_line_goes(void **state)
{
    int32_t moved;
    (void)state;
    assert_int_equal(stay(COUNT, 0, 16, &moved), COUNT);
    assert_int_equal(stay(COUNT, 9, 16, &moved), COUNT - 8);
    assert_int_equal(moved, 0);
}

static void what_is_known_less_may_lie_farther(void **state)
{
    int32_t moved;
    (void)state;
    octaves[9] = 2; /* of a guest, which is aligned as others are */
    assert_int_equal(stay(COUNT, 9, 16, &moved), COUNT - 8);
    home = 2; /* 16 px */
    assert_int_equal(stay(COUNT, 9, 16, &moved), COUNT);
    assert_int_equal(moved, 8);
    octaves[9] = 0;
    home = 0;
}

static void those_that_come_later_go_by_the_same_lines(void **state)
{
    int32_t moved;
    (void)state;
    later = COUNT / 2;
    assert_int_equal(stay(COUNT, 9, 16, &moved), COUNT - 8);
    assert_int_equal(moved, 0);
    later = COUNT - 19; /* so few are asked that there is no matrix */
    assert_int_equal(stay(COUNT, 9, 16, &moved), COUNT);
    later = 0;
}

/* A third of them moves together: no scene that stands still. */
static void many_are_believed(void **state)
{
    int32_t moved;
    (void)state;
    assert_int_equal(stay(COUNT, 3, 16, &moved), COUNT);
    assert_int_equal(moved, (COUNT + 2) / 3);
}

static void a_map_without_area_is_not_asked(void **state)
{
    int32_t moved;
    (void)state;
    collapse = 1;
    assert_int_equal(stay(COUNT, 9, 16, &moved), COUNT - 8);
    collapse = 0;
}

static void few_matches_say_nothing(void **state)
{
    int32_t moved;
    (void)state;
    assert_int_equal(stay(19, 9, 16, &moved), 19);
    assert_int_equal(stay(COUNT, 9, 0, &moved), COUNT); /* nobody asked for verification */
    assert_int_equal(moved, 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_leaves_its_line_goes),
        cmocka_unit_test(what_is_known_less_may_lie_farther),
        cmocka_unit_test(those_that_come_later_go_by_the_same_lines),
        cmocka_unit_test(many_are_believed),
        cmocka_unit_test(a_map_without_area_is_not_asked),
        cmocka_unit_test(few_matches_say_nothing),
    };
    return cmocka_run_group_tests_name("epipolar", tests, NULL, NULL);
}
