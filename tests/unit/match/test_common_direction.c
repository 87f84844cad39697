/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/common_direction.c: two branches and a map, against a search for the least squares that they stand for. */
#include "match/common_direction.h"
#include "match/affine.h"
#include "unit_test.h"

#define MAP_SD 0.035 /* rad, as stated there */

/* A branch of a match in both images: detected directions that differ by `wrong` from what the map says. */
typedef struct sighting {
    double map[4], sd[2], branch[2][2];
} sighting;

static double angle_of(const double v[2])
{
    return atan2(v[1], v[0]);
}

static double mapped_angle(const double map[4], double angle)
{
    const double u[2] = {cos(angle), sin(angle)}, to[2] = {map[0] * u[0] + map[1] * u[1], map[2] * u[0] + map[3] * u[1]};
    return angle_of(to);
}

/* Maps that turn, stretch up to 2.5 times and shear; not all of them keep the sense of turning. */
static sighting make(int32_t n, double wrong)
{
    const double turn = 0.9 * n, stretch = 0.4 + 2.1 * fmod(0.41 * n, 1), shear = fmod(0.73 * n, 1) - 0.5, first = 1.3 * n;
    const double flip = n % 5 == 0 ? -1 : 1, length[2] = {4 + 60 * fmod(0.37 * n, 1), 4 + 60 * fmod(0.59 * n, 1)};
    sighting s = {{stretch * cos(turn), flip * (shear * cos(turn) - sin(turn)), stretch * sin(turn),
                   flip * (shear * sin(turn) + cos(turn))},
                  {0.005 + 0.2 * fmod(0.29 * n, 1), 0.005 + 0.2 * fmod(0.83 * n, 1)},
                  {{length[0] * cos(first), length[0] * sin(first)}, {0, 0}}};
    const double second = mapped_angle(s.map, first) + wrong;
    s.branch[1][0] = length[1] * cos(second);
    s.branch[1][1] = length[1] * sin(second);
    return s;
}

/* d phi_2 / d phi_1 of the map at a direction of image 1, by differences. */
static double slope(const double map[4], double angle)
{
    const double step = 1e-5, u = mapped_angle(map, angle - step), v = mapped_angle(map, angle + step);
    return atan2(sin(v - u), cos(v - u)) / (2 * step);
}

/* Of the directions that differ by d1 and d2 from the detected ones; the map's deviation is that at the middle of its slope. */
static double cost(const sighting *s, double d1, double d2)
{
    const double phi1 = angle_of(s->branch[0]) + d1, phi2 = angle_of(s->branch[1]) + d2, f = mapped_angle(s->map, phi1);
    const double off = atan2(sin(phi2 - f), cos(phi2 - f)), v = fabs(slope(s->map, angle_of(s->branch[0]))) * MAP_SD * MAP_SD;
    return d1 * d1 / (s->sd[0] * s->sd[0]) + d2 * d2 / (s->sd[1] * s->sd[1]) + off * off / v;
}

/* Looks around for less, in smaller and smaller steps. */
static void search(const sighting *s, double d[2])
{
    d[0] = d[1] = 0;
    for (double step = 0.02; step > 1e-9; step /= 2)
        for (int better = 1; better;) {
            double best = cost(s, d[0], d[1]), at[2] = {d[0], d[1]};
            better = 0;
            for (int k = 0; k < 9; k++) {
                const double d1 = d[0] + (k % 3 - 1) * step, d2 = d[1] + (k / 3 - 1) * step, c = cost(s, d1, d2);
                if (c < best) {
                    best = c;
                    at[0] = d1;
                    at[1] = d2;
                    better = 1;
                }
            }
            d[0] = at[0];
            d[1] = at[1];
        }
}

