/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: the junction-ness that the paper's search maximises against its definition, line fits over whole branches, validation. */
#include "detect/refine.h"
#include "detect/nfa.h"
#include "detect/gradient.h"
#include "detect/strip.h"
#include "detect/validate.h"
#include "detect/search.h"
#include "parallelogram.h"

#include <asj/asj.h>

typedef unit_fixture fixture;

static int set_up(void **state)
{
    return set_up_parallelogram(state, 160);
}

static int reset(void **state)
{
    asj_detect_options_init(&((fixture *)*state)->options);
    return 0;
}

static asj_hypothesis corner_hypothesis(double x, double y, double turn)
{
    asj_hypothesis hypothesis;
    memset(&hypothesis, 0, sizeof hypothesis);
    hypothesis.x = hypothesis.x0 = x;
    hypothesis.y = hypothesis.y0 = y;
    hypothesis.radius = 10;
    hypothesis.branch_count = 2;
    for (int i = 0; i < 2; i++) {
        hypothesis.branches[i].angle = angles[i] + turn;
        hypothesis.branches[i].length = sides[i];
        hypothesis.branches[i].offset_variance = hypothesis.branches[i].angle_variance = 0.01;
        hypothesis.branches[i].strength = 5;
    }
    return hypothesis;
}

/* ---- search ---- */

/* (omega - J mu) / (sigma sqrt J) of the sector of radius r around theta, pixels outside the image left out. */
static double naive_strength(const asj_frame *frame, int32_t px, int32_t py, double theta, double r, double tau)
{
    double omega = 0, count = 0;
    for (int32_t y = 0; y < frame->height; y++)
        for (int32_t x = 0; x < frame->width; x++) {
            const double alpha = atan2(y - py, x - px), distance = hypot(x - px, y - py);
            if (distance > 0 && distance <= r && unit_turn(alpha, theta) <= tau / r) {
                omega += unit_gamma(unit_gx(frame, x, y), unit_gy(frame, x, y), alpha);
                count++;
            }
        }
    return count > 0 ? (omega - count * ASJ_GAMMA_MEAN) / (ASJ_GAMMA_SD * sqrt(count)) : 0;
}

/* Pixels on a sector's edge may fall either way. */
static void test_sector_strength(void **state)
{
    const fixture *f = *state;
    static const double lengths[] = {3, 5, 7.5, 12, 30, 45};
    for (size_t n = 0; n < UNIT_COUNT(lengths); n++)
        for (int k = 0; k < 36; k++) {
            const double angle = k * UNIT_PI / 18 + 0.013, tau = 1 + k % 3;
            unit_near("strength", lengths[n], k, asj_search_strength(&f->frame, 60, 60, angle, lengths[n], tau),
                      naive_strength(&f->frame, 60, 60, angle, lengths[n], tau), 0.02);
        }
}

/* ---- line fits ---- */

/* From half a pixel and two degrees off: the corner to 0.15 px, its sides to a quarter of a degree. */
static void test_line_fit(void **state)
{
    const fixture *f = *state;
    for (int n = 0; n < 16; n++) {
        asj_hypothesis hypothesis = corner_hypothesis(corner_x + 0.5 * cos(n), corner_y + 0.5 * sin(n), n % 2 ? 0.035 : -0.035);
        asj_refine(f->context, &f->frame, &f->options, &hypothesis);
        asj_refine(f->context, &f->frame, &f->options, &hypothesis); /* as the pipeline does */
        unit_near("distance", n, 0, hypot(hypothesis.x - corner_x, hypothesis.y - corner_y), 0, 0.15);
        for (int b = 0; b < 2; b++)
            unit_near("angle", n, b, unit_turn(hypothesis.branches[b].angle, angles[b]), 0, 0.25 * UNIT_PI / 180);
    }
}

