/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/affine.c: maps between frames against the three point pairs that define them. */
#include "match/affine.h"
#include "unit_test.h"

/* Deterministic frames all over the plane: lengths 3 .. 100 px, openings 20 .. 160 deg. */
static asj_affine_frame frame(int32_t n)
{
    const double turn = 0.7 * n, opening = (20 + 140 * fmod(0.37 * n, 1)) * UNIT_PI / 180;
    const double a = 3 + 97 * fmod(0.61 * n, 1), b = 3 + 97 * fmod(0.29 * n, 1);
    return (asj_affine_frame){10.0 * n, 400 - 3.0 * n, a * cos(turn), a * sin(turn),
                              b * cos(turn + opening), b * sin(turn + opening)};
}

static void maps_the_branches(void **state)
{
    (void)state;
    for (int32_t n = 0; n < 40; n++)
        for (int32_t k = 0; k < 40; k++) {
            const asj_affine_frame f = frame(n), g = frame(k);
            asj_linear map;
            assert_int_equal(asj_affine_between(&f, &g, &map), 1);
            unit_near("a.x", n, k, map.to[0] * f.ax + map.to[1] * f.ay, g.ax, 1e-9);
            unit_near("a.y", n, k, map.to[2] * f.ax + map.to[3] * f.ay, g.ay, 1e-9);
            unit_near("b.x", n, k, map.to[0] * f.bx + map.to[1] * f.by, g.bx, 1e-9);
            unit_near("b.y", n, k, map.to[2] * f.bx + map.to[3] * f.by, g.by, 1e-9);
            unit_near("back x", n, k, map.from[0] * g.ax + map.from[1] * g.ay, f.ax, 1e-9);
            unit_near("back y", n, k, map.from[2] * g.bx + map.from[3] * g.by, f.by, 1e-9);
            assert_true(map.to[0] * map.to[3] - map.to[1] * map.to[2] > 0);
        }
}

static void the_inverse_map_of_a_pair_is_the_map_of_the_swapped_pair(void **state)
{
    (void)state;
    for (int32_t n = 0; n < 40; n++) {
        const asj_affine_frame f = frame(n), g = frame(n + 7);
        asj_linear there, back;
        assert_int_equal(asj_affine_between(&f, &g, &there), 1);
        assert_int_equal(asj_affine_between(&g, &f, &back), 1);
        assert_memory_equal(there.to, back.from, sizeof there.to); /* the same bits: swapping images must swap matches */
        assert_memory_equal(there.from, back.to, sizeof there.from);
    }
}

static void degenerate_and_mirrored_pairs_give_no_map(void **state)
{
    (void)state;
    const asj_affine_frame good = frame(3);
    const asj_affine_frame bad[] = {
        {0, 0, 10, 0, 20, 0},     /* collinear */
        {0, 0, 10, 0, -20, 0},    /* opposite */
        {0, 0, 0, 0, 5, 5},       /* no length */
        {0, 0, 0.5, 0, 0, 0.5},   /* smaller than a pixel */
        {0, 0, 0, 10, 10, 0},     /* the order says mirrored */
        {0, 0, NAN, 0, 0, 10},
        {0, 0, HUGE_VAL, 0, 0, 10},
    };
    for (size_t n = 0; n < UNIT_COUNT(bad); n++) {
        asj_linear map = {{7, 7, 7, 7}, {7, 7, 7, 7}}, before = map;
        assert_int_equal(asj_affine_between(&good, &bad[n], &map), 0);
        assert_int_equal(asj_affine_between(&bad[n], &good, &map), 0);
        assert_memory_equal(&map, &before, sizeof map);
    }
}

static void inverts(void **state)
{
    (void)state;
    const double matrix[4] = {2, -0.5, 0.25, 1.5}, singular[4] = {1, 2, 2, 4};
    double inverse[4] = {9, 9, 9, 9};
    assert_int_equal(asj_affine_invert(singular, inverse), 0);
    unit_near("untouched", 0, 0, inverse[0], 9, 0);
    assert_int_equal(asj_affine_invert(matrix, inverse), 1);
    unit_near("identity 00", 0, 0, matrix[0] * inverse[0] + matrix[1] * inverse[2], 1, 1e-15);
    unit_near("identity 01", 0, 0, matrix[0] * inverse[1] + matrix[1] * inverse[3], 0, 1e-15);
    unit_near("identity 10", 0, 0, matrix[2] * inverse[0] + matrix[3] * inverse[2], 0, 1e-15);
    unit_near("identity 11", 0, 0, matrix[2] * inverse[1] + matrix[3] * inverse[3], 1, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_the_branches),
        cmocka_unit_test(the_inverse_map_of_a_pair_is_the_map_of_the_swapped_pair),
        cmocka_unit_test(degenerate_and_mirrored_pairs_give_no_map),
        cmocka_unit_test(inverts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
