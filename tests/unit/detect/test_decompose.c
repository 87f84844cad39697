/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 6: order, counts and degenerate junctions. */
#include "unit_test.h"

static asj_junction star(int32_t count, const double *angles)
{
    asj_junction junction;
    memset(&junction, 0, sizeof junction);
    junction.x = 12.5f;
    junction.y = -3.25f;
    junction.branch_count = count;
    for (int32_t i = 0; i < count && i < ASJ_MAX_BRANCHES; i++) {
        junction.branches[i].angle = (float)angles[i];
        junction.branches[i].length = 10 + 3 * (float)i;
    }
    return junction;
}

static void check_l(const asj_junction *junctions, const asj_l_junction *l, double least)
{
    const asj_junction *junction = &junctions[l->junction];
    assert_true(l->branch_a != l->branch_b);
    assert_true(l->branch_a < junction->branch_count && l->branch_b < junction->branch_count);
    const asj_branch *a = &junction->branches[l->branch_a], *b = &junction->branches[l->branch_b];
    double turn = (double)b->angle - a->angle;
    turn -= 2 * UNIT_PI * floor(turn / (2 * UNIT_PI));
    assert_true(turn < UNIT_PI); /* a before b, clockwise on the screen */
    assert_true(turn >= least && turn <= UNIT_PI - least);
    unit_near("x", 0, 0, l->x, junction->x, 0);
    unit_near("y", 0, 0, l->y, junction->y, 0);
    unit_near("ax", 0, 0, l->ax, junction->x + a->length * cos(a->angle), 1e-5);
    unit_near("ay", 0, 0, l->ay, junction->y + a->length * sin(a->angle), 1e-5);
    unit_near("bx", 0, 0, l->bx, junction->x + b->length * cos(b->angle), 1e-5);
    unit_near("by", 0, 0, l->by, junction->y + b->length * sin(b->angle), 1e-5);
    /* the order in the form that an affine map keeps: a positive area with y down */
    assert_true((l->ax - l->x) * (l->by - l->y) - (l->ay - l->y) * (l->bx - l->x) > 0);
}

static size_t naive_count(const asj_junction *junction, double least)
{
    size_t count = 0;
    for (int32_t i = 0; i < junction->branch_count; i++)
        for (int32_t k = 0; k < i; k++) {
            const double opening = unit_turn(junction->branches[i].angle, junction->branches[k].angle);
            count += opening > 0 && opening < UNIT_PI && opening >= least && opening <= UNIT_PI - least;
        }
    return count;
}

static void test_random(void **state)
{
    enum { COUNT = 400 };
    static asj_junction junctions[COUNT];
    static asj_l_junction l[COUNT * 10];
    synth_random random;
    (void)state;
    synth_random_seed(&random, 3);
    for (int i = 0; i < COUNT; i++) {
        double angles[ASJ_MAX_BRANCHES];
        for (int k = 0; k < ASJ_MAX_BRANCHES; k++)
            angles[k] = synth_random_between(&random, 0, 2 * UNIT_PI);
        junctions[i] = star(i % (ASJ_MAX_BRANCHES + 1), angles);
    }
    for (double degrees = 0; degrees <= 90; degrees += 7.5) {
        const double least = degrees * (UNIT_PI / 180);
        size_t expected = 0, at = 0;
        for (int i = 0; i < COUNT; i++)
            expected += naive_count(&junctions[i], least);
        assert_int_equal(asj_decompose(junctions, COUNT, degrees, NULL, 0), expected);
        assert_int_equal(asj_decompose(junctions, COUNT, degrees, l, UNIT_COUNT(l)), expected);
        for (size_t i = 0; i < expected; i++) {
            check_l(junctions, &l[i], least);
            assert_true(i == 0 || l[i].junction >= l[i - 1].junction);
            for (size_t k = at; k < i; k++) /* each pair once */
                assert_false(l[k].junction == l[i].junction && l[k].branch_a + l[k].branch_b == l[i].branch_a + l[i].branch_b &&
                             l[k].branch_a * l[k].branch_b == l[i].branch_a * l[i].branch_b);
            at = l[i].junction == l[at].junction ? at : i;
        }
    }
}

