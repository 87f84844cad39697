/* SPDX-License-Identifier: BSD-2-Clause */
/* A room whose images leave the motion open and have no match: the upsampled ones resolve it, where they may be looked at. Which
 * octaves junctions of upsampled images are of. */
#include "unit_test.h"

#include "look.h"
#include "wide_pair.h"

#include <asj/asj.h>

#define SEED 692 /* 55 degrees apart, half of it in common */
#define RIGHT 2  /* degrees */

typedef struct room {
    synth_wide_pair pair;
    uint8_t *pixels[2];
    asj_image images[2];
    asj_match_options options; /* both cameras are known */
} room;
static room seen;

static int look_at_room(void **state)
{
    (void)state;
    if (synth_wide_pair_make(&seen.pair, SEED))
        return -1;
    asj_match_options_init(&seen.options);
    seen.options.geometry.model = ASJ_GEOMETRY_AUTO;
    for (int k = 0; k < 2; k++) {
        const double f = seen.pair.cameras[k].focal;
        seen.pixels[k] = synth_wide_picture(&seen.pair, k);
        seen.images[k] = (asj_image){seen.pixels[k], ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
        seen.options.geometry.cameras[k] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    }
    return seen.pixels[0] && seen.pixels[1] ? 0 : -1;
}

static int forget_room(void **state)
{
    (void)state;
    synth_wide_pair_free(&seen.pair);
    free(seen.pixels[0]);
    free(seen.pixels[1]);
    return 0;
}

/* Neither a match nor a motion. */
static void expect_open(const asj_match_result *r)
{
    assert_int_equal(r->geometry.status, ASJ_GEOMETRY_AMBIGUOUS);
    assert_int_equal(r->geometry.model, ASJ_GEOMETRY_ESSENTIAL);
    assert_int_equal(r->match_count, 0);
    assert_false(r->upsampled);
}

static void expect_resolved(const asj_match_result *r)
{
    const synth_camera *cameras = seen.pair.cameras;
    double f[9];
    assert_int_equal(r->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_true(r->geometry.has_pose);
    const synth_pose_error off = synth_pose_off(&cameras[0], &cameras[1], r->geometry.rotation, r->geometry.translation);
    unit_near("rotation, deg", 0, 0, off.rotation, 0, RIGHT);
    unit_near("translation, deg", 0, 0, off.translation, 0, RIGHT);
    assert_true(r->match_count >= 20);
    synth_fundamental(&cameras[0], &cameras[1], f);
    uint32_t right = 0;
    for (uint32_t n = 0; n < r->match_count; n++) {
        const asj_junction_match *m = &r->matches[n];
        right += synth_off_epipolar_line(f, (double)m->x1, (double)m->y1, (double)m->x2, (double)m->y2) < 4;
        assert_true(m->probability > 0);
    }
    assert_true(right >= r->match_count - 1);
}

static asj_match_result *match_images(asj_context *context, const asj_match_options *options, const asj_detect_options *detector)
{
    const asj_stretch automatic = {0, 0};
    asj_match_result *result = NULL;
    assert_int_equal(asj_match_images(context, &seen.images[0], &seen.images[1], &automatic, detector, options, &result), ASJ_OK);
    return result;
}

/* Of no match: `upsample_from` matches are asked of images that have an answer. Unless nobody wants to see them upsampled. */
static void upsampled_images_resolve_it(void **state)
{
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_options options = seen.options;
    (void)state;
    asj_match_result *r = match_images(context, &options, NULL);
    expect_resolved(r);
    assert_true(r->upsampled);
    asj_match_result_free(&r);
    options.upsample_from = 0;
    r = match_images(context, &options, NULL);
    expect_open(r);
    asj_match_result_free(&r);
    unit_context_free(&counter, &context);
}

/* One octave, or another first one, is a wish not to. */
static void one_octave_leaves_it_open(void **state)
{
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_detect_options detector;
    (void)state;
    assert_int_equal(asj_detect_options_preset(&detector, ASJ_PRESET_MATCH), ASJ_OK);
    detector.octaves = 1;
    asj_match_result *r = match_images(context, &seen.options, &detector);
    assert_int_not_equal(r->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_false(r->upsampled);
    asj_match_result_free(&r);
    unit_context_free(&counter, &context);
}

/* The same with junctions of octave -1 in asj_match(). */
static void junctions_of_octave_minus_one_resolve_it(void **state)
{
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_detect_options detector;
    (void)state;
    assert_int_equal(asj_detect_options_preset(&detector, ASJ_PRESET_MATCH), ASJ_OK);
    for (int32_t first = 0; first >= -1; first--) {
        asj_detection *found[2] = {NULL, NULL};
        asj_match_result *r = NULL;
        detector.first_octave = first;
        for (int k = 0; k < 2; k++)
            assert_int_equal(asj_detect(context, &seen.images[k], &detector, &found[k]), ASJ_OK);
        assert_int_equal(asj_match(context, &seen.images[0], found[0]->junctions, found[0]->junction_count, &seen.images[1],
                                   found[1]->junctions, found[1]->junction_count, &seen.options, &r), ASJ_OK);
        if (first < 0)
            expect_resolved(r);
        else
            expect_open(r);
        asj_match_result_free(&r);
        asj_detection_free(&found[0]);
        asj_detection_free(&found[1]);
    }
    unit_context_free(&counter, &context);
}

/* Of images looked at upsampled N times: an octave is that of the image, down to 0. */
static void octaves_are_those_of_the_image(void **state)
{
    static const struct { asj_stretch by; int32_t finer; } looks[] = {{{2, 2}, 1}, {{4, 5}, 2}, {{2, 1}, 0}, {{0.5, 0.5}, 0}};
    const asj_image *const images[2] = {&seen.images[0], &seen.images[1]};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_detect_options detector;
    (void)state;
    assert_int_equal(asj_detect_options_preset(&detector, ASJ_PRESET_MATCH), ASJ_OK);
    for (size_t k = 0; k < UNIT_COUNT(looks); k++) {
        asj_look look;
        int32_t coarse = 0;
        assert_int_equal(asj_look_open(context, images, &looks[k].by, &detector, NULL, 0, 1, &look), ASJ_OK);
        for (int n = 0; n < 2; n++)
            for (uint32_t i = 0; i < look.views[n].found->junction_count; i++) {
                const int32_t octave = look.views[n].found->junctions[i].octave, finer = octave - looks[k].finer;
                assert_int_equal(look.views[n].junctions[i].octave, octave <= 0 ? octave : finer > 0 ? finer : 0);
                coarse += octave > looks[k].finer;
            }
        assert_true(coarse > 3);
        asj_look_close(&look);
    }
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(upsampled_images_resolve_it),
        cmocka_unit_test(one_octave_leaves_it_open),
        cmocka_unit_test(junctions_of_octave_minus_one_resolve_it),
        cmocka_unit_test(octaves_are_those_of_the_image),
    };
    return cmocka_run_group_tests(tests, look_at_room, forget_room);
}
