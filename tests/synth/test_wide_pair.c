/* SPDX-License-Identifier: BSD-2-Clause */
/* Wide pairs of rooms: what they promise, and that their pose is that of the pictures. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "render.h"
#include "wide_pair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SEEDS 12

static void pairs_are_what_they_promise(void **state)
{
    (void)state;
    int made = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        synth_wide_pair pair, again;
        if (synth_wide_pair_make(&pair, seed) != 0)
            continue;
        made++;
        assert_int_equal(synth_wide_pair_make(&again, seed), 0);
        assert_memory_equal(pair.cameras, again.cameras, sizeof pair.cameras);
        assert_memory_equal(pair.exposures, again.exposures, sizeof pair.exposures);
        assert_true(pair.angle >= 30 && pair.angle <= 70);
        assert_true(pair.scale >= 0.4 && pair.scale <= 2.5);
        assert_true(pair.common > 0.15 && pair.common <= 1);
        assert_true(pair.corners >= 40);
        synth_wide_pair_free(&again);
        synth_wide_pair_free(&pair);
        assert_null(pair.room.surfaces);
    }
    assert_in_range(made, SEEDS / 2, SEEDS);
}

static void near_pairs_are_what_they_promise(void **state)
{
    (void)state;
    int made = 0, apart = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        synth_wide_pair pair;
        if (synth_near_pair_make(&pair, seed) != 0)
            continue;
        made++;
        apart += pair.angle > 1;
        assert_true(pair.angle > 0 && pair.angle <= 16); /* a step of 15 degrees towards the target is seen under up to that */
        assert_true(pair.scale > 0.7 && pair.scale < 1.4);
        assert_true(pair.common > 0.15 && pair.corners >= 40);
        synth_wide_pair_free(&pair);
    }
    assert_in_range(made, SEEDS / 2, SEEDS);
    assert_true(2 * apart > made);
}

static void turned_pairs_are_what_they_promise(void **state)
{
    (void)state;
    int made = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        synth_wide_pair pair;
        double r[9], t[3];
        if (synth_turned_pair_make(&pair, seed) != 0)
            continue;
        made++;
        synth_relative_pose(&pair.cameras[0], &pair.cameras[1], r, t);
        assert_true(t[0] == 0 && t[1] == 0 && t[2] == 0);
        assert_true(r[0] + r[4] + r[8] < 3 - 1e-4 && r[0] + r[4] + r[8] > 1 + 2 * cos(0.6)); /* .6 to 34 degrees */
        assert_true(fabs(pair.angle) < 1e-3 && fabs(pair.scale - 1) < 1e-9);
        assert_true(pair.common > 0.15 && pair.corners >= 40);
        synth_wide_pair_free(&pair);
    }
    assert_in_range(made, SEEDS / 2, SEEDS);
}

/* Whatever compiler made the test: a number drawn earlier or later would be another room. */
static void a_seed_is_one_room_everywhere(void **state)
{
    (void)state;
    static const struct {
        uint64_t seed;
        int32_t surfaces;
        double x, z, yaw, angle, corners; /* of camera 1, of camera 2; all corners in a weighted sum */
    } known[3] = {{6, 282, 1.849866142, 2.628477424, -0.460300808, 32.568640701, 2540624.887387736},
                  {7, 113, 4.253840006, 2.172895123, 0.383667709, 37.901373799, 305403.700237420},
                  {9, 149, 4.270250138, 0.937224897, 1.287670267, 56.486722988, 443212.422798090}};
    for (int k = 0; k < 3; k++) {
        synth_wide_pair pair;
        double corners = 0;
        assert_int_equal(synth_wide_pair_make(&pair, known[k].seed), 0);
        for (int32_t i = 0; i < pair.room.surface_count; i++)
            for (int32_t c = 0; c < pair.room.surfaces[i].count; c++) {
                const synth_vector p = pair.room.surfaces[i].corners[c];
                corners += (i + 1) * (p.x + 2 * p.y + 3 * p.z);
            }
        assert_int_equal(pair.room.surface_count, known[k].surfaces);
        assert_true(fabs(pair.cameras[0].position.x - known[k].x) < 1e-8);
        assert_true(fabs(pair.cameras[1].position.z - known[k].z) < 1e-8);
        assert_true(fabs(pair.cameras[1].yaw - known[k].yaw) < 1e-8);
        assert_true(fabs(pair.angle - known[k].angle) < 1e-6);
        assert_true(fabs(corners - known[k].corners) < 1e-3);
        synth_wide_pair_free(&pair);
    }
}

