/* SPDX-License-Identifier: BSD-2-Clause */
/* Octaves: where their pixels are, which of two junctions stays, what joins; and the widths of edges that decide. */
#include "detect/edge_width.h"
#include "detect/octave_confirm.h"
#include "detect/octaves.h"
#include "detect/steps.h"
#include "render.h"
#include "scenes.h"
#include "unit_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A corner with branches to the right and down, of the given width, in pixels of its octave. */
static asj_hypothesis corner(double x, double y, double width)
{
    asj_hypothesis h;
    memset(&h, 0, sizeof h);
    h.x = x;
    h.y = y;
    h.radius = 7;
    h.log_nfa = -20;
    h.location_variance = 0.01;
    h.branch_count = 2;
    for (int i = 0; i < 2; i++) {
        h.branches[i].angle = i * 0.5 * UNIT_PI;
        h.branches[i].length = 20;
        h.branches[i].width = width;
    }
    return h;
}

static asj_hypothesis of_octave(double octave, double x, double y, double width)
{
    asj_hypothesis h = corner(x, y, width);
    asj_octaves_map(&h, octave);
    return h;
}

static size_t merge_with(asj_hypothesis *list, size_t count, const asj_detect_options *options)
{
    int32_t *cells = malloc(asj_octave_grid_cells(count, 640, 480) * sizeof *cells);
    assert_non_null(cells);
    const size_t kept = asj_octaves_merge(list, count, options, 640, 480, cells);
    free(cells);
    return kept;
}

static size_t merge_as(asj_hypothesis *list, size_t count, int32_t complete_junctions)
{
    asj_detect_options options;
    asj_detect_options_init(&options);
    options.octaves = 16;
    options.complete_junctions = complete_junctions;
    return merge_with(list, count, &options);
}

static size_t merge(asj_hypothesis *list, size_t count)
{
    return merge_as(list, count, 0);
}

static void test_range(void **state)
{
    asj_detect_options options;
    (void)state;
    asj_detect_options_init(&options);
    options.octaves = 16;
    asj_octave_range range = asj_octaves_of(&options, 640, 480); /* 480, 240, 120, 60 */
    assert_int_equal(range.first, 0);
    assert_int_equal(range.end, 4);
    assert_true(range.pixels == 640 * 480 * (1 + 0.25 + 0.0625 + 0.015625));
    options.octaves = 2;
    options.first_octave = 1;
    range = asj_octaves_of(&options, 640, 480);
    assert_int_equal(range.first, 1);
    assert_int_equal(range.end, 3);
    options.first_octave = -1;
    range = asj_octaves_of(&options, 640, 480);
    assert_true(range.first == -1 && range.end == 1 && range.pixels == 640 * 480 * 5);
    options.octaves = 16;
    range = asj_octaves_of(&options, 640, 480);
    assert_true(range.first == -1 && range.end == 4);
    assert_int_equal(asj_octaves_sharing(&options, 640, 480), 5);
    range = asj_octaves_of(&options, 1, 1);
    assert_true(range.first == -1 && range.end == 1);
    options.octaves = 2;
    options.first_octave = 15; /* the coarsest there is */
    range = asj_octaves_of(&options, 640, 480);
    assert_int_equal(range.first, 3);
    assert_int_equal(range.end, 4);
    options.first_octave = 4; /* one more than there are */
    range = asj_octaves_of(&options, 640, 480);
    assert_true(range.first == 3 && range.end == 4 && range.count == 1);
    range = asj_octaves_of(&options, 1, 1);
    assert_int_equal(range.first, 0);
    assert_int_equal(range.end, 1);
}

/* Half-way between two octaves that are looked at, and nowhere else. */
static void test_half_range(void **state)
{
    asj_detect_options options;
    (void)state;
    asj_detect_options_init(&options);
    options.half_octaves = 1;
    options.octaves = 3;
    options.first_octave = -1; /* 1280 x 960, 905 x 678, 640 x 480, 452 x 339, 320 x 240 */
    const asj_octave_range range = asj_octaves_of(&options, 640, 480);
    assert_true(range.first == -1 && range.end == 2 && range.count == 5);
    assert_true(range.pixels == 1280 * 960 + 905 * 678 + 640 * 480 + 452 * 339 + 320 * 240);
    assert_int_equal(asj_octaves_sharing(&options, 640, 480), 5);
    options.octaves = 1;
    assert_int_equal(asj_octaves_of(&options, 640, 480).count, 1);
    assert_int_equal(asj_octave_size(193, 1.5), 67); /* of 193, 96, 67.9; not of 68.2 */
    for (int32_t index = 0; index <= 34; index++) {
        const double octave = 0.5 * index - 1;
        assert_int_equal(asj_octave_index(octave), index);
        assert_true(fabs(asj_octave_scale(octave) - exp2(octave)) <= 1e-12 * exp2(octave));
        assert_true(index % 2 || asj_octave_scale(octave) == exp2(octave));
    }
    const asj_hypothesis h = of_octave(0.5, 2, 10, 1);
    unit_near("x", 0.5, 2, h.x, 2.5 * sqrt(2) - 0.5, 1e-12);
    unit_near("length", 0.5, 2, h.branches[0].length, of_octave(0, 2, 10, 1).branches[0].length * sqrt(2), 1e-9);
}

