/* SPDX-License-Identifier: BSD-2-Clause */
/* Branches that slip from one edge to the next: slats, single edges, tiles; and the conductors of a circuit board. */
#include "detect/slip.h"
#include "unit_test.h"

#include <asj/asj.h>

#define DEGREE (UNIT_PI / 180)

enum { WIDTH = 1040, HEIGHT = 300, SLATS = 8 /* px from one to the next */, TILE = 20, BOARD = 420, CONDUCTORS = 16, PITCH = 6 };

static const synth_point start = {30.2, 144.3}; /* on an edge of a slat, of the half plane and of tiles */

static int set_up_slats(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, WIDTH, HEIGHT, 100);
    for (int y = 0; y < HEIGHT; y += SLATS)
        synth_add_rectangle(&scene, (synth_point){-10, y + 0.3}, WIDTH + 20, SLATS / 2.0, 0, 140);
    return unit_set_up_scene(state, &scene, 1, 2);
}

static int set_up_edge(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, WIDTH, HEIGHT, 100);
    synth_add_rectangle(&scene, (synth_point){-10, start.y}, WIDTH + 20, HEIGHT, 0, 140);
    return unit_set_up_scene(state, &scene, 1, 2);
}

static int set_up_tiles(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, WIDTH, HEIGHT, 100);
    for (int y = -8; y < HEIGHT / TILE + 8; y++)
        for (int x = 0; x <= WIDTH / TILE; x++)
            if ((x + y) % 2 == 0)
                synth_add_rectangle(&scene, (synth_point){TILE * x - 0.4, start.y + TILE * y}, TILE, TILE, 0, 140);
    return unit_set_up_scene(state, &scene, 1, 2);
}

static int set_up_noise(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, WIDTH, HEIGHT, 100);
    return unit_set_up_scene(state, &scene, 0, 20);
}

static double length_along(const unit_fixture *f, double degrees, double length)
{
    asj_hypothesis hypothesis;
    memset(&hypothesis, 0, sizeof hypothesis);
    hypothesis.x = start.x;
    hypothesis.y = start.y;
    hypothesis.branch_count = 1;
    hypothesis.branches[0].angle = degrees < 0 ? 2 * UNIT_PI + degrees * DEGREE : degrees * DEGREE;
    hypothesis.branches[0].length = length;
    return asj_slip_length(&asj_edge_reference, &f->frame, &hypothesis, &hypothesis.branches[0]);
}

/* A slat's edge is left where the line is a few px off it, less than half of the way to the next. Along it, and of less than a
 * period, all is one edge. */
static void test_slats(void **state)
{
    static const double crosses[] = {3, -3, 4, -4, 6, -6}, follows[] = {0, 0.2, -0.2};
    for (size_t n = 0; n < UNIT_COUNT(crosses); n++) {
        const double slope = tan(fabs(crosses[n]) * DEGREE), length = length_along(*state, crosses[n], 300);
        assert_true(length > 0.5 / slope && length < 0.5 * SLATS / slope);
        unit_near("short", crosses[n], 0, length_along(*state, crosses[n], 0.6 * SLATS / slope), 0.6 * SLATS / slope, 0);
    }
    for (size_t n = 0; n < UNIT_COUNT(follows); n++)
        unit_near("length", follows[n], 0, length_along(*state, follows[n], 300), 300, 0);
}

/* Beside one edge there is none to slip to, whether the line leaves it or not. */
static void test_alone(void **state)
{
    static const double angles[] = {0, 0.5, -0.5, 1, -1, 1.5, -1.5, 2, -2};
    for (size_t n = 0; n < UNIT_COUNT(angles); n++) {
        unit_near("length", angles[n], 0, length_along(*state, angles[n], 300.25), 300.25, 0);
        unit_near("length", angles[n], 0, length_along(*state, angles[n], 1000), 1000, 0);
    }
}

/* A faint edge that something strong and thin crosses is one edge. */
static int set_up_crossed(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, WIDTH, HEIGHT, 120);
    synth_add_rectangle(&scene, (synth_point){-10, start.y}, WIDTH + 20, HEIGHT, 0, 140);
    for (int degrees = 20; degrees <= 90; degrees += 10) {
        const double x = 30 + 2.6 * 4 * degrees, turn = degrees * DEGREE;
        synth_add_rectangle(&scene, (synth_point){x - 200 * cos(turn), start.y - 200 * sin(turn)}, 400, 4, turn, 230);
    }
    return unit_set_up_scene(state, &scene, 0.8, 1);
}

