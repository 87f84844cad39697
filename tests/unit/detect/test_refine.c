/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5: the paper's search against brute force on the definition, line fits over whole branches, validation. */
#include "detect/refine.h"
#include "detect/nfa.h"
#include "detect/gradient.h"
#include "detect/strip.h"
#include "unit_test.h"

enum { SIZE = 121 };

typedef struct fixture {
    unit_counter counter;
    asj_context *context;
    asj_detect_options options;
    asj_frame frame; /* a corner at (60.3, 59.6), sides of 45 and 38 px, at 0.3 and 1.7 rad */
} fixture;

static const double corner_x = 60.3, corner_y = 59.6, sides[2] = {45, 38}, angles[2] = {0.3, 1.7};

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    synth_scene scene;
    *state = f;
    if (!f)
        return -1;
    f->context = unit_context(&f->counter, 1);
    asj_detect_options_init(&f->options);
    synth_scene_init(&scene, SIZE, SIZE, 90);
    const double ax = sides[0] * cos(angles[0]), ay = sides[0] * sin(angles[0]);
    const double bx = sides[1] * cos(angles[1]), by = sides[1] * sin(angles[1]);
    const synth_point corners[4] = {{corner_x, corner_y}, {corner_x + ax, corner_y + ay}, {corner_x + ax + bx, corner_y + ay + by},
                                    {corner_x + bx, corner_y + by}};
    synth_scene_add(&scene, corners, 4, synth_flat(160), 0);
    unit_frame_of(f->context, &scene, 1, 2, NULL, &f->frame);
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    asj_frame_free(&f->context->memory, &f->frame);
    asj_context_free(&f->context);
    const int leaked = f->counter.live != 0;
    free(f);
    return leaked;
}

static int reset(void **state)
{
    asj_detect_options_init(&((fixture *)*state)->options);
    return 0;
}

