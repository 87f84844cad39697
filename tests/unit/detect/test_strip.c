/* SPDX-License-Identifier: BSD-2-Clause */
/* Strips: NFA over the unique pixels, and strength next to the junction, against their definitions. */
#include "detect/nfa.h"
#include "detect/gradient.h"
#include "detect/strip.h"
#include "core/context.h"
#include "unit_test.h"

typedef unit_fixture fixture;

static int set_up(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, 90, 70, 110);
    synth_add_rectangle(&scene, (synth_point){22.4, 14.2}, 41, 36, 0.35, 170);
    return unit_set_up_scene(state, &scene, 1, 5);
}

/* Every pixel of the image asked whether it is inside. */
static asj_strip naive(const fixture *f, double x, double y, double angle, double length)
{
    double omega = 0, near = 0;
    int32_t pixels = 0, near_pixels = 0;
    asj_strip out;
    memset(&out, 0, sizeof out);
    for (int32_t v = 0; v < f->frame.height; v++)
        for (int32_t u = 0; u < f->frame.width; u++) {
            const double t = (u - x) * cos(angle) + (v - y) * sin(angle), s = (v - y) * cos(angle) - (u - x) * sin(angle);
            if (!(t > 0.5 && t <= fmin(length, f->options.strip_length) && fabs(s) <= f->options.strip_half_width))
                continue;
            const double gx = unit_gx(&f->frame, u, v), gy = unit_gy(&f->frame, u, v);
            omega += unit_gamma(gx, gy, angle);
            pixels++;
            near += t <= 6 ? unit_gamma(gx, gy, angle) : 0;
            near_pixels += t <= 6;
            const double along = gx * cos(angle) + gy * sin(angle), across = gy * cos(angle) - gx * sin(angle);
            out.sums.uu += along * along;
            out.sums.un += along * across;
            out.sums.nn += across * across;
        }
    out.log_nfa = 1.5 * log((double)f->frame.width * f->frame.height);
    if (pixels == 0)
        return out;
    out.log_nfa += asj_nfa_log_sector_tail(asj_nfa_tables(), omega, pixels);
    if (near_pixels > 0)
        out.near_strength = (near - near_pixels * ASJ_GAMMA_MEAN) / (ASJ_GAMMA_SD * sqrt(near_pixels));
    return out;
}

static asj_strip test(const fixture *f, double x, double y, double angle, double length)
{
    const asj_strip_line line = {x, y, angle, length};
    return asj_strip_test(f->context, &f->frame, &f->options, &line);
}

/* Random strips, half of them reaching outside the image or standing there, of all widths and lengths. */
static void test_random(void **state)
{
    fixture *f = *state;
    synth_random random;
    synth_random_seed(&random, 12);
    for (int i = 0; i < 3000; i++) {
        const double x = synth_random_between(&random, -15, 105), y = synth_random_between(&random, -15, 85);
        const double angle = i % 3 ? synth_random_between(&random, 0, 2 * UNIT_PI) : i % 16 * UNIT_PI / 4;
        const double length = synth_random_between(&random, 0, 100);
        f->options.strip_half_width = synth_random_between(&random, 0.5, 4);
        f->options.strip_length = synth_random_between(&random, 10, 80);
        const asj_strip got = test(f, x, y, angle, length), expected = naive(f, x, y, angle, length);
        unit_near("ln NFA", x, y, got.log_nfa, expected.log_nfa, 1e-6);
        unit_near("near strength", x, y, got.near_strength, expected.near_strength, 1e-6);
        const double one = 1.0 / ASJ_GRADIENT_ONE / ASJ_GRADIENT_ONE;
        unit_near("uu", x, y, got.sums.uu * one, expected.sums.uu, 1e-6);
        unit_near("un", x, y, got.sums.un * one, expected.sums.un, 1e-6);
        unit_near("nn", x, y, got.sums.nn * one, expected.sums.nn, 1e-6);
    }
    asj_detect_options_init(&f->options);
}

/* Either of the two lengths is enough. */
static void test_passes(void **state)
{
    fixture *f = *state;
    synth_random random;
    int passed = 0;
    synth_random_seed(&random, 13);
    for (int i = 0; i < 1000; i++) {
        const double x = synth_random_between(&random, -5, 95), y = synth_random_between(&random, -5, 75);
        const double angle = synth_random_between(&random, 0, 2 * UNIT_PI), limit = synth_random_between(&random, -10, 30);
        const double shorter = synth_random_between(&random, 2, 30), length = shorter + synth_random_between(&random, 0, 30);
        const double least = fmin(naive(f, x, y, angle, length).log_nfa, naive(f, x, y, angle, shorter).log_nfa);
        const asj_strip_line line = {x, y, angle, length};
        const int passes = asj_strip_passes(f->context, &f->frame, &f->options, &line, shorter, limit);
        if (fabs(least - limit) > 1e-6)
            assert_int_equal(passes, least <= limit);
        passed += passes;
    }
    assert_in_range(passed, 100, 900);
}

/* Along the edge of the rectangle: meaningful from its start on; across it, or turned away: not. */
static void test_edge(void **state)
{
    const fixture *f = *state;
    const asj_strip along = test(f, 22.4, 14.2, 0.35, 38), flat = test(f, 5, 60, 0, 20);
    assert_true(along.log_nfa < -40);
    assert_true(along.near_strength > 3);
    assert_true(flat.log_nfa > 0);
}

/* No pixel: the number of tests. */
static void test_empty(void **state)
{
    const fixture *f = *state;
    const double tests = asj_strip_log_tests(f->frame.width, f->frame.height, f->frame.octaves);
    assert_true(test(f, 20, 20, 1, 0.4).log_nfa == tests);
    assert_true(test(f, 20, 20, 1, 0).log_nfa == tests);
    assert_true(test(f, -40, -40, 4, 30).log_nfa == tests);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_passes),
        cmocka_unit_test(test_edge),
        cmocka_unit_test(test_empty),
    };
    return cmocka_run_group_tests(tests, set_up, unit_tear_down);
}