/* The corner between the first four pixels of level 0 is the centre of pixel 0 of level 1; pixels 0 and 1 of octave -1 lie a
 * quarter of a pixel to either side of pixel 0. */
static void test_map(void **state)
{
    asj_hypothesis h = of_octave(1, 0, 10, 1);
    (void)state;
    assert_true(h.x == 0.5 && h.y == 20.5 && h.radius == 14 && h.octave == 1);
    assert_true(h.branches[1].length == 40 && h.branches[1].width == 1 && h.branches[1].octave == 1);
    unit_near("variance", 0, 0, h.location_variance, 0.04, 1e-12);
    h = of_octave(-1, 0, 11, 1);
    assert_true(h.x == -0.25 && h.y == 5.25 && h.radius == 3.5 && h.octave == -1);
    assert_true(h.branches[1].length == 10 && h.branches[1].width == 1 && h.branches[1].octave == -1);
    unit_near("variance", 0, 0, h.location_variance, 0.0025, 1e-12);
}

static void test_finest_sharp_one_stays(void **state)
{
    asj_hypothesis list[3] = {of_octave(2, 25, 25, 0.7), of_octave(0, 101, 101, 1.2), of_octave(1, 50, 50, 0.8)};
    (void)state;
    assert_int_equal(merge(list, 3), 1);
    assert_true(list[0].octave == 0);
    assert_true(list[0].x == 101);
    asj_hypothesis upsampled[2] = {of_octave(0, 101, 101, 0.7), of_octave(-1, 202.5, 202.5, 1.4)};
    assert_int_equal(merge(upsampled, 2), 1);
    assert_true(upsampled[0].octave == -1);
}

static void test_soft_one_gives_way(void **state)
{
    asj_hypothesis list[2] = {of_octave(0, 101, 101, 2.0), of_octave(1, 50, 50, 1.0)}, alone = list[0], wide = corner(9, 9, 5);
    (void)state;
    assert_int_equal(merge(list, 2), 1);
    assert_true(list[0].octave == 1);
    asj_hypothesis upsampled[2] = {of_octave(-1, 202.5, 202.5, 2.0), of_octave(0, 101, 101, 1.0)};
    assert_int_equal(merge(upsampled, 2), 1);
    assert_true(upsampled[0].octave == 0);
    assert_int_equal(merge(&alone, 1), 1); /* nothing coarser is there */
    assert_int_equal(merge(&wide, 1), 0);  /* a gradient of light */
}

/* A sharp branch that was found when the junction was known does not make it sharp. */
static void test_another_has_no_say(void **state)
{
    (void)state;
    for (int is_another = 0; is_another < 2; is_another++) {
        asj_hypothesis list[2] = {of_octave(0, 101, 101, 2.0), of_octave(1, 50, 50, 1.0)};
        list[0].branches[1].width = 0.5;
        list[0].branches[2] = list[0].branches[1];
        list[0].branches[2].angle = UNIT_PI;
        list[0].branches[2].is_another = is_another;
        list[0].branch_count = 3;
        assert_int_equal(merge(list, 2), 1);
        assert_true(list[0].octave == is_another);
    }
}

static void test_others_stay(void **state)
{
    asj_hypothesis far[2] = {of_octave(0, 101, 101, 1), of_octave(1, 53.5, 50, 1)}; /* 6.5 px = 3.25 of the coarser */
    asj_hypothesis turned[2] = {of_octave(0, 101, 101, 1), of_octave(1, 50, 50, 1)};
    (void)state;
    for (int i = 0; i < 2; i++)
        turned[1].branches[i].angle += 0.7 + UNIT_PI; /* no direction in common */
    assert_int_equal(merge(far, 2), 2);
    assert_int_equal(merge(turned, 2), 2);
}