/* The quick fits find the sides to half a degree, and do not touch lengths. */
static void test_orient(void **state)
{
    const fixture *f = *state;
    for (int n = 0; n < 16; n++) {
        asj_hypothesis hypothesis = corner_hypothesis(corner_x + 0.5 * cos(n), corner_y + 0.5 * sin(n), n % 2 ? 0.035 : -0.035);
        asj_orient(f->context, &f->frame, &f->options, &hypothesis);
        unit_near("distance", n, 0, hypot(hypothesis.x - corner_x, hypothesis.y - corner_y), 0, 0.3);
        for (int b = 0; b < 2; b++) {
            unit_near("angle", n, b, unit_turn(hypothesis.branches[b].angle, angles[b]), 0, 0.5 * UNIT_PI / 180);
            assert_true(hypothesis.branches[b].length == sides[b]);
        }
    }
}

/* A faint panel, and a dark handle beside the farther part of one of its edges: where that edge points, in degrees off. -1: the
 * corner is not found. */
static double pulled_by(asj_context *context, double turn, double beside)
{
    enum { SIDE = 220 };
    const double ux = cos(turn), uy = sin(turn), x = 110.3 - 45 * (ux - uy), y = 109.6 - 45 * (uy + ux);
    asj_detection *found = NULL;
    synth_scene scene;
    double off = -1;
    synth_scene_init(&scene, SIDE, SIDE, 170);
    synth_add_rectangle(&scene, (synth_point){x, y}, 110, 90, turn, 185);
    synth_add_rectangle(&scene, (synth_point){x + 42 * ux + (beside + 5) * uy, y + 42 * uy - (beside + 5) * ux}, 40, 5, turn, 60);
    uint8_t *pixels = unit_picture(&scene, 0.9, 2, 1);
    const asj_image image = unit_gray8(pixels, SIDE, SIDE);
    assert_int_equal(asj_detect(context, &image, NULL, &found), ASJ_OK);
    for (uint32_t i = 0; i < found->junction_count; i++) {
        const asj_junction *j = &found->junctions[i];
        if (hypot((double)j->x + 0.5 - x, (double)j->y + 0.5 - y) > 1.5)
            continue;
        for (int32_t b = 0; b < j->branch_count; b++) {
            const double angle = unit_turn((double)j->branches[b].angle, turn) * 180 / UNIT_PI;
            off = angle < 20 ? angle : off;
        }
    }
    asj_detection_free(&found);
    free(pixels);
    return off;
}

/* Handles 2 to 4 px beside the edge pull lines over by up to 3 degrees: where the whole line is believed, 91 of 108. */
static void test_pulled(void **state)
{
    fixture *f = *state;
    int right = 0, all = 0;
    for (int n = 0; n < 36; n++)
        for (double beside = 2; beside <= 4; beside += 1, all++) {
            const double off = pulled_by(f->context, n * UNIT_PI / 18 + 0.05, beside);
            right += off >= 0 && off <= 1;
        }
    printf("of %d edges with a handle beside them %d to a degree\n", all, right);
    assert_true(right >= all * 0.9);
}

/* ---- validation ---- */

/* Before the scan: what no length makes meaningful goes, and with it a junction that has no other opening. */
static void test_reject_early(void **state)
{
    fixture *f = *state;
    asj_hypothesis hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    asj_reject_early(f->context, &f->frame, &f->options, &hypothesis);
    assert_int_equal(hypothesis.branch_count, 2);
    hypothesis.branches[2] = hypothesis.branches[0];
    hypothesis.branches[2].angle += UNIT_PI; /* into the flat part */
    hypothesis.branch_count = 3;
    asj_reject_early(f->context, &f->frame, &f->options, &hypothesis);
    assert_int_equal(hypothesis.branch_count, 2);
    hypothesis.branches[0].angle += UNIT_PI;
    asj_reject_early(f->context, &f->frame, &f->options, &hypothesis);
    assert_int_equal(hypothesis.branch_count, 0);
    hypothesis = corner_hypothesis(corner_x, corner_y, UNIT_PI);
    f->options.strip_test = 0; /* nothing is asked of strips */
    asj_reject_early(f->context, &f->frame, &f->options, &hypothesis);
    assert_int_equal(hypothesis.branch_count, 2);
    asj_detect_options_init(&f->options);
}

