/* SPDX-License-Identifier: BSD-2-Clause */
/* Locations: meeting points, what is rejected, suppression. */
#include "detect/locate.h"
#include "unit_test.h"

#include <string.h>

enum { SIZE = 81 };

typedef unit_fixture fixture;

static void locate(const fixture *f, const asj_frame *frame, asj_hypothesis *hypothesis)
{
    asj_locate_guess(f->context, frame, &f->options, NULL, hypothesis);
    asj_locate(f->context, frame, &f->options, hypothesis);
}

/* ---- meeting points ---- */

static asj_hypothesis hypothesis_at(double x, double y, int32_t count, const double *angles, const double *offsets,
                                    const double *variances)
{
    asj_hypothesis hypothesis;
    memset(&hypothesis, 0, sizeof hypothesis);
    hypothesis.x = hypothesis.x0 = x;
    hypothesis.y = hypothesis.y0 = y;
    hypothesis.branch_count = count;
    for (int32_t i = 0; i < count; i++) {
        hypothesis.branches[i].angle = angles[i];
        hypothesis.branches[i].offset = offsets[i];
        hypothesis.branches[i].offset_variance = variances[i];
    }
    return hypothesis;
}

/* sum of (distance to line i)^2 / v_i, for lines given at (x0, y0) */
static double cost(const asj_hypothesis *given, double x, double y)
{
    double sum = 0;
    for (int32_t i = 0; i < given->branch_count; i++) {
        const asj_hypothesis_branch *b = &given->branches[i];
        const double off = -sin(b->angle) * (x - given->x) + cos(b->angle) * (y - given->y) - b->offset;
        sum += off * off / b->offset_variance;
    }
    return sum;
}

static int meet(int32_t octave, asj_hypothesis *hypothesis)
{
    asj_frame frame;
    asj_detect_options options;
    memset(&frame, 0, sizeof frame);
    frame.octave = octave;
    asj_detect_options_init(&options);
    return asj_locate_meet(&frame, &options, hypothesis);
}

/* No place around has a smaller cost, the offsets are those from the new place, and the variance that of the cost's curvature. */
static void test_meet(void **state)
{
    synth_random random;
    int met = 0;
    (void)state;
    synth_random_seed(&random, 8);
    for (int n = 0; n < 2000; n++) {
        double angles[5], offsets[5], variances[5];
        for (int i = 0; i < 5; i++) {
            angles[i] = synth_random_between(&random, 0, 2 * UNIT_PI);
            offsets[i] = synth_random_between(&random, -2, 2);
            variances[i] = pow(10, synth_random_between(&random, -3, 0));
        }
        const asj_hypothesis given = hypothesis_at(40.5, 31.25, 2 + n % 4, angles, offsets, variances);
        asj_hypothesis hypothesis = given;
        if (!meet(1, &hypothesis)) {
            assert_memory_equal(&hypothesis, &given, sizeof hypothesis);
            continue;
        }
        met++;
        const double least = cost(&given, hypothesis.x, hypothesis.y), h = 1e-3;
        for (int k = 0; k < 8; k++)
            assert_true(cost(&given, hypothesis.x + h * cos(k * UNIT_PI / 4), hypothesis.y + h * sin(k * UNIT_PI / 4)) >= least);
        for (int32_t i = 0; i < given.branch_count; i++) {
            const asj_hypothesis_branch *b = &given.branches[i];
            unit_near("offset", n, i, hypothesis.branches[i].offset,
                      b->offset + sin(b->angle) * (hypothesis.x - given.x) - cos(b->angle) * (hypothesis.y - given.y), 1e-9);
            assert_true(hypothesis.branches[i].angle == b->angle);
        }
        const double x = hypothesis.x, y = hypothesis.y;
        const double xx = (cost(&given, x + 1, y) - 2 * least + cost(&given, x - 1, y)) / 2;
        const double yy = (cost(&given, x, y + 1) - 2 * least + cost(&given, x, y - 1)) / 2;
        const double xy = (cost(&given, hypothesis.x + 1, hypothesis.y + 1) - cost(&given, hypothesis.x + 1, hypothesis.y - 1) -
                           cost(&given, hypothesis.x - 1, hypothesis.y + 1) + cost(&given, hypothesis.x - 1, hypothesis.y - 1)) / 8;
        unit_near("variance", n, 0, hypothesis.location_variance / ((xx + yy) / (2 * (xx * yy - xy * xy))), 1, 1e-6);
    }
    assert_in_range(met, 1000, 2000);
}