static double turned(const double from[2], const double to[2])
{
    return atan2(from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
}

static void test_least_squares(void **state)
{
    (void)state;
    for (int32_t n = 1; n < 60; n++) {
        const double wrong = n % 2 ? 0.01 : -0.01; /* small: slopes hardly differ between the directions */
        const sighting before = make(n, wrong);
        sighting s = before;
        double least[2];
        search(&before, least);
        assert_int_equal(asj_common_direction(s.map, s.sd, s.branch), 1);
        for (int side = 0; side < 2; side++) {
            unit_near("turn", n, side, turned(before.branch[side], s.branch[side]), least[side], 0.02 * fabs(wrong));
            unit_near("length", n, side, hypot(s.branch[side][0], s.branch[side][1]),
                      hypot(before.branch[side][0], before.branch[side][1]), 1e-9);
        }
    }
}

/* Nearer to each other under the map, however far apart they were. */
static void test_far_apart(void **state)
{
    static const double wrongs[] = {0, 0.1, -0.4, 0.9, -1.6, 2.5};
    (void)state;
    for (int32_t n = 1; n < 60; n++) {
        sighting s = make(n, wrongs[n % 6]);
        const double w = wrongs[n % 6];
        asj_common_direction(s.map, s.sd, s.branch);
        const double mapped = mapped_angle(s.map, angle_of(s.branch[0])), left = angle_of(s.branch[1]) - mapped;
        const double off = atan2(sin(left), cos(left));
        assert_true(fabs(off) <= fabs(w) + 1e-9);
        assert_true(w == 0 || fabs(off) < 0.999 * fabs(w));
    }
}

/* What is known well stays and shows the other one its direction. */
static void test_certain(void **state)
{
    (void)state;
    for (int32_t n = 1; n < 40; n++)
        for (int known = 0; known < 2; known++) {
            sighting s = make(n, 0.3);
            const sighting before = s;
            s.sd[known] = 1e-4;
            s.sd[!known] = 1;
            asj_common_direction(s.map, s.sd, s.branch);
            unit_near("certain", n, known, turned(before.branch[known], s.branch[known]), 0, 1e-5);
            const double mapped = mapped_angle(s.map, angle_of(s.branch[0])), left = angle_of(s.branch[1]) - mapped;
            unit_near("shown", n, known, atan2(sin(left), cos(left)), 0, 0.02);
        }
}

static void test_swap(void **state)
{
    (void)state;
    for (int32_t n = 1; n < 60; n++) {
        sighting s = make(n, 0.02 * n), swapped = s;
        assert_int_equal(asj_affine_invert(s.map, swapped.map), 1);
        for (int k = 0; k < 2; k++) {
            swapped.sd[k] = s.sd[1 - k];
            memcpy(swapped.branch[k], s.branch[1 - k], sizeof s.branch[0]);
        }
        asj_common_direction(s.map, s.sd, s.branch);
        asj_common_direction(swapped.map, swapped.sd, swapped.branch);
        for (int k = 0; k < 4; k++)
            unit_near("swapped", n, k, swapped.branch[k / 2][k % 2], s.branch[1 - k / 2][k % 2], 1e-9);
    }
}

static void test_unknown(void **state)
{
    static const double bad[] = {0, -1, 4, NAN, HUGE_VAL};
    static const double no_map[] = {1, 2, 2, 4};
    (void)state;
    for (size_t n = 0; n < 2 * UNIT_COUNT(bad); n++) {
        sighting s = make((int32_t)n + 1, 0.3);
        const sighting before = s;
        s.sd[n % 2] = bad[n / 2];
        assert_int_equal(asj_common_direction(s.map, s.sd, s.branch), 0);
        assert_memory_equal(s.branch, before.branch, sizeof s.branch);
    }
    for (int n = 0; n < 3; n++) {
        sighting s = make(7, 0.3);
        if (n < 2)
            s.branch[n][0] = s.branch[n][1] = 0;
        else
            memcpy(s.map, no_map, sizeof no_map);
        const sighting before = s;
        assert_int_equal(asj_common_direction(s.map, s.sd, s.branch), 0);
        assert_memory_equal(s.branch, before.branch, sizeof s.branch);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_least_squares), cmocka_unit_test(test_far_apart), cmocka_unit_test(test_certain),
        cmocka_unit_test(test_swap), cmocka_unit_test(test_unknown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
