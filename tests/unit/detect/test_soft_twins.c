/* SPDX-License-Identifier: BSD-2-Clause */
/* Soft corners that are found twice: a weak one beside a sure one, and what makes it none. */
#include "detect/soft_twins.h"
#include "unit_test.h"

#define DEGREE (UNIT_PI / 180)
#define DECADE 2.302585092994046

typedef unit_fixture fixture;

static int set_up(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, 100, 100, 100);
    return unit_set_up_scene(state, &scene, 1, 0);
}

static asj_hypothesis corner(double x, double y, double first, double second, double log10_nfa, double width)
{
    asj_hypothesis h;
    memset(&h, 0, sizeof h);
    h.x = x;
    h.y = y;
    h.branch_count = 2;
    h.branches[0].angle = first * DEGREE;
    h.branches[1].angle = second * DEGREE;
    for (int b = 0; b < 2; b++) {
        h.branches[b].log_nfa = (log10_nfa + b) * DECADE;
        h.branches[b].width = width;
    }
    return h;
}

/* How many of a sure corner and another one stay. */
static size_t left_of(fixture *f, asj_hypothesis other, double sure, double width)
{
    asj_hypothesis list[2] = {corner(50, 50, 0, 90, sure, width), other};
    asj_detection_run run;
    memset(&run, 0, sizeof run);
    run.context = f->context;
    run.options = &f->options;
    run.frame = &f->frame;
    run.hypotheses = list;
    run.hypothesis_count = 2;
    assert_int_equal(asj_drop_soft_twins(&run), ASJ_OK);
    assert_true(list[0].x == 50 && list[0].y == 50);
    return run.hypothesis_count;
}

static void test_twins(void **state)
{
    fixture *f = *state;
    assert_int_equal(left_of(f, corner(54, 53, 10, 80, -1, 2), -40, 2), 1);
    assert_int_equal(left_of(f, corner(54, 53, 350, 100, -1, 2), -40, 2), 1);
    assert_int_equal(left_of(f, corner(54, 53, 10, 80, -1, 0), -40, 0), 2);   /* sharp */
    assert_int_equal(left_of(f, corner(56, 57, 10, 80, -1, 2), -40, 2), 2);   /* farther than 8 px */
    assert_int_equal(left_of(f, corner(54, 53, 10, 180, -1, 2), -40, 2), 2);  /* another way */
    assert_int_equal(left_of(f, corner(54, 53, 10, 80, -20, 2), -40, 2), 2);  /* sure itself */
    assert_int_equal(left_of(f, corner(54, 53, 10, 80, -1, 2), -10, 2), 2);   /* the other one is not by far surer */
}

static void test_matching(void **state)
{
    fixture *f = *state;
    f->options.independent_octaves = 1;
    assert_int_equal(left_of(f, corner(54, 53, 10, 80, -1, 2), -40, 2), 2);
    asj_detect_options_init(&f->options);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_twins), cmocka_unit_test(test_matching)};
    return cmocka_run_group_tests(tests, set_up, unit_tear_down);
}