/* A third branch of the coarser octave joins when it is too soft for the finer one, in order of angle. */
static void test_soft_branch_joins(void **state)
{
    (void)state;
    for (int soft = 0; soft < 2; soft++) {
        asj_hypothesis list[2] = {of_octave(0, 100.5, 100.5, 1), corner(50, 50, 0.8)};
        list[1].branch_count = 3;
        list[1].branches[2] = list[1].branches[1];
        list[1].branches[1].angle = 0.25 * UNIT_PI;
        list[1].branches[1].width = soft ? 1.2 : 0.5;
        asj_octaves_map(&list[1], 1);
        assert_int_equal(merge(list, 2), 1);
        assert_int_equal(list[0].branch_count, soft ? 3 : 2);
        if (soft)
            assert_true(list[0].branches[1].octave == 1 && list[0].branches[1].length == 40 && list[0].branches[0].octave == 0);
    }
}

/* .. and when it is long enough from there on. */
static void test_short_branch_does_not_join(void **state)
{
    (void)state;
    for (int is_long = 0; is_long < 2; is_long++) {
        asj_detect_options options;
        asj_detect_options_init(&options);
        options.octaves = 16;
        options.minimum_length = is_long ? 38 : 39;
        asj_hypothesis list[2] = {of_octave(0, 102, 100.5, 1), corner(50, 50, 0.8)};
        list[1].branch_count = 3;
        list[1].branches[2] = list[1].branches[1];
        list[1].branches[1].angle = 0.25 * UNIT_PI;
        list[1].branches[1].width = 1.2;
        asj_octaves_map(&list[1], 1); /* at (100.5, 100.5), branches of 40 px: 1.06 fewer from the finer one on */
        assert_int_equal(merge_with(list, 2, &options), 1);
        assert_int_equal(list[0].branch_count, is_long ? 3 : 2);
    }
}

/* One that is sharp does so where junctions are completed, or when it is beyond doubt, if its line passes the junction closely. */
static void test_faint_branch_joins(void **state)
{
    static const double off[] = {0.5, 0.7, -0.5, -0.7}; /* px of the image; FAINT_OFF is 0.6 there */
    (void)state;
    for (int i = 0; i < 12; i++) {
        const int complete = i < 4, sure = i >= 8;
        asj_hypothesis list[2] = {of_octave(0, 100.5, 100.5, 1), corner(50, 50, 0.5)};
        list[1].branch_count = 3;
        list[1].branches[2] = list[1].branches[1];
        list[1].branches[1].angle = 0.25 * UNIT_PI;
        list[1].branches[1].log_nfa = (sure ? -31 : -29) * log(10);
        list[1].branches[1].offset = off[i % 4] / 2;
        asj_octaves_map(&list[1], 1);
        assert_int_equal(merge_as(list, 2, complete), 1);
        assert_int_equal(list[0].branch_count, (complete || sure) && i % 2 == 0 ? 3 : 2);
    }
}

/* A finer corner stands on the coarse one's right branch, and that branch begins there unless it comes back, is far or turned. */
static void test_ghosts(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        asj_hypothesis list[2] = {of_octave(2, 25, 25, 0.3), of_octave(0, i == 2 ? 131.5 : 117.5, 101.5, 1)};
        list[1].branches[0].angle = i == 3 ? 0.4 : 0;
        list[1].branches[1].angle = 1.5 * UNIT_PI;
        list[1].branches[2] = list[1].branches[1];
        list[1].branches[2].angle = UNIT_PI;
        list[1].branch_count = i == 1 ? 3 : 2;
        assert_int_equal(merge(list, 2), i == 0 ? 1 : 2);
        assert_true(list[0].octave == 0);
    }
}

/* A corner blurred by 5 px: its lines meet a pixel or more off when nobody knows how blur bends them, outwards where it is acute
 * and inwards where it is obtuse. */
