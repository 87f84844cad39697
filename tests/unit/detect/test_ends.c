/* SPDX-License-Identifier: BSD-2-Clause */
/* Ends of branches that snap to junctions, against the rule asked of every pair. */
#include "detect/ends.h"
#include "unit_test.h"

enum { COUNT = 120 };

static void snap_by(const asj_detect_options *options, asj_hypothesis *hypotheses, size_t count)
{
    asj_context *context = NULL;
    asj_junction_grid grid;
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    assert_int_equal(asj_junction_grid_make(context, hypotheses, count, 120, 90, &grid), ASJ_OK);
    const asj_ends ends = {&grid, options, hypotheses};
    for (size_t i = 0; i < count; i++)
        asj_ends_snap(&ends, i);
    asj_junction_grid_free(context, &grid);
    asj_context_free(&context);
}

static void snap(asj_hypothesis *hypotheses, size_t count, double reach)
{
    asj_detect_options options;
    asj_detect_options_init(&options);
    options.snap_distance = reach;
    snap_by(&options, hypotheses, count);
}

/* Of the junctions ahead, at most 2 px off the line and less than `reach` px from the end, the one nearest to the end, but for
 * those that would halve the branch where the reach is less than 8 px. */
static double naive_length(const asj_hypothesis *hypotheses, size_t count, size_t self, const asj_hypothesis_branch *branch,
                           double reach)
{
    double best = reach, length = branch->length;
    for (size_t i = 0; i < count; i++) {
        const double dx = hypotheses[i].x - hypotheses[self].x, dy = hypotheses[i].y - hypotheses[self].y;
        const double t = dx * cos(branch->angle) + dy * sin(branch->angle), off = dy * cos(branch->angle) - dx * sin(branch->angle);
        if (i != self && t > 0 && fabs(off) <= 2 && fabs(t - branch->length) < best) {
            best = fabs(t - branch->length);
            length = t;
        }
    }
    return reach < 8 && length < 0.5 * branch->length ? branch->length : length;
}

static void test_random(void **state)
{
    static asj_hypothesis hypotheses[COUNT], before[COUNT];
    synth_random random;
    int moved = 0;
    (void)state;
    synth_random_seed(&random, 14);
    for (int round = 0; round < 40; round++) {
        const size_t count = (size_t)(round * 3);
        const double reach = round % 4 == 3 ? 30 : 2.0 + round % 10;
        memset(hypotheses, 0, sizeof hypotheses);
        for (size_t i = 0; i < count; i++) {
            asj_hypothesis *d = &hypotheses[i];
            d->x = synth_random_between(&random, -12, 130);
            d->y = floor(synth_random_between(&random, -12, 100)); /* rows with several */
            d->branch_count = (int32_t)synth_random_between(&random, 2, 6);
            for (int32_t b = 0; b < d->branch_count; b++) {
                d->branches[b].angle = synth_random_between(&random, 0, 2 * UNIT_PI);
                d->branches[b].length = synth_random_between(&random, 1, 80);
            }
        }
        memcpy(before, hypotheses, sizeof before);
        snap(hypotheses, count, reach);
        for (size_t i = 0; i < count; i++)
            for (int32_t b = 0; b < hypotheses[i].branch_count; b++) {
                unit_near("length", (double)i, b, hypotheses[i].branches[b].length,
                          naive_length(before, count, i, &before[i].branches[b], reach), 1e-9);
                moved += hypotheses[i].branches[b].length != before[i].branches[b].length;
                if (hypotheses[i].branches[b].length != before[i].branches[b].length)
                    assert_int_equal(hypotheses[i].branches[b].end, ASJ_BRANCH_END_JUNCTION);
                hypotheses[i].branches[b].length = before[i].branches[b].length;
                hypotheses[i].branches[b].end = before[i].branches[b].end;
                hypotheses[i].branches[b].end_variance = before[i].branches[b].end_variance;
            }
        assert_memory_equal(hypotheses, before, sizeof before); /* nothing else changes */
    }
    assert_true(moved > 500);
}

static void test_off(void **state)
{
    asj_hypothesis hypotheses[2], before[2];
    (void)state;
    memset(hypotheses, 0, sizeof hypotheses);
    hypotheses[0].branch_count = 1;
    hypotheses[0].branches[0].length = 20;
    hypotheses[0].location_variance = 0.02;
    hypotheses[1].location_variance = 0.03;
    hypotheses[1].x = 26;
    memcpy(before, hypotheses, sizeof before);
    snap(hypotheses, 2, 0);
    assert_memory_equal(hypotheses, before, sizeof before);
    hypotheses[1].x = 21; /* so near that it is what is there */
    snap(hypotheses, 2, 0);
    assert_true(hypotheses[0].branches[0].length == 20 && hypotheses[0].branches[0].end == ASJ_BRANCH_END_JUNCTION);
    snap(hypotheses, 0, 5);
    snap(hypotheses, 2, 5);
    assert_true(hypotheses[0].branches[0].length == 21);
    unit_near("variance", 0, 0, hypotheses[0].branches[0].end_variance, 0.05, 1e-12);
}

/* Where the end comes to after the branch was snapped to a corner 6 px behind it, whose branches these are. */
static double snapped(double reach, double back, double other, double log_nfa)
{
    asj_hypothesis hypotheses[2];
    memset(hypotheses, 0, sizeof hypotheses);
    hypotheses[0].branch_count = 1;
    hypotheses[0].branches[0].length = 26;
    hypotheses[1].x = 20;
    hypotheses[1].branch_count = 2;
    hypotheses[1].branches[0].angle = back;
    hypotheses[1].branches[1].angle = other;
    hypotheses[1].branches[0].log_nfa = -400;
    hypotheses[1].branches[1].log_nfa = log_nfa;
    snap(hypotheses, 2, reach);
    return hypotheses[0].branches[0].length;
}

/* A corner beyond doubt has a wider reach, if the branch comes back from it and none goes on. */
static void test_sure(void **state)
{
    (void)state;
    assert_true(snapped(4, UNIT_PI, 0.4, -300) == 20);
    assert_true(snapped(2, UNIT_PI, 0.4, -125) == 20); /* 10^-54.3 reaches 6.9 px far */
    assert_true(snapped(2, UNIT_PI, 0.4, -110) == 26); /* 10^-47.8 5.6 */
    assert_true(snapped(4, UNIT_PI, 0.2, -300) == 26); /* goes on */
    assert_true(snapped(4, 2.5, 0.4, -300) == 26);     /* does not come back */
    assert_true(snapped(4, UNIT_PI, 0.4, -69) == 26);  /* not sure */
    assert_true(snapped(0, UNIT_PI, 0.4, -300) == 26); /* off */
    assert_true(snapped(8, UNIT_PI, 0.2, -100) == 20);
}

/* 20 px from the junction, 26 px long: not where that is too short. */
static void test_minimum_length(void **state)
{
    asj_hypothesis hypotheses[2];
    asj_detect_options options;
    (void)state;
    asj_detect_options_init(&options);
    options.snap_distance = 10;
    memset(hypotheses, 0, sizeof hypotheses);
    hypotheses[0].branch_count = 1;
    hypotheses[0].branches[0].length = 26;
    hypotheses[1].x = 20;
    options.minimum_length = 21;
    snap_by(&options, hypotheses, 2);
    assert_true(hypotheses[0].branches[0].length == 26);
    options.minimum_length = 20;
    snap_by(&options, hypotheses, 2);
    assert_true(hypotheses[0].branches[0].length == 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random), cmocka_unit_test(test_off), cmocka_unit_test(test_sure),
                                       cmocka_unit_test(test_minimum_length)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