static void test_parallel(void **state)
{
    static const double offsets[2] = {1, -1}, variances[2] = {0.01, 0.01};
    (void)state;
    for (double turn = 0; turn < UNIT_PI; turn += 0.01) {
        const double angles[2] = {0.4, 0.4 + turn};
        asj_hypothesis hypothesis = hypothesis_at(10, 10, 2, angles, offsets, variances);
        const int meets = meet(1, &hypothesis);
        /* det > 0.02 total^2, equal weights: sin^2(turn) / 4 > 0.02 */
        if (fabs(sin(turn) * sin(turn) / 4 - 0.02) > 1e-6)
            assert_int_equal(meets, sin(turn) * sin(turn) / 4 > 0.02);
    }
    asj_hypothesis one = hypothesis_at(10, 10, 1, offsets, offsets, variances);
    asj_hypothesis none = hypothesis_at(10, 10, 0, offsets, offsets, variances);
    assert_false(meet(1, &one));
    assert_false(meet(1, &none));
}

/* A clear edge and a faint one at a right angle: in the image itself they meet. */
static void test_clear_and_faint(void **state)
{
    static const double angles[2] = {0.4, 0.4 + UNIT_PI / 2}, offsets[2] = {1, -1}, variances[2] = {0.001, 0.06};
    asj_hypothesis hypothesis = hypothesis_at(10, 10, 2, angles, offsets, variances);
    (void)state;
    assert_false(meet(1, &hypothesis));
    assert_true(meet(0, &hypothesis));
    unit_near("distance", 0, 0, hypot(hypothesis.x - 10, hypothesis.y - 10), sqrt(2), 1e-9);
}

/* ---- from isotropic junctions ---- */

static asj_isotropic_junction isotropic_at(int x, int y, int count, const double *angles)
{
    asj_isotropic_junction junction;
    memset(&junction, 0, sizeof junction);
    junction.x = (uint16_t)x;
    junction.y = (uint16_t)y;
    junction.radius = 7;
    junction.branch_count = (uint16_t)count;
    junction.log_nfa = -12.5;
    for (int i = 0; i < count; i++) {
        junction.angle[i] = (uint16_t)lrint(angles[i] * 32768 / UNIT_PI);
        junction.strength[i] = (uint16_t)(1000 + i);
    }
    return junction;
}

static void test_start(void **state)
{
    static const double angles[3] = {0.5, 2.5, 6.2};
    const asj_isotropic_junction junction = isotropic_at(12, 34, 3, angles);
    asj_hypothesis hypothesis;
    (void)state;
    memset(&hypothesis, 0xff, sizeof hypothesis);
    asj_hypothesis_start(&junction, &hypothesis);
    assert_true(hypothesis.x == 12 && hypothesis.y == 34 && hypothesis.x0 == 12 && hypothesis.y0 == 34);
    assert_true(hypothesis.radius == 7 && hypothesis.log_nfa == -12.5);
    assert_int_equal(hypothesis.branch_count, 3);
    for (int i = 0; i < 3; i++) {
        unit_near("angle", i, 0, hypothesis.branches[i].angle, angles[i], 1e-4);
        unit_near("strength", i, 0, hypothesis.branches[i].strength, (1000 + i) / 256.0, 0);
        assert_true(hypothesis.branches[i].length == 0 && hypothesis.branches[i].offset == 0);
    }
}

/* The same question as asj_hypothesis_has_opening(), in whole numbers. */
static void test_isotropic_opening(void **state)
{
    fixture *f = *state;
    int open = 0;
    synth_random random;
    synth_random_seed(&random, 21);
    for (int n = 0; n < 2000; n++) {
        const double start = synth_random_between(&random, 0, 6), turn = synth_random_between(&random, 0, UNIT_PI);
        const double angles[3] = {start, fmod(start + turn, 2 * UNIT_PI), fmod(start + UNIT_PI, 2 * UNIT_PI)};
        const asj_isotropic_junction junction = isotropic_at(40, 40, 2 + n % 2, angles);
        asj_hypothesis hypothesis;
        f->options.minimum_opening = n % 80;
        asj_hypothesis_start(&junction, &hypothesis);
        const int opens = asj_hypothesis_has_opening(&hypothesis, f->options.minimum_opening * UNIT_PI / 180);
        assert_int_equal(asj_isotropic_has_opening(&f->options, &junction), opens);
        open += opens;
    }
    assert_in_range(open, 500, 1500);
    asj_detect_options_init(&f->options);
}

/* A corner of 90 degrees or more, seen from pixels up to a pixel away: its own place to half a pixel. (In sharper ones the two
 * edges bend each other's first fit; the fit over the length mends that.) */