static void test_named_shapes(void **state)
{
    static const struct {
        int32_t count;
        double angles[ASJ_MAX_BRANCHES];
        size_t expected;
    } shapes[] = {
        {2, {0, UNIT_PI / 2}, 1},                                          /* L */
        {3, {0, UNIT_PI / 2, UNIT_PI}, 2},                                 /* T: the straight pair is left out */
        {4, {0.1, 0.1 + UNIT_PI / 2, 0.1 + UNIT_PI, 0.1 + 1.5 * UNIT_PI}, 4}, /* X */
        {3, {0.3, 2.4, 4.5}, 3},                                           /* Y */
        {5, {0, 1.2, 2.4, 3.7, 5}, 10},                                    /* every pair of a star */
        {2, {1, 1}, 0}, {2, {1, 1 + UNIT_PI}, 0}, {1, {2}, 0}, {0, {0}, 0},
    };
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(shapes); i++) {
        asj_junction junction = star(shapes[i].count, shapes[i].angles);
        assert_int_equal(asj_decompose(&junction, 1, 10, NULL, 0), shapes[i].expected);
    }
}

/* At minimum_opening 0 every pair but the equal and the opposite ones counts. Floats cannot hold pi: the
 * nearest one is opposite. */
static void test_no_minimum(void **state)
{
    static const double near[] = {0, 1e-3, 2.0, UNIT_PI - 1e-3};
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(near); i++) {
        const double angles[2] = {1, 1 + near[i]};
        asj_junction junction = star(2, angles);
        assert_int_equal(asj_decompose(&junction, 1, 0, NULL, 0), near[i] > 0);
    }
    const double line[2] = {0, UNIT_PI};
    asj_junction straight = star(2, line);
    assert_int_equal(asj_decompose(&straight, 1, 0, NULL, 0), 0);
}

/* A short array is filled, and the whole number returned; nothing is written behind it. */
static void test_capacity(void **state)
{
    static const double angles[] = {0.2, 1.2, 2.4, 3.7, 5};
    const asj_junction junctions[2] = {star(5, angles), star(5, angles)};
    asj_l_junction all[20], some[21];
    (void)state;
    assert_int_equal(asj_decompose(junctions, 2, 5, all, 20), 20);
    for (size_t capacity = 0; capacity <= 20; capacity++) {
        memset(some, 0x5a, sizeof some);
        assert_int_equal(asj_decompose(junctions, 2, 5, some, capacity), 20);
        assert_memory_equal(some, all, capacity * sizeof *some);
        assert_int_equal(((unsigned char *)&some[capacity])[0], 0x5a);
    }
}

static void test_bad_junctions(void **state)
{
    static const double angles[] = {0.2, 1.2, 2.4, 3.7, 5};
    asj_junction junctions[5];
    asj_l_junction l[10];
    (void)state;
    for (int i = 0; i < 5; i++)
        junctions[i] = star(2, angles);
    junctions[0].branch_count = -1;
    junctions[1].branch_count = ASJ_MAX_BRANCHES + 1;
    junctions[2].branch_count = INT32_MAX;
    junctions[3].branches[1].angle = NAN;
    assert_int_equal(asj_decompose(junctions, 5, 5, l, 10), 1);
    assert_int_equal(l[0].junction, 4);
    assert_int_equal(asj_decompose(NULL, 5, 5, l, 10), 0);
    assert_int_equal(asj_decompose(junctions, 0, 5, l, 10), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),   cmocka_unit_test(test_named_shapes), cmocka_unit_test(test_no_minimum),
        cmocka_unit_test(test_capacity), cmocka_unit_test(test_bad_junctions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
