/* SPDX-License-Identifier: BSD-2-Clause */
/* Where matches put partners: the rectangles of expected.h, and what lies in them. */
#include "match/expected.h"
#include "unit_test.h"

#include <math.h>

#define MOST 8

/* Two images of 300 x 400 px with L-junctions at given places, each at a location of its own. */
typedef struct scene {
    asj_image_features features[2];
    asj_l_junction l[2][MOST];
    double x[2][MOST], y[2][MOST];
    uint32_t number[MOST + 1];
    asj_match_options options;
    asj_match_run run;
} scene;

static void set(scene *s, asj_context *context, const float (*places)[2], uint32_t count, float by)
{
    memset(s, 0, sizeof *s);
    asj_match_options_init(&s->options);
    s->run = (asj_match_run){.context = context, .options = &s->options, .image = {&s->features[0], &s->features[1]}};
    for (uint32_t n = 0; n <= MOST; n++)
        s->number[n] = n;
    for (int32_t side = 0; side < 2; side++) {
        asj_l_junctions *c = &s->features[side].l_junctions;
        s->features[side].pyramid.width[0] = (int32_t)(300 * by);
        s->features[side].pyramid.height[0] = (int32_t)(400 * by);
        c->count = c->location_count = count;
        c->l = s->l[side];
        c->location_x = s->x[side];
        c->location_y = s->y[side];
        c->first_of_location = c->l_of_location = s->number;
        for (uint32_t n = 0; n < count; n++) {
            c->l[n].x = places[n][0];
            c->l[n].y = places[n][1];
            c->location_x[n] = (double)places[n][0];
            c->location_y[n] = (double)places[n][1];
        }
    }
}

/* x2 = a x1 + 20, y2 = y1 - 10 at (x, y). */
static asj_junction_match match_at(float x, float y, double a)
{
    return (asj_junction_match){.x1 = x, .y1 = y, .x2 = (float)(a * (double)x + 20), .y2 = y - 10,
                                .affine = {a, 0, 20, 0, 1, -10}};
}

/* The L-junctions of matches, as detected: in image 2 a little off where the match has moved them. */
static void stand(const asj_junction_match *matches, uint32_t count, asj_l_junction l1[], asj_l_junction l2[])
{
    for (uint32_t k = 0; k < count; k++) {
        l1[k] = (asj_l_junction){.x = matches[k].x1, .y = matches[k].y1};
        l2[k] = (asj_l_junction){.x = matches[k].x2 + 3, .y = matches[k].y2};
    }
}

static void assert_box(const asj_box *box, double x, double y, double half_width, double half_height)
{
    unit_near("left", x, y, (double)box->left, x - half_width, 1e-3);
    unit_near("right", x, y, (double)box->right, x + half_width, 1e-3);
    unit_near("top", x, y, (double)box->top, y - half_height, 1e-3);
    unit_near("bottom", x, y, (double)box->bottom, y + half_height, 1e-3);
}

/* Of one match: its map's place, +- the reach and 0.3 of the distance, in both directions; in px of images upsampled by 2 and 3. */
static void one_match(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const float places[2][2] = {{100, 50}, {160, 130}};
    const asj_junction_match match = match_at(100, 50, 2);
    asj_l_junction l1, l2;
    const asj_match_result known = {.matches = &match, .match_count = 1, .l_junctions1 = &l1, .l_junctions2 = &l2};
    const asj_stretch same[2] = {{1, 1}, {1, 1}};
    asj_expected expected = {{NULL, NULL}, {NULL, NULL}};
    scene s;
    stand(&match, 1, &l1, &l2);
    set(&s, context, places, 2, 1);
    s.options.upsampled_search_radius = 0.02; /* of a diagonal of 500 px */
    assert_int_equal(asj_expect(&s.run, &known, same, &expected), ASJ_OK);
    assert_box(&expected.boxes[0][0], 220, 40, 10, 10);
    assert_box(&expected.boxes[0][1], 340, 120, 10 + 0.3 * 100, 10 + 0.3 * 100);
    assert_box(&expected.boxes[1][1], 70, 140, 10 + 0.3 * hypot(63, 90), 10 + 0.3 * hypot(63, 90)); /* (160, 130) of image 2 */
    assert_true(expected.points[0][1].x == 160 && expected.points[1][1].y == 130);
    asj_expected_free(&context->memory, &expected);

    const asj_stretch by[2] = {{2, 2}, {2, 3}};
    static const float upsampled[1][2] = {{(float)(2 * 100.5 - 0.5), (float)(2 * 50.5 - 0.5)}};
    set(&s, context, upsampled, 1, 2);
    s.options.upsampled_search_radius = 0.02;
    s.features[1].pyramid.height[0] = 1200;
    assert_int_equal(asj_expect(&s.run, &known, by, &expected), ASJ_OK);
    assert_box(&expected.boxes[0][0], 2 * 220.5 - 0.5, 3 * 40.5 - 0.5, 20, 30);
    asj_expected_free(&context->memory, &expected);
    assert_null(expected.boxes[0]);
}