static asj_draft corner_draft(double x, double y, double turn)
{
    asj_draft draft;
    memset(&draft, 0, sizeof draft);
    draft.x = draft.x0 = x;
    draft.y = draft.y0 = y;
    draft.radius = 10;
    draft.branch_count = 2;
    for (int i = 0; i < 2; i++) {
        draft.branches[i].angle = angles[i] + turn;
        draft.branches[i].length = sides[i];
        draft.branches[i].offset_variance = draft.branches[i].angle_variance = 0.01;
        draft.branches[i].strength = 5;
    }
    return draft;
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

/* The angle found is as good as the best of all in +-0.1 rad; pixels on a sector's edge may fall either way. */
static void test_search(void **state)
{
    fixture *f = *state;
    static const double lengths[] = {3, 5, 7.5, 12, 30, 45};
    f->options.refinement = ASJ_REFINE_SEARCH;
    for (size_t n = 0; n < UNIT_COUNT(lengths); n++)
        for (int k = 0; k < 6; k++) {
            static const double turns[6] = {0.05, -0.08, 0, UNIT_PI / 2, UNIT_PI, 3.9};
            asj_draft draft = corner_draft(60, 60, turns[k]), before = draft;
            draft.branches[0].length = draft.branches[1].length = lengths[n];
            f->options.sector_width = 1 + k % 3;
            asj_refine(f->context, &f->frame, &f->options, &draft);
            assert_true(draft.x == 60 && draft.y == 60);
            for (int b = 0; b < 2; b++) {
                const double start = before.branches[b].angle, tau = f->options.sector_width;
                double best = -HUGE_VAL;
                for (int step = -20; step <= 20; step++)
                    best = fmax(best, naive_strength(&f->frame, 60, 60, start + 0.005 * step, lengths[n], tau));
                assert_true(unit_turn(draft.branches[b].angle, start) <= 0.1 + 1e-9);
                unit_near("strength", lengths[n], k, naive_strength(&f->frame, 60, 60, draft.branches[b].angle, lengths[n], tau),
                          best, 0.02);
            }
        }
}

/* ---- line fits ---- */

/* From half a pixel and two degrees off: the corner to 0.15 px, its sides to a quarter of a degree. */
static void test_line_fit(void **state)
{
    const fixture *f = *state;
    for (int n = 0; n < 16; n++) {
        asj_draft draft = corner_draft(corner_x + 0.5 * cos(n), corner_y + 0.5 * sin(n), n % 2 ? 0.035 : -0.035);
        asj_refine(f->context, &f->frame, &f->options, &draft);
        asj_refine(f->context, &f->frame, &f->options, &draft); /* as the pipeline does */
        unit_near("distance", n, 0, hypot(draft.x - corner_x, draft.y - corner_y), 0, 0.15);
        for (int b = 0; b < 2; b++)
            unit_near("angle", n, b, unit_turn(draft.branches[b].angle, angles[b]), 0, 0.25 * UNIT_PI / 180);
    }
}

/* The quick fits find the sides to half a degree, and do not touch lengths. */
static void test_orient(void **state)
{
    const fixture *f = *state;
    for (int n = 0; n < 16; n++) {
        asj_draft draft = corner_draft(corner_x + 0.5 * cos(n), corner_y + 0.5 * sin(n), n % 2 ? 0.035 : -0.035);
        asj_orient(f->context, &f->frame, &f->options, &draft);
        unit_near("distance", n, 0, hypot(draft.x - corner_x, draft.y - corner_y), 0, 0.3);
        for (int b = 0; b < 2; b++) {
            unit_near("angle", n, b, unit_turn(draft.branches[b].angle, angles[b]), 0, 0.5 * UNIT_PI / 180);
            assert_true(draft.branches[b].length == sides[b]);
        }
    }
}

/* ---- validation ---- */

/* Before the scan: what no length makes meaningful goes, and with it a junction that has no other opening. */
static void test_foresee(void **state)
{
    fixture *f = *state;
    asj_draft draft = corner_draft(corner_x, corner_y, 0);
    asj_foresee(f->context, &f->frame, &f->options, &draft);
    assert_int_equal(draft.branch_count, 2);
    draft.branches[2] = draft.branches[0];
    draft.branches[2].angle += UNIT_PI; /* into the flat part */
    draft.branch_count = 3;
    asj_foresee(f->context, &f->frame, &f->options, &draft);
    assert_int_equal(draft.branch_count, 2);
    draft.branches[0].angle += UNIT_PI;
    asj_foresee(f->context, &f->frame, &f->options, &draft);
    assert_int_equal(draft.branch_count, 0);
    draft = corner_draft(corner_x, corner_y, UNIT_PI);
    f->options.strip_test = 0; /* nothing is asked of strips */
    asj_foresee(f->context, &f->frame, &f->options, &draft);
    assert_int_equal(draft.branch_count, 2);
    asj_detect_options_init(&f->options);
}

static int32_t validated(const fixture *f, asj_draft *draft)
{
    asj_validate(f->context, &f->frame, &f->options, draft);
    return draft->branch_count;
}

static void test_good_corner(void **state)
{
    const fixture *f = *state;
    asj_draft draft = corner_draft(corner_x, corner_y, 0);
    assert_int_equal(validated(f, &draft), 2);
    for (int b = 0; b < 2; b++) {
        const asj_strip strip = asj_strip_test(f->context, &f->frame, &f->options, corner_x, corner_y, angles[b], sides[b]);
        assert_true(draft.branches[b].log_nfa == strip.log_nfa && strip.log_nfa < -50);
    }
}

static void test_dropped_branches(void **state)
{
    fixture *f = *state;
    f->options.minimum_length = 7;
    asj_draft draft = corner_draft(corner_x, corner_y, 0);
    draft.branches[1].length = f->options.minimum_length - 0.1; /* short: no second branch left */
    assert_int_equal(validated(f, &draft), 0);
    draft = corner_draft(corner_x, corner_y, 0);
    draft.branches[0].length = f->options.minimum_length + 0.1;
    assert_int_equal(validated(f, &draft), 2);
    f->options.minimum_length = 0;
    draft = corner_draft(corner_x, corner_y, 0);
    draft.branches[0].offset = 2.1; /* belongs to something else */
    assert_int_equal(validated(f, &draft), 0);
    draft.branches[0].offset = -2.1;
    draft.branch_count = 2;
    assert_int_equal(validated(f, &draft), 0);
    draft = corner_draft(corner_x, corner_y, 0);
    draft.x0 += 2 * f->options.max_move + 0.1; /* seen somewhere else */
    assert_int_equal(validated(f, &draft), 0);
    draft = corner_draft(corner_x, corner_y, 0);
    draft.x0 += 2 * f->options.max_move - 0.1;
    assert_int_equal(validated(f, &draft), 2);
    draft = corner_draft(corner_x, corner_y, UNIT_PI); /* into the flat part: not meaningful */
    assert_int_equal(validated(f, &draft), 0);
    draft = corner_draft(corner_x, corner_y, 0);
    f->options.epsilon = 1e-30;
    draft.branches[0].length = 9; /* too short to be so meaningful */
    assert_int_equal(validated(f, &draft), 0);
    f->options.strip_test = 0;
    draft = corner_draft(corner_x, corner_y, 0);
    draft.branches[0].length = 9;
    assert_int_equal(validated(f, &draft), 2);
    draft = corner_draft(corner_x, corner_y, 0);
    draft.branches[0].length = 0; /* never scanned */
    f->options.minimum_length = 0;
    assert_int_equal(validated(f, &draft), 0);
}

/* Of two branches closer than merge_angle the more meaningful stays, whichever comes first. */
static void test_merge(void **state)
{
    const fixture *f = *state;
    for (int twin_first = 0; twin_first < 2; twin_first++) {
        asj_draft draft = corner_draft(corner_x, corner_y, 0);
        asj_draft_branch twin = draft.branches[0];
        twin.angle += 0.12;
        draft.branch_count = 3;
        draft.branches[2] = twin_first ? draft.branches[0] : twin;
        if (twin_first)
            draft.branches[0] = twin;
        assert_int_equal(validated(f, &draft), 2);
        assert_true(draft.branches[0].angle == angles[0] && draft.branches[1].angle == angles[1]);
    }
}

static void test_order_and_opening(void **state)
{
    fixture *f = *state;
    asj_draft draft = corner_draft(corner_x, corner_y, 0);
    const asj_draft_branch first = draft.branches[0];
    draft.branches[0] = draft.branches[1];
    draft.branches[1] = first;
    assert_int_equal(validated(f, &draft), 2);
    assert_true(draft.branches[0].angle < draft.branches[1].angle);
    draft = corner_draft(corner_x, corner_y, 0);
    f->options.minimum_opening = 80; /* they open by 80.2 degrees */
    assert_int_equal(validated(f, &draft), 2);
    draft = corner_draft(corner_x, corner_y, 0);
    draft.branches[1].angle -= 0.02;
    assert_int_equal(validated(f, &draft), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_search, reset),           cmocka_unit_test_setup(test_line_fit, reset),
        cmocka_unit_test_setup(test_orient, reset),           cmocka_unit_test_setup(test_foresee, reset),
        cmocka_unit_test_setup(test_good_corner, reset),      cmocka_unit_test_setup(test_dropped_branches, reset),
        cmocka_unit_test_setup(test_merge, reset),            cmocka_unit_test_setup(test_order_and_opening, reset),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