static void test_soft_corners(void **state)
{
    static const double openings[] = {80, 90, 110, 130};
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    asj_detect_options options;
    (void)state;
    asj_detect_options_init(&options);
    options.octaves = 16;
    options.minimum_length = 50; /* px of the image, of which the octaves that find these corners have a half or a quarter */
    for (size_t i = 0; i < UNIT_COUNT(openings); i++) {
        const double angles[] = {0.2, 0.2 + openings[i] * UNIT_PI / 180}, grays[] = {160, -1};
        synth_scene scene;
        asj_detection *found = NULL;
        synth_scene_init(&scene, 240, 240, 100);
        synth_add_star(&scene, (synth_point){120.3, 119.6}, angles, grays, 2, 80);
        uint8_t *pixels = unit_picture(&scene, 5, 1, 3);
        const asj_image image = unit_gray8(pixels, 240, 240);
        assert_int_equal(asj_detect(context, &image, &options, &found), ASJ_OK);
        double least = HUGE_VAL;
        for (uint32_t j = 0; j < found->junction_count; j++)
            least = fmin(least, hypot(found->junctions[j].x - 120.3, found->junctions[j].y - 119.6));
        unit_near("distance from the corner", openings[i], 0, least, 0, 0.12 * 5);
        asj_detection_free(&found);
        free(pixels);
    }
    unit_context_free(&counter, &context);
}

/* A sharp corner is listed once, or, with independent_octaves, by every octave that has found it; each says its own octave. */
static void test_union(void **state)
{
    static const double angles[] = {0.2, 1.8}, grays[] = {160, -1};
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    asj_detect_options options;
    synth_scene scene;
    (void)state;
    synth_scene_init(&scene, 240, 240, 100);
    synth_add_star(&scene, (synth_point){120.3, 119.6}, angles, grays, 2, 80);
    uint8_t *pixels = unit_picture(&scene, 0.9, 1, 3);
    const asj_image image = unit_gray8(pixels, 240, 240);
    asj_detect_options_init(&options);
    for (options.independent_octaves = 0; options.independent_octaves < 2; options.independent_octaves++) {
        int32_t there[3] = {0, 0, 0};
        asj_detection *found = NULL;
        assert_int_equal(asj_detect(context, &image, &options, &found), ASJ_OK);
        for (uint32_t j = 0; j < found->junction_count; j++)
            if (hypot(found->junctions[j].x - 120.3, found->junctions[j].y - 119.6) < 3)
                there[found->junctions[j].octave]++;
        assert_int_equal(there[0], 1);
        assert_int_equal(there[1], options.independent_octaves);
        asj_detection_free(&found);
    }
    free(pixels);
    unit_context_free(&counter, &context);
}

/* Octaves that are listed each for itself are as they are without those between, which come rounded away from the image itself. */
static void test_half_union(void **state)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 2);
    asj_detect_options options;
    synth_scene scene;
    (void)state;
    synth_scene_init(&scene, 240, 240, 100);
    synth_add_rectangle(&scene, (synth_point){60, 60}, 100, 80, 0.2, 140);
    synth_add_rectangle(&scene, (synth_point){130, 120}, 60, 70, 0.9, 50);
    uint8_t *pixels = unit_picture(&scene, 1.2, 3, 3);
    const asj_image image = unit_gray8(pixels, 240, 240);
    assert_int_equal(asj_detect_options_preset(&options, ASJ_PRESET_MATCH), ASJ_OK);
    options.first_octave = -1;
    asj_detection *whole = NULL, *all = NULL;
    assert_int_equal(asj_detect(context, &image, &options, &whole), ASJ_OK);
    options.half_octaves = 1;
    assert_int_equal(asj_detect(context, &image, &options, &all), ASJ_OK);
    uint32_t there = 0, between[4] = {0, 0, 0, 0}, radii_between = 0;
    for (uint32_t i = 0; i < all->junction_count; i++) {
        const asj_junction *j = &all->junctions[i];
        uint32_t k = 0;
        while (k < whole->junction_count && memcmp(j, &whole->junctions[k], sizeof *j) != 0)
            k++;
        there += k < whole->junction_count;
        assert_true(j->octave >= -1 && j->octave <= 2);
        if (k < whole->junction_count)
            continue;
        between[j->octave + 1]++; /* radii of 7 and 14 px of its octave */
        const double octave = j->octave < 0 ? -0.5 : j->octave - 0.5, radius = (double)j->scale / exp2(octave);
        radii_between += fabs(radius - 7) < 1e-4 || fabs(radius - 14) < 1e-4;
    }
    assert_int_equal(there, whole->junction_count);
    assert_true(between[0] > 8 && between[1] == 0 && between[2] > 4 && between[3] > 0);
    assert_int_equal(radii_between, between[0] + between[2] + between[3]);
    asj_detection_free(&whole);
    asj_detection_free(&all);
    free(pixels);
    unit_context_free(&counter, &context);
}