static void test_corners(void **state)
{
    const fixture *f = *state;
    for (int n = 0; n < 40; n++) {
        const double angle = 0.157 * n, opening = (90 + n % 4 * 10) * UNIT_PI / 180, px = 40.3 + 0.07 * (n % 7),
            py = 40.6 - 0.09 * (n % 5);
        const double angles[2] = {angle, angle + opening}, grays[2] = {170, -1};
        synth_scene scene;
        asj_frame frame;
        synth_scene_init(&scene, SIZE, SIZE, 100);
        synth_add_star(&scene, (synth_point){px, py}, angles, grays, 2, 35);
        unit_frame_of(f->context, &scene, 1, 0, NULL, &frame);
        const double seen[2] = {fmod(angle + 0.05, 2 * UNIT_PI), fmod(angle + opening - 0.05, 2 * UNIT_PI)};
        for (int k = 0; k < 4; k++) {
            asj_isotropic_junction junction = isotropic_at(40 + k % 2, 40 + k / 2, 2, seen);
            asj_hypothesis hypothesis;
            asj_hypothesis_start(&junction, &hypothesis);
            locate(f, &frame, &hypothesis);
            assert_int_equal(hypothesis.branch_count, 2);
            unit_near("distance", n, k, hypot(hypothesis.x - px, hypothesis.y - py), 0, 0.5);
            unit_near("angle", n, k, unit_turn(hypothesis.branches[0].angle, angle), 0, 0.06);
            unit_near("angle", n, k, unit_turn(hypothesis.branches[1].angle, angle + opening), 0, 0.06);
            assert_true(hypothesis.location_variance > 0);
        }
        asj_frame_free(&f->context->memory, &frame);
    }
}

/* What a thick or bent edge looks like to the isotropic test: two branches that both turn onto the one edge. */
static void test_edges_are_rejected(void **state)
{
    const fixture *f = *state;
    for (int n = 0; n < 24; n++) {
        const double angle = n * UNIT_PI / 12 + 0.04, bend = 0.3 * (n % 2 ? 1 : -1);
        const double seen[2] = {fmod(angle + bend, 2 * UNIT_PI), fmod(angle + UNIT_PI, 2 * UNIT_PI)};
        synth_scene scene;
        asj_frame frame;
        unit_half_plane(&scene, SIZE, (synth_point){40, 40}, angle, 90, 160);
        unit_frame_of(f->context, &scene, 1.5, 0, NULL, &frame);
        asj_isotropic_junction junction = isotropic_at(40, 40, 2, seen);
        asj_hypothesis hypothesis;
        asj_hypothesis_start(&junction, &hypothesis);
        locate(f, &frame, &hypothesis);
        assert_int_equal(hypothesis.branch_count, 0);
        asj_frame_free(&f->context->memory, &frame);
    }
}

/* A corner farther away than max_move is another junction's business. */
static void test_max_move(void **state)
{
    fixture *f = *state;
    const double angles[2] = {0, UNIT_PI / 2}, grays[2] = {170, -1};
    synth_scene scene;
    asj_frame frame;
    synth_scene_init(&scene, SIZE, SIZE, 100);
    synth_add_star(&scene, (synth_point){40, 40}, angles, grays, 2, 35);
    unit_frame_of(f->context, &scene, 1, 0, NULL, &frame);
    for (int away = 0; away <= 3; away++)
        for (double most = 0.5; most < 5; most += 0.5) {
            asj_isotropic_junction junction = isotropic_at(40 + away, 40, 2, angles);
            asj_hypothesis hypothesis;
            f->options.max_move = most;
            asj_hypothesis_start(&junction, &hypothesis);
            locate(f, &frame, &hypothesis);
            if (away < most - 0.3)
                assert_int_equal(hypothesis.branch_count, 2);
            if (away > most + 0.3)
                assert_int_equal(hypothesis.branch_count, 0);
        }
    asj_detect_options_init(&f->options);
    asj_frame_free(&f->context->memory, &frame);
}

/* refinement = search: whole pixels and the branches as found, unless no two open. */
static void test_search_keeps_pixels(void **state)
{
    fixture *f = *state;
    static const double open[2] = {0.2, 1.7}, straight[2] = {0.2, 0.2 + UNIT_PI};
    synth_scene scene;
    asj_frame frame;
    asj_hypothesis hypothesis;
    f->options.refinement = ASJ_REFINE_SEARCH;
    synth_scene_init(&scene, SIZE, SIZE, 100);
    unit_frame_of(f->context, &scene, 1, 0, NULL, &frame);
    asj_isotropic_junction junction = isotropic_at(40, 41, 2, open);
    asj_hypothesis_start(&junction, &hypothesis);
    locate(f, &frame, &hypothesis);
    assert_int_equal(hypothesis.branch_count, 2);
    assert_true(hypothesis.x == 40 && hypothesis.y == 41);
    junction = isotropic_at(40, 41, 2, straight);
    assert_false(asj_isotropic_has_opening(&f->options, &junction));
    asj_frame_free(&f->context->memory, &frame);
    asj_detect_options_init(&f->options);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_meet),
        cmocka_unit_test(test_parallel),
        cmocka_unit_test(test_clear_and_faint),
        cmocka_unit_test(test_start),
        cmocka_unit_test(test_isotropic_opening),
        cmocka_unit_test(test_corners),
        cmocka_unit_test(test_edges_are_rejected),
        cmocka_unit_test(test_max_move),
        cmocka_unit_test(test_search_keeps_pixels),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