/* Corners of the room: what camera 1 sees, taken to camera 2 by R and t, is what camera 2 sees, up to the depth; and it lies on the
 * epipolar line of synth_fundamental(). */
static void the_pose_is_that_of_the_cameras(void **state)
{
    (void)state;
    synth_wide_pair pair;
    double r[9], t[3], f[9];
    int seen = 0;
    assert_int_equal(synth_wide_pair_make(&pair, 1), 0);
    const synth_camera *a = &pair.cameras[0], *b = &pair.cameras[1];
    synth_relative_pose(a, b, r, t);
    synth_fundamental(a, b, f);
    assert_true(fabs(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] - 1) < 1e-12);
    for (int32_t i = 0; i < pair.room.surface_count; i++) {
        synth_point p, q;
        if (!synth_camera_project(a, pair.room.surfaces[i].corners[0], &p) ||
            !synth_camera_project(b, pair.room.surfaces[i].corners[0], &q))
            continue;
        const double x[3] = {(p.x - 0.5 * (a->width - 1)) / a->focal, (p.y - 0.5 * (a->height - 1)) / a->focal, 1};
        const double y[3] = {(q.x - 0.5 * (b->width - 1)) / b->focal, (q.y - 0.5 * (b->height - 1)) / b->focal, 1};
        double turned[3], length = 0, triple;
        for (int k = 0; k < 3; k++) {
            turned[k] = r[3 * k] * x[0] + r[3 * k + 1] * x[1] + r[3 * k + 2] * x[2];
            length += turned[k] * turned[k];
        }
        triple = y[0] * (t[1] * turned[2] - t[2] * turned[1]) + y[1] * (t[2] * turned[0] - t[0] * turned[2]) +
                 y[2] * (t[0] * turned[1] - t[1] * turned[0]);
        assert_true(fabs(triple) < 1e-9 * (1 + sqrt(length) * (1 + fabs(y[0]) + fabs(y[1]))));
        seen++;
    }
    assert_true(seen > 20);
    synth_wide_pair_free(&pair);
}

static void pictures_are_in_colour_and_differ(void **state)
{
    (void)state;
    synth_wide_pair pair;
    uint64_t sums[2];
    assert_int_equal(synth_wide_pair_make(&pair, 1), 0);
    const size_t count = (size_t)SYNTH_WIDE_WIDTH * SYNTH_WIDE_HEIGHT;
    for (int v = 0; v < 2; v++) {
        uint8_t *pixels = synth_wide_picture(&pair, v), *again = synth_wide_picture(&pair, v);
        double mean[3] = {0, 0, 0}, difference = 0;
        assert_non_null(pixels);
        assert_non_null(again);
        assert_memory_equal(pixels, again, 3 * count);
        for (size_t i = 0; i < count; i++) {
            for (int c = 0; c < 3; c++)
                mean[c] += (double)pixels[3 * i + (size_t)c] / (double)count;
            difference += abs(pixels[3 * i] - pixels[3 * i + 2]) / (double)count;
        }
        assert_true(mean[0] > 10 && mean[0] < 250 && difference > 2);
        sums[v] = synth_checksum(pixels, 3 * count);
        free(pixels);
        free(again);
    }
    assert_true(sums[0] != sums[1]);
    synth_wide_pair_free(&pair);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_are_what_they_promise),
        cmocka_unit_test(near_pairs_are_what_they_promise),
        cmocka_unit_test(turned_pairs_are_what_they_promise),
        cmocka_unit_test(a_seed_is_one_room_everywhere),
        cmocka_unit_test(the_pose_is_that_of_the_cameras),
        cmocka_unit_test(pictures_are_in_colour_and_differ),
    };
    return cmocka_run_group_tests_name("wide pairs", tests, NULL, NULL);
}