static int32_t validated(const fixture *f, asj_hypothesis *hypothesis)
{
    asj_validate(f->context, &f->frame, &f->options, hypothesis);
    return hypothesis->branch_count;
}

/* A place that is most uncertain and far from where it was seen is none, though both branches are meaningful; not where strips do
 * not judge. How much is asked: test_steady.c. */
static void test_uncertain(void **state)
{
    fixture *f = *state;
    asj_hypothesis corner = corner_hypothesis(corner_x, corner_y, 0);
    corner.location_variance = 0.1;
    assert_int_equal(validated(f, &corner), 2);
    corner = corner_hypothesis(corner_x, corner_y, 0);
    for (int b = 0; b < 2; b++)
        corner.branches[b].length = 10;
    corner.x0 += 4;
    corner.location_variance = 4;
    asj_hypothesis unjudged = corner;
    f->frame.octave = 1;
    assert_int_equal(validated(f, &corner), 0);
    f->options.strip_test = 0;
    assert_int_equal(validated(f, &unjudged), 2);
    f->frame.octave = 0;
}

static void test_good_corner(void **state)
{
    const fixture *f = *state;
    asj_hypothesis hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    assert_int_equal(validated(f, &hypothesis), 2);
    for (int b = 0; b < 2; b++) {
        const asj_strip_line line = {corner_x, corner_y, angles[b], sides[b]};
        const asj_strip strip = asj_strip_test(f->context, &f->frame, &f->options, &line);
        assert_true(hypothesis.branches[b].log_nfa == strip.log_nfa && strip.log_nfa < -50);
    }
}

static void test_dropped_branches(void **state)
{
    fixture *f = *state;
    f->options.minimum_length = 7;
    asj_hypothesis hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    hypothesis.branches[1].length = f->options.minimum_length - 0.1; /* short: no second branch left */
    assert_int_equal(validated(f, &hypothesis), 0);
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    hypothesis.branches[0].length = f->options.minimum_length + 0.1;
    assert_int_equal(validated(f, &hypothesis), 2);
    f->options.minimum_length = 0;
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    hypothesis.branches[0].offset = 2.1; /* belongs to something else */
    assert_int_equal(validated(f, &hypothesis), 0);
    hypothesis.branches[0].offset = -2.1;
    hypothesis.branch_count = 2;
    assert_int_equal(validated(f, &hypothesis), 0);
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    hypothesis.x0 += 2 * f->options.max_move + 0.1; /* seen somewhere else */
    assert_int_equal(validated(f, &hypothesis), 0);
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    hypothesis.x0 += 2 * f->options.max_move - 0.1;
    assert_int_equal(validated(f, &hypothesis), 2);
    hypothesis = corner_hypothesis(corner_x, corner_y, UNIT_PI); /* into the flat part: not meaningful */
    assert_int_equal(validated(f, &hypothesis), 0);
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    f->options.epsilon = 1e-30;
    hypothesis.branches[0].length = 9; /* too short to be so meaningful */
    assert_int_equal(validated(f, &hypothesis), 0);
    f->options.strip_test = 0;
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    hypothesis.branches[0].length = 9;
    assert_int_equal(validated(f, &hypothesis), 2);
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    hypothesis.branches[0].length = 0; /* never scanned */
    f->options.minimum_length = 0;
    assert_int_equal(validated(f, &hypothesis), 0);
}

