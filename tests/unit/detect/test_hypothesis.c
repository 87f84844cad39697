/* SPDX-License-Identifier: BSD-2-Clause */
#include "detect/hypothesis.h"
#include "unit_test.h"

static void test_angles(void **state)
{
    (void)state;
    for (double a = -20; a < 20; a += 0.37)
        for (double b = -20; b < 20; b += 0.53)
            unit_near("distance", a, b, asj_angle_distance(a, b), unit_turn(a, b), 1e-12);
    for (double a = -20; a < 20; a += 0.0371) {
        const double wrapped = asj_angle_wrap(a);
        assert_true(wrapped >= 0 && wrapped <= 2 * UNIT_PI);
        unit_near("wrap", a, 0, sin(wrapped), sin(a), 1e-12);
        unit_near("wrap", a, 0, cos(wrapped), cos(a), 1e-12);
    }
}

static void test_select(void **state)
{
    (void)state;
    for (int mask = 0; mask < 1 << ASJ_MAX_BRANCHES; mask++) {
        asj_hypothesis hypothesis;
        int keep[ASJ_MAX_BRANCHES];
        int32_t kept = 0;
        memset(&hypothesis, 0, sizeof hypothesis);
        hypothesis.branch_count = ASJ_MAX_BRANCHES;
        for (int i = 0; i < ASJ_MAX_BRANCHES; i++) {
            hypothesis.branches[i].angle = i + 1;
            keep[i] = mask >> i & 1;
        }
        asj_hypothesis_select(&hypothesis, keep);
        for (int i = 0; i < ASJ_MAX_BRANCHES; i++)
            if (keep[i])
                assert_true(hypothesis.branches[kept++].angle == i + 1);
        assert_int_equal(hypothesis.branch_count, kept);
    }
}

static int has_opening(double a, double b, double c, int32_t count, double least)
{
    asj_hypothesis hypothesis;
    memset(&hypothesis, 0, sizeof hypothesis);
    hypothesis.branch_count = count;
    hypothesis.branches[0].angle = a;
    hypothesis.branches[1].angle = b;
    hypothesis.branches[2].angle = c;
    return asj_hypothesis_has_opening(&hypothesis, least);
}

static void test_opening(void **state)
{
    (void)state;
    assert_false(has_opening(1, 2, 0, 0, 0.1));
    assert_false(has_opening(1, 2, 0, 1, 0.1));
    assert_true(has_opening(1, 2, 0, 2, 0.1));
    assert_false(has_opening(1, 1, 0, 2, 0));             /* the same direction is no opening, */
    assert_false(has_opening(0, UNIT_PI, 0, 2, 0));       /* nor is the opposite one */
    assert_false(has_opening(1, 1.09, 0, 2, 0.1));
    assert_true(has_opening(1, 1.11, 0, 2, 0.1));
    assert_false(has_opening(0, UNIT_PI - 0.09, 0, 2, 0.1));
    assert_true(has_opening(0, UNIT_PI - 0.11, 0, 2, 0.1));
    assert_true(has_opening(0.02, 2 * UNIT_PI - 0.1, 0, 2, 0.1)); /* over the seam */
    assert_false(has_opening(0.02, 2 * UNIT_PI - 0.05, 0, 2, 0.1));
    assert_true(has_opening(0, UNIT_PI, 1, 3, 0.1)); /* a T */
    assert_true(has_opening(0, 0.05, 1, 3, 0.1));
}

/* One constant stands for what the C library would compute. */
static void a_decade_is_log_10(void **state)
{
    volatile double ten = 10; /* not computed by the compiler */
    (void)state;
    assert_true(log(ten) == ASJ_LN_10 && log(10) == ASJ_LN_10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_decade_is_log_10),
        cmocka_unit_test(test_angles),
        cmocka_unit_test(test_select),
        cmocka_unit_test(test_opening),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
