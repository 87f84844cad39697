/* SPDX-License-Identifier: BSD-2-Clause */
/* Branches that cross edges: slats, an edge every 6 px, whose edges run along x. */
#include "detect/tilt.h"
#include "core/context.h"
#include "unit_test.h"

#define DEGREE (UNIT_PI / 180)

enum { SIZE = 120, PERIOD = 12, LENGTH = 60 };

typedef unit_fixture fixture;

static int set_up_contrast(void **state, double contrast, double noise)
{
    synth_scene scene;
    synth_scene_init(&scene, SIZE, SIZE, 100);
    for (int y = 0; y < SIZE; y += PERIOD)
        synth_add_rectangle(&scene, (synth_point){-10, y + 0.3}, SIZE + 20, PERIOD / 2.0, 0, 100 + contrast);
    return unit_set_up_scene(state, &scene, 1, noise);
}

static int set_up(void **state)
{
    return set_up_contrast(state, 60, 2);
}

static int set_up_weak(void **state)
{
    return set_up_contrast(state, 4, 6);
}

static asj_hypothesis with_branch(double degrees)
{
    asj_hypothesis hypothesis;
    memset(&hypothesis, 0, sizeof hypothesis);
    hypothesis.x = hypothesis.x0 = 30.2;
    hypothesis.y = hypothesis.y0 = 60.2; /* an edge of a slat */
    hypothesis.branch_count = 1;
    hypothesis.branches[0].angle = degrees < 0 ? 2 * UNIT_PI + degrees * DEGREE : degrees * DEGREE;
    hypothesis.branches[0].length = LENGTH;
    return hypothesis;
}

static int is_tilted(const fixture *f, double degrees)
{
    const asj_hypothesis hypothesis = with_branch(degrees);
    const asj_strip_line line = {hypothesis.x, hypothesis.y, hypothesis.branches[0].angle, LENGTH};
    const asj_strip strip = asj_strip_test(f->context, &f->frame, &f->options, &line);
    return asj_is_tilted(&f->options, &strip.sums);
}

/* A branch along a slat is none that crosses them, a degree off neither; at 8 to 20 degrees it is, to either side. */
static void test_tilted(void **state)
{
    const fixture *f = *state;
    static const double follows[] = {0, 1, -1, 2, -2}, crosses[] = {8, -8, 12, -12, 20, -20};
    for (size_t n = 0; n < UNIT_COUNT(follows); n++)
        assert_false(is_tilted(f, follows[n]));
    for (size_t n = 0; n < UNIT_COUNT(crosses); n++)
        assert_true(is_tilted(f, crosses[n]));
}

/* In noise stronger than the edges, and where nothing is, no angle is told. */
static void test_weak(void **state)
{
    const fixture *f = *state;
    int steep = 0;
    for (int degrees = -4; degrees <= 4; degrees++) {
        const asj_hypothesis hypothesis = with_branch(degrees);
        const asj_strip_line line = {hypothesis.x, hypothesis.y, hypothesis.branches[0].angle, LENGTH};
        const asj_strip_sums sums = asj_strip_test(f->context, &f->frame, &f->options, &line).sums;
        steep += fabs(sums.un) > sums.nn * tan(f->options.max_tilt * DEGREE);
        assert_false(asj_is_tilted(&f->options, &sums));
    }
    assert_true(steep > 0); /* it is the correlation that tells */
    const asj_strip_sums none = {0, 0, 0, 0, 0, 0, 0};
    assert_false(asj_is_tilted(&f->options, &none));
}

static void test_option(void **state)
{
    fixture *f = *state;
    f->options.max_tilt = 15;
    assert_false(is_tilted(f, 12));
    assert_true(is_tilted(f, 20));
    f->options.max_tilt = 0;
    assert_false(is_tilted(f, 20));
    asj_hypothesis hypothesis = with_branch(10);
    const asj_hypothesis before = hypothesis;
    asj_turn_to_edge(f->context, &f->frame, &f->options, &hypothesis, 5, 40, &hypothesis.branches[0]);
    assert_memory_equal(&hypothesis, &before, sizeof before);
    asj_detect_options_init(&f->options);
}

/* Turned to the slat that starts at the junction; what follows one stays as it is. */
static void test_turned(void **state)
{
    const fixture *f = *state;
    static const double angles[] = {8, -8, 12, -12};
    for (size_t n = 0; n < UNIT_COUNT(angles); n++) {
        asj_hypothesis hypothesis = with_branch(angles[n]);
        asj_turn_to_edge(f->context, &f->frame, &f->options, &hypothesis, 5, 40, &hypothesis.branches[0]);
        unit_near("angle", angles[n], 0, unit_turn(hypothesis.branches[0].angle, 0), 0, 1 * DEGREE);
    }
    asj_hypothesis hypothesis = with_branch(0.5);
    const asj_hypothesis before = hypothesis;
    asj_turn_to_edge(f->context, &f->frame, &f->options, &hypothesis, 5, 40, &hypothesis.branches[0]);
    assert_memory_equal(&hypothesis, &before, sizeof before);
}

int main(void)
{
    const struct CMUnitTest slats[] = {cmocka_unit_test(test_tilted), cmocka_unit_test(test_option), cmocka_unit_test(test_turned)};
    const struct CMUnitTest weak[] = {cmocka_unit_test(test_weak)};
    return cmocka_run_group_tests(slats, set_up, unit_tear_down) + cmocka_run_group_tests(weak, set_up_weak, unit_tear_down);
}