/* The six nearest are asked, all of what they say is held, and what has no inverse says nothing. */
static void several_matches(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const float places[1][2] = {{100, 50}};
    const asj_stretch same[2] = {{1, 1}, {1, 1}};
    asj_junction_match matches[8];
    asj_l_junction l1[8], l2[8];
    asj_match_result known = {.matches = matches, .match_count = 8, .l_junctions1 = l1, .l_junctions2 = l2};
    asj_expected expected = {{NULL, NULL}, {NULL, NULL}};
    scene s;
    for (int32_t k = 0; k < 8; k++)
        matches[k] = match_at(100, (float)(50 + k), 1);
    matches[2].x2 += 50;  /* another surface */
    matches[7].x2 += 500; /* farther than six others */
    for (uint32_t k = 0; k < 8; k++)
        matches[k].l1 = matches[k].l2 = k;
    stand(matches, 8, l1, l2);
    set(&s, context, places, 1, 1);
    s.options.upsampled_search_radius = 0;
    assert_int_equal(asj_expect(&s.run, &known, same, &expected), ASJ_OK);
    unit_near("left", 0, 0, (double)expected.boxes[0][0].left, 120 - 0.3 * 5, 1e-3);
    unit_near("right", 0, 0, (double)expected.boxes[0][0].right, 170 + 0.3 * 2, 1e-3);
    assert_true(asj_may_be_partners(&expected, 0, 0) == 0);
    asj_expected_free(&context->memory, &expected);

    for (int32_t k = 0; k < 8; k++)
        matches[k].affine[0] = 0;
    assert_int_equal(asj_expect(&s.run, &known, same, &expected), ASJ_OK);
    assert_true(expected.boxes[1][0].left > expected.boxes[1][0].right);
    asj_expected_free(&context->memory, &expected);
}

/* Each must lie in the other's box, and boxes that only touch meet. */
static void both_ways(void **state)
{
    (void)state;
    asj_point points[2] = {{5, 5}, {50, 50}};
    asj_box boxes[2] = {{40, 40, 60, 60}, {0, 0, 10, 10}};
    const asj_expected expected = {{&points[0], &points[1]}, {&boxes[0], &boxes[1]}};
    assert_true(asj_may_be_partners(&expected, 0, 0));
    boxes[1].right = 4;
    assert_false(asj_may_be_partners(&expected, 0, 0));
    boxes[1].right = 10;
    points[1].x = 61;
    assert_false(asj_may_be_partners(&expected, 0, 0));
    const asj_box touching = {60, 60, 70, 70}, beyond = {60.5f, 40, 70, 60}, empty = asj_box_empty();
    assert_true(asj_boxes_meet(&boxes[0], &touching));
    assert_false(asj_boxes_meet(&boxes[0], &beyond));
    assert_false(asj_boxes_meet(&boxes[0], &empty));
}

/* Every allocation fails once. */
static void out_of_memory(void **state)
{
    (void)state;
    static const float places[2][2] = {{100, 50}, {160, 130}};
    const asj_junction_match match = match_at(100, 50, 2);
    asj_l_junction l1, l2;
    const asj_match_result known = {.matches = &match, .match_count = 1, .l_junctions1 = &l1, .l_junctions2 = &l2};
    const asj_stretch same[2] = {{1, 1}, {1, 1}};
    asj_status status = ASJ_ERROR_MEMORY;
    long failed = 0;
    stand(&match, 1, &l1, &l2);
    for (long n = 1; status != ASJ_OK; n++) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *poor = unit_context(&counter, 1);
        asj_expected expected = {{NULL, NULL}, {NULL, NULL}};
        scene s;
        set(&s, poor, places, 2, 1);
        counter.fail_at = counter.calls + n;
        status = asj_expect(&s.run, &known, same, &expected);
        assert_true(status == ASJ_OK || status == ASJ_ERROR_MEMORY);
        failed += status != ASJ_OK;
        asj_expected_free(&poor->memory, &expected);
        unit_context_free(&counter, &poor);
    }
    assert_int_equal(failed, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_match),
        cmocka_unit_test(several_matches),
        cmocka_unit_test(both_ways),
        cmocka_unit_test(out_of_memory),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