/* Of two branches closer than merge_angle the more meaningful stays, whichever comes first. */
static void test_merge(void **state)
{
    const fixture *f = *state;
    for (int twin_first = 0; twin_first < 2; twin_first++) {
        asj_hypothesis hypothesis = corner_hypothesis(corner_x, corner_y, 0);
        asj_hypothesis_branch twin = hypothesis.branches[0];
        twin.angle += 0.12;
        hypothesis.branch_count = 3;
        hypothesis.branches[2] = twin_first ? hypothesis.branches[0] : twin;
        if (twin_first)
            hypothesis.branches[0] = twin;
        assert_int_equal(validated(f, &hypothesis), 2);
        assert_true(hypothesis.branches[0].angle == angles[0] && hypothesis.branches[1].angle == angles[1]);
    }
}

static void test_order_and_opening(void **state)
{
    fixture *f = *state;
    asj_hypothesis hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    const asj_hypothesis_branch first = hypothesis.branches[0];
    hypothesis.branches[0] = hypothesis.branches[1];
    hypothesis.branches[1] = first;
    assert_int_equal(validated(f, &hypothesis), 2);
    assert_true(hypothesis.branches[0].angle < hypothesis.branches[1].angle);
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    f->options.minimum_opening = 80; /* they open by 80.2 degrees */
    assert_int_equal(validated(f, &hypothesis), 2);
    hypothesis = corner_hypothesis(corner_x, corner_y, 0);
    hypothesis.branches[1].angle -= 0.02;
    assert_int_equal(validated(f, &hypothesis), 0);
}

/* Weak branches of a coarse octave are meaningful together: either by itself nearly so, and both by a hundred times more than their
 * place asks for. One alone makes no junction, whatever may open, and in the image itself there are no such pairs. */
static void test_pairs(void **state)
{
    fixture *f = *state;
    const double places = log(SIZE * SIZE);
    int together = 0, apart = 0;
    f->options.minimum_length = f->options.minimum_opening = f->options.max_tilt = 0;
    for (int n = 0; n < 400; n++) {
        const double log_epsilon = n % 7, limit = log_epsilon + places - 2 * log(10); /* of one octave */
        asj_hypothesis hypothesis = corner_hypothesis(corner_x, corner_y, 0);
        double above[2];
        for (int b = 0; b < 2; b++) {
            asj_hypothesis_branch *branch = &hypothesis.branches[b];
            branch->length = 3 + 0.25 * (b ? n / 20 : n % 20);
            const asj_strip_line line = {corner_x, corner_y, branch->angle, branch->length};
            above[b] = asj_strip_test(f->context, &f->frame, &f->options, &line).log_nfa - log_epsilon;
        }
        asj_hypothesis alone = hypothesis, fine = hypothesis;
        alone.branch_count = 1;
        f->options.epsilon = exp(log_epsilon);
        const double worst = fmax(above[0], above[1]), both = above[0] + above[1] + 2 * log_epsilon;
        const int by_themselves = worst <= 0, near = worst <= 0.5 * places, pair = near && both <= limit;
        assert_int_equal(validated(f, &fine), by_themselves ? 2 : 0);
        f->frame.octave = 1;
        const int32_t kept = validated(f, &hypothesis), one = validated(f, &alone);
        f->frame.octave = 0;
        assert_int_equal(kept, by_themselves || pair ? 2 : 0);
        assert_int_equal(one, 0);
        together += pair && !by_themselves;
        apart += near && !pair && !by_themselves;
    }
    assert_true(together > 50 && apart > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_sector_strength, reset), cmocka_unit_test_setup(test_line_fit, reset),
        cmocka_unit_test_setup(test_pulled, reset),           cmocka_unit_test_setup(test_pairs, reset),
        cmocka_unit_test_setup(test_orient, reset),           cmocka_unit_test_setup(test_reject_early, reset),
        cmocka_unit_test_setup(test_uncertain, reset),
        cmocka_unit_test_setup(test_good_corner, reset),      cmocka_unit_test_setup(test_dropped_branches, reset),
        cmocka_unit_test_setup(test_merge, reset),            cmocka_unit_test_setup(test_order_and_opening, reset),
    };
    return cmocka_run_group_tests(tests, set_up, unit_tear_down);
}