static void test_crossed(void **state)
{
    unit_near("length", 0, 0, length_along(*state, 0, 1000), 1000, 0);
    for (double length = 60; length < 1000; length += 60)
        unit_near("length", length, 0, length_along(*state, 0, length), length, 0);
}

static void test_tiles(void **state)
{
    unit_near("length", 0, 0, length_along(*state, 0, 300), 300, 0);
    unit_near("length", 0.2, 0, length_along(*state, 0.2, 300), 300, 0);
}

/* Noise goes back and forth: of 80 lines through it none slips here. Short ones are left alone. */
static void test_noise(void **state)
{
    int slips = 0;
    for (int degrees = -40; degrees < 40; degrees++)
        slips += length_along(*state, degrees, 150) < 150;
    assert_true(slips <= 2);
    unit_near("length", 0, 0, length_along(*state, 0, 20), 20, 0);
    unit_near("length", 0, 0, length_along(*state, 0, 0), 0, 0);
}

/* Conductors that turn by 40 degrees side by side, as in a board. */
static void draw_conductors(synth_scene *scene)
{
    const double turn = 40 * DEGREE, half = 0.25 * PITCH, reach = 400;
    const synth_point across = {-sin(turn) * half, cos(turn) * half};
    for (int k = 0; k < CONDUCTORS; k++) {
        const double y = 60.2 + k * PITCH, x = 200.3 - k * PITCH * tan(0.5 * turn), bend = half * tan(0.5 * turn);
        const double ex = x + reach * cos(turn), ey = y + reach * sin(turn);
        const synth_point corners[6] = {{-20, y - half}, {x + bend, y - half}, {ex - across.x, ey - across.y},
                                        {ex + across.x, ey + across.y}, {x - bend, y + half}, {-20, y + half}};
        synth_scene_add(scene, corners, 6, synth_flat(150), 0);
    }
}

/* px of branches that are more than a degree off both ways of the conductors, as a part of all. */
static double wrong_part(const unit_fixture *f, const asj_image *image)
{
    asj_detection *found = NULL;
    double wrong = 0, all = 0;
    assert_int_equal(asj_detect(f->context, image, NULL, &found), ASJ_OK);
    for (uint32_t n = 0; n < found->junction_count; n++)
        for (int32_t b = 0; b < found->junctions[n].branch_count; b++) {
            const asj_branch *branch = &found->junctions[n].branches[b];
            const double twice = 2 * (double)branch->angle; /* either way along a line */
            all += (double)branch->length;
            wrong += fmin(unit_turn(twice, 0), unit_turn(twice, 80 * DEGREE)) > 2 * DEGREE ? (double)branch->length : 0;
        }
    assert_true(found->junction_count >= 12 && all > 2000);
    asj_detection_free(&found);
    return wrong / all;
}

static void test_conductors(void **state)
{
    const unit_fixture *f = *state;
    synth_scene scene;
    synth_scene_init(&scene, BOARD, HEIGHT, 90);
    draw_conductors(&scene);
    uint8_t *pixels = unit_picture(&scene, 0.6, 2, 1);
    const asj_image image = unit_gray8(pixels, BOARD, HEIGHT);
    const double wrong = wrong_part(f, &image);
    free(pixels);
    assert_true(wrong < 0.2); /* .15; where branches may slip .31 */
}

int main(void)
{
    const struct CMUnitTest slats[] = {cmocka_unit_test(test_slats), cmocka_unit_test(test_conductors)};
    const struct CMUnitTest edge[] = {cmocka_unit_test(test_alone)}, tiles[] = {cmocka_unit_test(test_tiles)};
    const struct CMUnitTest noise[] = {cmocka_unit_test(test_noise)}, crossed[] = {cmocka_unit_test(test_crossed)};
    return cmocka_run_group_tests(slats, set_up_slats, unit_tear_down) +
           cmocka_run_group_tests(edge, set_up_edge, unit_tear_down) +
           cmocka_run_group_tests(crossed, set_up_crossed, unit_tear_down) +
           cmocka_run_group_tests(tiles, set_up_tiles, unit_tear_down) +
           cmocka_run_group_tests(noise, set_up_noise, unit_tear_down);
}