/* Corners of 4 grey levels in noise of 2: more are found, none is listed twice, and few places have none. */
static void test_half_finds_more(void **state)
{
    enum { SCENES = 12, CORNERS = 4 };
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    int found_by[2] = {0, 0}, elsewhere[2] = {0, 0};
    (void)state;
    for (uint64_t seed = 1; seed <= SCENES; seed++) {
        const double c60 = 60 * cos(0.3), s60 = 60 * sin(0.3), c50 = 50 * cos(0.3), s50 = 50 * sin(0.3);
        const synth_point corners[CORNERS] = {
            {70, 60}, {70 + c60, 60 + s60}, {70 + c60 - s50, 60 + s60 + c50}, {70 - s50, 60 + c50}};
        synth_scene scene;
        synth_scene_init(&scene, 240, 220, 120);
        synth_add_rectangle(&scene, corners[0], 60, 50, 0.3, 124);
        uint8_t *pixels = unit_picture(&scene, 1, 2, seed);
        const asj_image image = unit_gray8(pixels, 240, 220);
        for (int32_t half = 0; half < 2; half++) {
            asj_detect_options options;
            asj_detection *found = NULL;
            asj_detect_options_init(&options);
            options.half_octaves = half;
            assert_int_equal(asj_detect(context, &image, &options, &found), ASJ_OK);
            int at[CORNERS] = {0, 0, 0, 0};
            for (uint32_t j = 0; j < found->junction_count; j++) {
                int nearest = -1;
                for (int c = 0; c < CORNERS; c++)
                    if (hypot((double)found->junctions[j].x - corners[c].x, (double)found->junctions[j].y - corners[c].y) < 5)
                        nearest = c;
                elsewhere[half] += nearest < 0;
                if (nearest >= 0)
                    at[nearest]++;
            }
            for (int c = 0; c < CORNERS; c++) {
                assert_in_range(at[c], 0, 1);
                found_by[half] += at[c];
            }
            asj_detection_free(&found);
        }
        free(pixels);
    }
    printf("corners of 4 grey levels: %d of %d, with half octaves %d; elsewhere %d and %d\n", found_by[0], SCENES * CORNERS,
           found_by[1], elsewhere[0], elsewhere[1]);
    assert_true(found_by[1] > found_by[0] && found_by[1] >= SCENES * CORNERS * 9 / 10);
    assert_true(elsewhere[1] <= 1);
    unit_context_free(&counter, &context);
}

/* A step blurred by 0.6 to 3 px, on its line and half a pixel beside it. Of sharp ones no more is known than that they are. */
static void test_widths(void **state)
{
    static const double blurs[] = {0.6, 1, 1.5, 2, 3};
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(blurs); i++) {
        synth_scene scene;
        asj_frame frame;
        memset(&frame, 0, sizeof frame);
        synth_scene_init(&scene, 80, 80, 60);
        synth_add_rectangle(&scene, (synth_point){-9.5, 39.5}, 99, 60, 0, 160);
        uint8_t *pixels = unit_picture(&scene, blurs[i], 0, 1);
        const asj_image image = unit_gray8(pixels, 80, 80);
        assert_int_equal(asj_frame_prepare(context, &frame, 80, 80), ASJ_OK);
        assert_int_equal(asj_frame_load(context, &frame, &image, ASJ_PLANE_LUMA), ASJ_OK);
        for (int beside = 0; beside < 2; beside++) {
            asj_hypothesis h = corner(20, 39.5 + 0.5 * beside, 0);
            h.branch_count = 1;
            asj_edge_widths(&frame, &h);
            if (blurs[i] < 1)
                assert_true(h.branches[0].width < 0.8);
            else
                unit_near("width", blurs[i], beside, h.branches[0].width, blurs[i], 0.15);
        }
        asj_frame_free(&context->memory, &frame);
        free(pixels);
    }
    unit_context_free(&counter, &context);
}

/* A bright rectangle, its corner at (60, 60): how many branches the image confirms of a corner of this octave and of this log10
 * NFA with branches to the right and down, `gap` px to the left of it. */
static int confirmed_of(double octave, double log10_nfa, double gap, double width, double blur)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    synth_scene scene;
    asj_frame frame;
    memset(&frame, 0, sizeof frame);
    synth_scene_init(&scene, 160, 160, 100);
    synth_add_rectangle(&scene, (synth_point){60, 60}, 80, 80, 0, 140);
    unit_frame_of(context, &scene, blur, 2, NULL, &frame);
    asj_hypothesis h = corner(0, 0, width / exp2(octave));
    asj_octaves_map(&h, octave);
    h.log_nfa = log10_nfa * log(10);
    h.x = 60 - gap;
    h.y = 60;
    asj_octave_confirm(&frame, 25, &h);
    asj_frame_free(&context->memory, &frame);
    unit_context_free(&counter, &context);
    return h.branch_count;
}

