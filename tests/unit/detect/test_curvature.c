/* SPDX-License-Identifier: BSD-2-Clause */
/* Arcs that look like corners: rims of discs, and polygons beside them. */
#include "detect/curvature.h"
#include "unit_test.h"

#include <asj/asj.h>

#define DEGREE (UNIT_PI / 180)

enum { SIZE = 300, ROWS = 3, FINE = 48 /* sides of what is a disc */ };

static const double centre[2] = {80.3, 90.6}; /* of the shape alone */

/* A regular polygon whose sides touch a circle. */
static void add_polygon(synth_scene *scene, const double c[2], double radius, int sides, double turn, double gray)
{
    synth_point corners[FINE];
    for (int i = 0; i < sides; i++) {
        const double angle = turn + 2 * UNIT_PI * i / sides, reach = radius / cos(UNIT_PI / sides);
        corners[i] = (synth_point){c[0] + reach * cos(angle), c[1] + reach * sin(angle)};
    }
    synth_scene_add(scene, corners, sides, synth_flat(gray), 0);
}

/* How many junctions ROWS x ROWS polygons have that turn by sixteenths of a corner. */
static int32_t count_on(const unit_fixture *f, double radius, int sides, double blur)
{
    const int32_t size = (int32_t)(ROWS * (3 * radius + 20));
    const double pitch = (double)size / ROWS;
    asj_detection *found = NULL;
    synth_scene scene;
    synth_scene_init(&scene, size, size, 70);
    for (int i = 0; i < ROWS * ROWS; i++) {
        const double c[2] = {pitch * (i % ROWS + 0.5) + 0.13 * i, pitch * (i / ROWS + 0.5) - 0.17 * i};
        add_polygon(&scene, c, radius, sides, 2 * UNIT_PI / sides * i / 16, 170);
    }
    uint8_t *pixels = unit_picture(&scene, blur, 2, 1);
    const asj_image image = unit_gray8(pixels, size, size);
    assert_int_equal(asj_detect(f->context, &image, &f->options, &found), ASJ_OK);
    const int32_t count = (int32_t)found->junction_count;
    asj_detection_free(&found);
    free(pixels);
    return count;
}

/* Nine discs each; without asj_is_arc() they have 710 junctions. */
static void test_discs(void **state)
{
    static const struct {
        double radius, blur;
    } kinds[] = {{10, 0.7}, {12, 0.7}, {16, 0.7}, {24, 0.7}, {32, 0.7}, {40, 0.7}, {50, 0.7}, {40, 2}};
    int32_t all = 0;
    for (size_t n = 0; n < UNIT_COUNT(kinds); n++)
        all += count_on(*state, kinds[n].radius, FINE, kinds[n].blur);
    assert_true(all <= 5);
}

/* Corners of straight edges stay, few px from the next one, blurred or not. */
static void test_polygons(void **state)
{
    static const struct {
        int sides;
        double radius, blur;
    } kinds[] = {{3, 10, 0.7}, {4, 10, 0.7}, {5, 14, 0.7}, {6, 16, 0.7}, {8, 21, 0.7}, {6, 8.5, 0.9},
                 {4, 20, 2}, {6, 28, 2}, {8, 36, 2}, {4, 40, 4}};
    for (size_t n = 0; n < UNIT_COUNT(kinds); n++)
        unit_near("corners", kinds[n].sides, kinds[n].radius, count_on(*state, kinds[n].radius, kinds[n].sides, kinds[n].blur),
                  ROWS * ROWS * kinds[n].sides, 0);
}

/* The planes of one disc, of radius 24. */
static int set_up_disc(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, SIZE, SIZE, 70);
    add_polygon(&scene, centre, 24, FINE, 0, 170);
    return unit_set_up_scene(state, &scene, 0.7, 2);
}

static int set_up_square(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, SIZE, SIZE, 70);
    add_polygon(&scene, centre, 24, 4, 0, 170);
    return unit_set_up_scene(state, &scene, 0.7, 2);
}

