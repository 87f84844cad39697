/* SPDX-License-Identifier: BSD-2-Clause */
/* The scoring itself: perfect results, empty ones and shifted ones get the figures they deserve. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "scenes.h"
#include "score.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g is not within %g of %.12g", value, tolerance, expected);
}

/* A detector that knows the truth, and errs as told. */
static uint32_t pretend(const synth_truth *truth, double shift, double turn, double longer, asj_junction *out)
{
    for (int32_t i = 0; i < truth->count; i++) {
        const synth_true_junction *j = &truth->junctions[i];
        memset(&out[i], 0, sizeof out[i]);
        out[i].x = (float)(j->x + shift);
        out[i].y = (float)j->y;
        out[i].location_sd = 0.5f;
        out[i].branch_count = j->branch_count;
        for (int32_t k = 0; k < j->branch_count; k++) {
            out[i].branches[k].angle = (float)fmod(j->branches[k].angle + turn + 2.0 * PI, 2.0 * PI);
            out[i].branches[k].length = (float)(j->branches[k].length + longer);
            out[i].branches[k].angle_sd = 0.01f;
        }
    }
    return (uint32_t)truth->count;
}

typedef struct fixture {
    synth_scene scene;
    synth_truth truth;
    asj_junction found[64];
    score s;
} fixture;

static void set_up(fixture *f, int board)
{
    if (board)
        synth_tiles(&f->scene, SYNTH_CHECKERBOARD, 3);
    else
        synth_parallelograms(&f->scene, 60.0, 3);
    assert_int_equal(synth_truth_of_scene(&f->scene, 1.0, &f->truth), 0);
    score_init(&f->s, 25.0);
}

static void tear_down(fixture *f)
{
    score_free(&f->s);
    synth_truth_free(&f->truth);
    synth_scene_free(&f->scene);
}

static void add(fixture *f, uint32_t count)
{
    assert_int_equal(score_add(&f->s, &f->truth, f->found, count, NULL, NULL), 0);
}

static void errors_are_measured(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, 0);
    add(&f, pretend(&f.truth, 1.0, 0.02, -2.0, f.found));
    assert_int_equal(f.s.expected, 12);
    assert_near(score_recall(&f.s), 1.0, 0.0);
    assert_near(score_precision(&f.s), 1.0, 0.0);
    assert_near(sample_quantile(&f.s.location, 0.5), 1.0, 1e-4);
    assert_near(sample_quantile(&f.s.location_sds, 0.5), 2.0, 1e-3);
    assert_near(sample_quantile(&f.s.angle, 0.9), 0.02 * 180.0 / PI, 1e-4);
    assert_near(sample_quantile(&f.s.angle_sds, 0.5), 2.0, 1e-4);
    assert_near(sample_quantile(&f.s.length, 0.5), -2.0, 1e-4);
    assert_near(sample_mad(&f.s.length), 0.0, 1e-4);
    assert_near(sample_share_within(&f.s.length, 3.0), 1.0, 0.0);
    assert_near(sample_share_within(&f.s.length, 1.9), 0.0, 0.0);
    assert_int_equal(f.s.branches, 24);
    assert_int_equal(f.s.branches_paired, 24);
    assert_int_equal(f.s.branches_extra, 0);
    tear_down(&f);
}

static void nothing_found(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, 0);
    add(&f, 0);
    assert_near(score_recall(&f.s), 0.0, 0.0);
    assert_true(isnan(score_precision(&f.s)));
    tear_down(&f);
}

static void beyond_the_limit(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, 0);
    add(&f, pretend(&f.truth, 3.1, 0.0, 0.0, f.found));
    assert_near(score_recall(&f.s), 0.0, 0.0);
    assert_near(score_precision(&f.s), 0.0, 0.0);
    tear_down(&f);
}

static void a_second_at_one_corner_is_false(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, 0);
    const uint32_t count = pretend(&f.truth, 0.2, 0.0, 0.0, f.found);
    f.found[count] = f.found[0];
    f.found[count].x += 1.0f;
    add(&f, count + 1);
    assert_near(score_recall(&f.s), 1.0, 0.0);
    assert_near(score_precision(&f.s), 12.0 / 13.0, 1e-12);
    tear_down(&f);
}

static void wrong_branches_are_no_branches(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, 0);
    add(&f, pretend(&f.truth, 0.0, 0.2, 0.0, f.found));
    assert_int_equal(f.s.branches_paired, 0);
    assert_int_equal(f.s.branches_extra, 24);
    tear_down(&f);
}

static void long_branches_are_counted(void **state)
{
    (void)state;
    fixture f;
    set_up(&f, 1);
    /* Twelve lines of six points: a branch towards either side is long when at least one point lies between: 2 x 4 a line. */
    add(&f, pretend(&f.truth, 0.0, 0.0, 7.9, f.found));
    assert_int_equal(f.s.long_branches, 96);
    assert_int_equal(f.s.long_reached, 96);
    assert_int_equal(f.s.full_branches, 24);
    assert_int_equal(f.s.full_reached, 24);
    add(&f, pretend(&f.truth, 0.0, 0.0, -8.1, f.found));
    assert_int_equal(f.s.long_branches, 192);
    assert_int_equal(f.s.long_reached, 96);
    assert_int_equal(f.s.full_reached, 24);
    tear_down(&f);
}

static void order_statistics(void **state)
{
    (void)state;
    sample s = {NULL, 0, 0, 0};
    assert_true(isnan(sample_quantile(&s, 0.5)));
    for (int i = 0; i < 1001; i++)
        sample_add(&s, (i * 7919) % 1001);
    assert_near(sample_quantile(&s, 0.5), 500.0, 1e-12);
    assert_near(sample_quantile(&s, 0.9), 900.0, 1e-9);
    assert_near(sample_mad(&s), 250.0, 1e-12);
    assert_near(sample_share_within(&s, 100.0), 101.0 / 1001.0, 1e-12);
    sample_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_measured),
        cmocka_unit_test(nothing_found),
        cmocka_unit_test(beyond_the_limit),
        cmocka_unit_test(a_second_at_one_corner_is_false),
        cmocka_unit_test(wrong_branches_are_no_branches),
        cmocka_unit_test(long_branches_are_counted),
        cmocka_unit_test(order_statistics),
    };
    return cmocka_run_group_tests_name("score", tests, NULL, NULL);
}