static int confirmed(double gap, double width, double blur)
{
    return confirmed_of(1, -10, gap, width, blur);
}

/* The image has to show edges where they begin, and as soft as they are said to be. */
static void test_confirm(void **state)
{
    (void)state;
    assert_int_equal(confirmed(0, 1, 1), 2);
    assert_int_equal(confirmed(6, 1, 1), 0); /* one edge begins 6 px farther, the other is not there at all */
    assert_int_equal(confirmed(0, 4, 4), 2);
    assert_int_equal(confirmed(0, 4, 1), 0); /* sharp */
}

/* What the image's own octave is sure of stays. */
static void test_sure_ones_are_not_asked(void **state)
{
    (void)state;
    assert_int_equal(confirmed_of(0, -14, 6, 1, 1), 0);
    assert_int_equal(confirmed_of(0, -16, 6, 1, 1), 2);
    assert_int_equal(confirmed_of(-1, -16, 6, 1, 1), 2);
    assert_int_equal(confirmed_of(1, -16, 6, 1, 1), 0);
}

/* A pass over the same picture that finds nothing but one corner of the image's own octave, `gap` px to the left of it: how many
 * of its branches are in the list of all octaves. */
static int32_t listed_of(int32_t first_octave, int32_t octaves, double gap)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    asj_detect_options options;
    asj_detection_run run;
    synth_scene scene;
    synth_scene_init(&scene, 160, 160, 100);
    synth_add_rectangle(&scene, (synth_point){60, 60}, 80, 80, 0, 140);
    uint8_t *pixels = unit_picture(&scene, 1, 2, 7);
    const asj_image image = unit_gray8(pixels, 160, 160);
    asj_detect_options_init(&options);
    options.first_octave = first_octave;
    options.octaves = octaves;
    assert_int_equal(asj_detection_run_begin(&run, context, &image, &options, &run), ASJ_OK);
    assert_int_equal(asj_step_load(&run), ASJ_OK);
    for (int32_t o = first_octave; o < 0; o++)
        assert_int_equal(asj_step_next_octave(&run), ASJ_OK);
    assert_true(run.octave == 0);
    run.hypotheses = asj_allocate(&context->memory, 1, sizeof *run.hypotheses);
    assert_non_null(run.hypotheses);
    run.hypotheses[0] = corner(60 - gap, 60, 1);
    run.hypothesis_count = 1;
    for (int32_t o = 1; o < first_octave + octaves; o++)
        assert_int_equal(asj_step_next_octave(&run), ASJ_OK);
    assert_int_equal(asj_step_merge_octaves(&run), ASJ_OK);
    const int32_t count = run.hypothesis_count > 0 ? run.hypotheses[0].branch_count : 0;
    asj_detection_run_end(&run);
    free(pixels);
    unit_context_free(&counter, &context);
    return count;
}

/* What the image itself finds has to show in it whether coarser octaves follow or none, and where it is the only octave nothing
 * asks. */
static void test_last_octave_is_confirmed(void **state)
{
    (void)state;
    assert_int_equal(listed_of(0, 2, 0), 2);
    assert_int_equal(listed_of(0, 2, 6), 0);
    assert_int_equal(listed_of(-1, 3, 6), 0);
    assert_int_equal(listed_of(-1, 2, 0), 2);
    assert_int_equal(listed_of(-1, 2, 6), 0);
    assert_int_equal(listed_of(0, 1, 6), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_range),          cmocka_unit_test(test_map),
        cmocka_unit_test(test_finest_sharp_one_stays), cmocka_unit_test(test_soft_one_gives_way),
        cmocka_unit_test(test_another_has_no_say), cmocka_unit_test(test_others_stay),
        cmocka_unit_test(test_soft_branch_joins), cmocka_unit_test(test_faint_branch_joins),
        cmocka_unit_test(test_short_branch_does_not_join), cmocka_unit_test(test_sure_ones_are_not_asked),
        cmocka_unit_test(test_widths),         cmocka_unit_test(test_ghosts),
        cmocka_unit_test(test_soft_corners),   cmocka_unit_test(test_confirm),
        cmocka_unit_test(test_union),          cmocka_unit_test(test_half_range),
        cmocka_unit_test(test_half_union),     cmocka_unit_test(test_half_finds_more),
        cmocka_unit_test(test_last_octave_is_confirmed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