/* Two branches at `reach` px from the centre, turned back by `half` on both sides of the way there, and one onward. */
static asj_hypothesis junction_at(double direction, double reach, double half, double length)
{
    asj_hypothesis h;
    memset(&h, 0, sizeof h);
    h.x = centre[0] + reach * cos(direction);
    h.y = centre[1] + reach * sin(direction);
    h.branch_count = 3;
    for (int i = 0; i < 3; i++) {
        const double angle = direction + (i == 0 ? UNIT_PI - half : i == 1 ? UNIT_PI + half : 0);
        h.branches[i].angle = fmod(angle + 4 * UNIT_PI, 2 * UNIT_PI);
        h.branches[i].length = length;
    }
    return h;
}

/* The tangents of an arc are one; with an edge that meets it they are a junction. With less than two branches nothing is an arc. */
static void test_tangents(void **state)
{
    const unit_fixture *f = *state;
    const double half = 65 * DEGREE, reach = 24 / sin(half);
    for (int i = 0; i < 12; i++) {
        asj_hypothesis h = junction_at(0.4 + i * 30 * DEGREE, reach, half, 20);
        assert_false(asj_is_arc(&f->frame, &h, 25 * DEGREE));
        h.branch_count = 2;
        assert_true(asj_is_arc(&f->frame, &h, 25 * DEGREE));
        const asj_hypothesis_branch first = h.branches[0];
        h.branches[0] = h.branches[1];
        h.branches[1] = first;
        assert_true(asj_is_arc(&f->frame, &h, 25 * DEGREE));
        h.branch_count = 1;
        assert_false(asj_is_arc(&f->frame, &h, 25 * DEGREE));
        h.branch_count = 0;
        assert_false(asj_is_arc(&f->frame, &h, 25 * DEGREE));
    }
}

/* Where no two branches open nothing is seen of an arc: side by side, back to back, or where more is asked than they open. */
static void test_no_opening(void **state)
{
    const unit_fixture *f = *state;
    static const double halves[] = {0, 5, 12, 80, 88, 90};
    for (size_t n = 0; n < UNIT_COUNT(halves); n++) {
        asj_hypothesis h = junction_at(0.4, 24, halves[n] * DEGREE, 20);
        h.branch_count = 2;
        assert_false(asj_is_arc(&f->frame, &h, 25 * DEGREE));
    }
    asj_hypothesis h = junction_at(0.4, 24 / sin(65 * DEGREE), 65 * DEGREE, 20);
    h.branch_count = 2;
    assert_true(asj_is_arc(&f->frame, &h, 45 * DEGREE));
    assert_false(asj_is_arc(&f->frame, &h, 55 * DEGREE));
}

/* Nor what is too short to tell, where there is no edge, or beyond the image. */
static void test_nothing(void **state)
{
    const unit_fixture *f = *state;
    static const double lengths[] = {0, 1, 2, 3};
    for (size_t n = 0; n < UNIT_COUNT(lengths); n++) {
        asj_hypothesis h = junction_at(0.4, 24 / sin(65 * DEGREE), 65 * DEGREE, lengths[n]);
        h.branch_count = 2;
        assert_false(asj_is_arc(&f->frame, &h, 25 * DEGREE));
    }
    asj_hypothesis far = junction_at(0.4, 120, 65 * DEGREE, 40), beyond = junction_at(3, 150, 65 * DEGREE, 30);
    far.branch_count = beyond.branch_count = 2;
    assert_false(asj_is_arc(&f->frame, &far, 25 * DEGREE));
    assert_false(asj_is_arc(&f->frame, &beyond, 25 * DEGREE));
}

static void test_corner(void **state)
{
    const unit_fixture *f = *state;
    for (int i = 0; i < 4; i++) {
        asj_hypothesis h = junction_at(i * 90 * DEGREE, 24 * sqrt(2), 45 * DEGREE, 40);
        h.branch_count = 2;
        assert_false(asj_is_arc(&f->frame, &h, 25 * DEGREE));
    }
}

int main(void)
{
    const struct CMUnitTest whole[] = {cmocka_unit_test(test_discs), cmocka_unit_test(test_polygons)};
    const struct CMUnitTest disc[] = {cmocka_unit_test(test_tangents), cmocka_unit_test(test_no_opening),
                                      cmocka_unit_test(test_nothing)};
    const struct CMUnitTest square[] = {cmocka_unit_test(test_corner)};
    return cmocka_run_group_tests(whole, unit_set_up, unit_tear_down) +
           cmocka_run_group_tests(disc, set_up_disc, unit_tear_down) +
           cmocka_run_group_tests(square, set_up_square, unit_tear_down);
}
