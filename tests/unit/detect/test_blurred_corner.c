/* SPDX-License-Identifier: BSD-2-Clause */
/* Corners of soft edges: found where they are though all that is seen of them is bent, and left alone where they are none. */
#include "detect/blurred_corner.h"
#include "render.h"
#include "scenes.h"
#include "unit_test.h"

#include <math.h>
#include <string.h>

#define SIZE 80

/* A parallelogram with a corner at (30.3, 28.6), sides of `side` px along 0.2 and along 0.2 + opening. */
static void draw(double side, double opening, synth_scene *scene)
{
    const synth_point c = {30.3, 28.6};
    const double a[2] = {side * cos(0.2), side * sin(0.2)}, b[2] = {side * cos(0.2 + opening), side * sin(0.2 + opening)};
    const synth_point corners[4] = {c, {c.x + a[0], c.y + a[1]}, {c.x + a[0] + b[0], c.y + a[1] + b[1]}, {c.x + b[0], c.y + b[1]}};
    synth_scene_init(scene, SIZE, SIZE, 100);
    synth_scene_add(scene, corners, 4, synth_flat(160), 0);
}

/* What line fits may have said of it: a pixel and several degrees off. */
static asj_hypothesis start_of(double side, double opening, double blur)
{
    asj_hypothesis h;
    memset(&h, 0, sizeof h);
    h.x = 31.1;
    h.y = 28.0;
    h.branch_count = 2;
    for (int i = 0; i < 2; i++) {
        h.branches[i].angle = 0.2 + (i ? opening + 0.1 : -0.08);
        h.branches[i].length = side;
        h.branches[i].width = 1.1 * blur;
    }
    return h;
}

/* The scene is freed. */
static int find(synth_scene *scene, double blur, double noise, asj_hypothesis *h)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    asj_frame frame;
    memset(&frame, 0, sizeof frame);
    unit_frame_of(context, scene, blur, noise, NULL, &frame);
    frame.octave = 1; /* as in a coarse one */
    const int found = asj_blurred_corner(context, &frame, h);
    asj_frame_free(&context->memory, &frame);
    unit_context_free(&counter, &context);
    return found;
}

/* Sides of seven blurs, whose every part is bent by one end or the other; and lengths that go on beyond somewhat longer ones. */
static void test_found(void **state)
{
    static const double openings[] = {60, 90, 120}, sides[] = {14, 20}, lengths[] = {14, 40};
    (void)state;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            const double opening = openings[i] * UNIT_PI / 180;
            synth_scene scene;
            draw(sides[k], opening, &scene);
            asj_hypothesis h = start_of(lengths[k], opening, 2);
            assert_int_equal(find(&scene, 2, 0.5, &h), 1);
            assert_true(asj_blurred_corner_is_sure(&h));
            unit_near("place", openings[i], lengths[k], hypot(h.x - 30.3, h.y - 28.6), 0, 0.12 * 2);
            unit_near("first angle", openings[i], lengths[k], h.branches[0].angle, 0.2, 0.06);
            unit_near("second angle", openings[i], lengths[k], h.branches[1].angle, 0.2 + opening, 0.06);
            assert_true(h.location_variance > 0 && h.location_variance < 0.04);
        }
}

/* Errors are about as large as they are told to be: over draws of noise the mean square of the angles' errors, and of the
 * location's along either axis, is half of the variance told. (Differences share pixels, which the variance leaves out.) */
static void test_errors_are_as_told(void **state)
{
    enum { DRAWS = 120 };
    double square[2] = {0, 0}, told[2] = {0, 0};
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (uint64_t seed = 1; seed <= DRAWS; seed++) {
        const double opening = 1.5;
        synth_scene scene;
        asj_frame frame;
        draw(30, opening, &scene);
        const int32_t width = scene.width, height = scene.height;
        uint8_t *pixels = unit_picture(&scene, 2, 2, seed);
        const asj_image image = unit_gray8(pixels, width, height);
        memset(&frame, 0, sizeof frame);
        unit_frame(context, &image, NULL, &frame);
        frame.octave = 1;
        asj_hypothesis h = start_of(30, opening, 2);
        assert_int_equal(asj_blurred_corner(context, &frame, &h), 1);
        square[0] += (pow(h.x - 30.3, 2) + pow(h.y - 28.6, 2)) / 2;
        told[0] += h.location_variance;
        for (int i = 0; i < 2; i++) {
            square[1] += pow(h.branches[i].angle - 0.2 - i * opening, 2) / 2;
            told[1] += h.branches[i].angle_variance / 2;
        }
        asj_frame_free(&context->memory, &frame);
        free(pixels);
    }
    unit_context_free(&counter, &context);
    print_message("mean square over variance told: location %.2f, angles %.2f\n", square[0] / told[0], square[1] / told[1]);
    for (int k = 0; k < 2; k++)
        assert_true(square[k] > 0.4 * told[k] && square[k] < told[k]);
}

/* It does not matter which branch comes first. */
static void test_order(void **state)
{
    synth_scene scene;
    (void)state;
    draw(30, 1.5, &scene);
    asj_hypothesis h = start_of(30, 1.5, 2), turned = h;
    turned.branches[0] = h.branches[1];
    turned.branches[1] = h.branches[0];
    assert_int_equal(find(&scene, 2, 1, &h), 1);
    draw(30, 1.5, &scene);
    assert_int_equal(find(&scene, 2, 1, &turned), 1);
    assert_true(h.x == turned.x && h.y == turned.y && h.branches[0].angle == turned.branches[1].angle);
}

/* Sharp corners, junctions of more than two branches, thin lines, edges of unlike widths, and what is no corner. */
static void test_left_alone(void **state)
{
    (void)state;
    for (int kind = 0; kind < 5; kind++) {
        synth_scene scene;
        draw(30, 1.5, &scene);
        asj_hypothesis h = start_of(30, 1.5, kind == 0 ? 0.9 : 2);
        h.branch_count = kind == 1 ? 3 : 2;
        h.branches[0].apart = kind == 2 ? 3 : 0;
        h.branches[0].width = kind == 3 ? 1.2 : h.branches[0].width;
        h.x += kind == 4 ? 12 : 0; /* on the first edge */
        const asj_hypothesis before = h;
        assert_int_equal(find(&scene, kind == 0 ? 0.9 : 2, 1, &h), 0);
        assert_memory_equal(&h, &before, sizeof h);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_found),
        cmocka_unit_test(test_errors_are_as_told),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
