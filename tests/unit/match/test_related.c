/* SPDX-License-Identifier: BSD-2-Clause */
/* Images that have nothing in common are answered at once, and those that have something are matched as before, with a geometry
 * and without. */
#include "match/match_options.h"
#include "unit_test.h"

#include <asj/features.h>

#define WIDTH 400
#define HEIGHT 300
#define IMAGES 3

static asj_features *views[IMAGES]; /* two of a furnished room, one of noise with the junctions of the first */

static asj_features *describe(asj_context *context, const asj_image *image, const asj_detection *found)
{
    asj_features *features = NULL;
    assert_int_equal(asj_features_create(context, image, found->junctions, found->junction_count, NULL, &features), ASJ_OK);
    return features;
}

static void make_noise(uint8_t *pixels)
{
    synth_random random;
    synth_random_seed(&random, 3);
    for (int32_t n = 0; n < WIDTH * HEIGHT; n++)
        pixels[n] = (uint8_t)synth_random_between(&random, 60, 200);
}

static int make_views(void **state)
{
    assert_int_equal(unit_set_up(state), 0);
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_detect_options options;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    for (int32_t n = 0; n < 2; n++) {
        asj_detection *found = NULL;
        uint8_t *pixels = unit_room_picture(n, WIDTH, HEIGHT);
        const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
        assert_int_equal(asj_detect(context, &image, &options, &found), ASJ_OK);
        views[n] = describe(context, &image, found);
        if (n == 0) {
            make_noise(pixels);
            views[2] = describe(context, &image, found);
        }
        asj_detection_free(&found);
        free(pixels);
    }
    return 0;
}

static int free_views(void **state)
{
    for (int32_t n = 0; n < IMAGES; n++)
        asj_features_free(&views[n]);
    return unit_tear_down(state);
}

static asj_match_result *match_by(void **state, int32_t first, int32_t second, double least, int32_t model)
{
    asj_match_options options;
    asj_match_result *result = NULL;
    asj_match_options_init(&options);
    options.geometry.model = model;
    if (least >= 0)
        options.related_support = least;
    assert_int_equal(asj_match_features(((unit_fixture *)*state)->context, views[first], views[second], &options, &result), ASJ_OK);
    assert_true(result->l_junction_count1 > 100 && result->l_junction_count2 > 100);
    return result;
}

static asj_match_result *match(void **state, int32_t first, int32_t second, double least)
{
    return match_by(state, first, second, least, ASJ_GEOMETRY_NONE);
}

static void the_same_room_is_matched_as_before(void **state)
{
    asj_match_result *asked = match(state, 0, 1, -1), *never = match(state, 0, 1, 0);
    assert_true(never->match_count > 20);
    assert_int_equal(asked->match_count, never->match_count);
    assert_int_equal(asked->candidates, never->candidates);
    assert_memory_equal(asked->matches, never->matches, never->match_count * sizeof *never->matches);
    asj_match_result_free(&asked);
    asj_match_result_free(&never);
}

/* In either order; the L-junctions are there, no candidate was looked at. */
static void a_room_and_noise_are_answered_at_once(void **state)
{
    for (int32_t order = 0; order < 2; order++) {
        asj_match_result *asked = match(state, order ? 2 : 0, order ? 0 : 2, -1);
        assert_int_equal(asked->match_count, 0);
        assert_int_equal(asked->candidates, 0);
        assert_non_null(asked->l_junctions1);
        asj_match_result_free(&asked);
    }
    asj_match_result *never = match(state, 0, 2, 0);
    assert_true(never->candidates > 100);
    assert_int_equal(never->match_count, 0);
    asj_match_result_free(&never);
}

/* A geometry is looked for by few candidates, and by all of them where these find one. */
static void a_geometry_is_looked_for_at_once(void **state)
{
    asj_match_result *noise = match_by(state, 0, 2, -1, ASJ_GEOMETRY_AUTO);
    assert_int_equal(noise->geometry.status, ASJ_GEOMETRY_CHANCE);
    assert_int_equal(noise->match_count, 0);
    assert_int_equal(noise->candidates, 0);
    asj_match_result_free(&noise);
    asj_match_result *no = match_by(state, 0, 1, 64, ASJ_GEOMETRY_AUTO), *never = match_by(state, 0, 1, 0, ASJ_GEOMETRY_AUTO);
    assert_int_equal(never->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_int_equal(no->match_count, never->match_count);
    assert_memory_equal(no->matches, never->matches, never->match_count * sizeof *never->matches);
    assert_memory_equal(&no->geometry, &never->geometry, sizeof never->geometry);
    asj_match_result_free(&no);
    asj_match_result_free(&never);
}

/* What is asked of the images decides: nothing has the support of everything. */
static void the_option_decides(void **state)
{
    asj_match_result *strict = match(state, 0, 1, 64);
    assert_int_equal(strict->candidates, 0);
    asj_match_result_free(&strict);
    asj_match_options paper;
    assert_int_equal(asj_match_options_preset(&paper, ASJ_PRESET_PAPER), ASJ_OK);
    assert_true(paper.related_support == 0);
}

static void out_of_memory(void **state)
{
    (void)state;
    int reached = 1;
    for (long n = 1; n < 2000 && reached; n++) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *poor = unit_context(&counter, 1);
        asj_match_result *result = NULL;
        counter.fail_at = counter.calls + n;
        const asj_status status = asj_match_features(poor, views[0], views[2], NULL, &result);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK ? result != NULL : reached && status == ASJ_ERROR_MEMORY && !result);
        asj_match_result_free(&result);
        unit_context_free(&counter, &poor);
    }
    assert_false(reached);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_room_is_matched_as_before),
        cmocka_unit_test(a_room_and_noise_are_answered_at_once),
        cmocka_unit_test(a_geometry_is_looked_for_at_once),
        cmocka_unit_test(the_option_decides),
        cmocka_unit_test(out_of_memory),
    };
    return cmocka_run_group_tests(tests, make_views, free_views);
}
