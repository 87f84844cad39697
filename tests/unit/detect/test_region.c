/* SPDX-License-Identifier: BSD-2-Clause */
/* A part of the image, by rectangle and by mask: what is found is what the whole image gives, less what lies outside. */
#include "detect/region.h"
#include "detect/steps.h"
#include "unit_test.h"

#include <asj/asj.h>

enum { WIDTH = 320, HEIGHT = 300 };

typedef struct fixture {
    unit_counter counter;
    asj_context *context;
    asj_detect_options options;
    uint8_t *pixels, *mask;
    asj_image image, mask_image;
    asj_detection *whole;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    synth_scene scene;
    assert_non_null(f);
    f->context = unit_context(&f->counter, 2);
    asj_detect_options_init(&f->options);
    synth_tiles(&scene, SYNTH_RANDOM_TILES, 5);
    f->pixels = unit_picture(&scene, 0.8, 2, 6);
    f->image = unit_gray8(f->pixels, WIDTH, HEIGHT);
    f->mask = calloc(WIDTH * HEIGHT, 1);
    assert_non_null(f->mask);
    f->mask_image = unit_gray8(f->mask, WIDTH, HEIGHT);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    asj_detection_free(&f->whole);
    unit_context_free(&f->counter, &f->context);
    free(f->pixels);
    free(f->mask);
    free(f);
    return 0;
}

static asj_detection *detect(fixture *f, const asj_region *region)
{
    asj_detection *found = NULL;
    assert_int_equal(asj_detect_region(f->context, &f->image, region, &f->options, &found), ASJ_OK);
    return found;
}

static int32_t pixel_of(float location, int32_t size)
{
    const int32_t pixel = (int32_t)floor((double)location + 0.5);
    return pixel < 0 ? 0 : pixel >= size ? size - 1 : pixel;
}

static int is_inside(const asj_region *region, const asj_junction *junction)
{
    const int32_t x = pixel_of(junction->x, WIDTH), y = pixel_of(junction->y, HEIGHT);
    const int within = region->width == 0 || (x >= region->x && x < region->x + region->width && y >= region->y &&
                                              y < region->y + region->height);
    const uint8_t *mask = region->mask ? region->mask->data : NULL;
    return within && (!mask || mask[y * WIDTH + x] != 0);
}

/* The junctions of the whole image that lie inside, and no others; lengths apart, as branches no longer end at what is outside. */
static void check(fixture *f, const asj_region *region, uint32_t least)
{
    asj_detection *part = detect(f, region);
    uint32_t inside = 0;
    if (!f->whole)
        f->whole = detect(f, NULL);
    for (uint32_t i = 0; i < f->whole->junction_count; i++) {
        const asj_junction *expected = &f->whole->junctions[i];
        if (!is_inside(region, expected))
            continue;
        assert_true(inside < part->junction_count);
        const asj_junction *found = &part->junctions[inside++];
        assert_true(found->x == expected->x && found->y == expected->y && found->log10_nfa == expected->log10_nfa);
        assert_int_equal(found->branch_count, expected->branch_count);
        for (int32_t b = 0; b < expected->branch_count; b++)
            assert_true(found->branches[b].angle == expected->branches[b].angle);
    }
    assert_int_equal(part->junction_count, inside);
    assert_true(inside >= least && inside + least <= f->whole->junction_count);
    assert_true(part->candidates < f->whole->candidates);
    asj_detection_free(&part);
}

static void test_rectangle(void **state)
{
    check(*state, &(asj_region){.x = 100, .y = 90, .width = 120, .height = 100}, 4);
    check(*state, &(asj_region){.x = 0, .y = 0, .width = WIDTH, .height = 140}, 4);
    check(*state, &(asj_region){.x = 0, .y = 140, .width = WIDTH, .height = HEIGHT - 140}, 4);
}

static void test_mask(void **state)
{
    fixture *f = *state;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
        f->mask[i] = (uint8_t)(hypot(i % WIDTH - 150, i / WIDTH - 140) < 80 ? 1 : 0);
    check(f, &(asj_region){.mask = &f->mask_image}, 4);
    check(f, &(asj_region){.mask = &f->mask_image, .x = 150, .width = 170, .height = HEIGHT}, 2);
}

/* Nothing of the mask: nothing is tested. All of it: as without. The mask may be bottom-up. */
static void test_extreme_masks(void **state)
{
    fixture *f = *state;
    asj_region region = {.mask = &f->mask_image};
    f->whole = detect(f, NULL);
    asj_detection *found = detect(f, &region);
    assert_true(found->junction_count == 0 && found->candidates == 0);
    asj_detection_free(&found);
    memset(f->mask, 255, WIDTH * HEIGHT);
    found = detect(f, &region);
    assert_int_equal(found->junction_count, f->whole->junction_count);
    assert_memory_equal(found->junctions, f->whole->junctions, found->junction_count * sizeof *found->junctions);
    assert_true(found->candidates == f->whole->candidates);
    asj_detection_free(&found);
    memset(f->mask, 0, WIDTH * HEIGHT / 2);
    const asj_image turned = {f->mask + (HEIGHT - 1) * WIDTH, ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, NAN, -WIDTH};
    region.mask = &turned;
    found = detect(f, &region);
    assert_true(found->junction_count > 3);
    for (uint32_t i = 0; i < found->junction_count; i++)
        assert_true(found->junctions[i].y < HEIGHT / 2);
    asj_detection_free(&found);
}

static void test_octaves(void **state)
{
    fixture *f = *state;
    f->options.octaves = 3;
    const asj_region region = {.x = 100, .y = 90, .width = 121, .height = 103};
    asj_detection *found = detect(f, &region);
    assert_true(found->junction_count >= 4);
    for (uint32_t i = 0; i < found->junction_count; i++)
        assert_true(is_inside(&region, &found->junctions[i]));
    asj_detection_free(&found);
    f->options.octaves = 1;
    f->options.first_octave = 1; /* 160 x 150, of which the last column stands for 319 */
    check(f, &(asj_region){.x = 0, .y = 0, .width = 160, .height = HEIGHT}, 4);
    asj_detection *none = detect(f, &(asj_region){.x = WIDTH - 1, .y = HEIGHT - 1, .width = 1, .height = 1});
    assert_int_equal(none->junction_count, 0);
    asj_detection_free(&none);
    asj_detection_free(&f->whole);
    f->options.first_octave = -1;
    check(f, &(asj_region){.x = 101, .y = 91, .width = 121, .height = 103}, 4);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
        f->mask[i] = (uint8_t)(hypot(i % WIDTH - 150, i / WIDTH - 140) < 80 ? 1 : 0);
    check(f, &(asj_region){.mask = &f->mask_image}, 4);
    asj_detection_free(&f->whole);
    f->options.half_octaves = 1;
    f->options.octaves = 3; /* -1 to 1, each for itself: what lies outside may contradict what lies inside otherwise */
    f->options.independent_octaves = 1;
    check(f, &(asj_region){.x = 101, .y = 91, .width = 121, .height = 103}, 4);
    check(f, &(asj_region){.mask = &f->mask_image}, 4);
}

/* Each junction by itself, sharp ones too, which are found farthest from where they were seen first. */
static void test_own_pixels(void **state)
{
    fixture *f = *state;
    const int32_t side = 200;
    uint32_t count = 0;
    f->options.octaves = 1;
    for (int32_t n = 0; n < 24; n++) {
        const double along = 0.27 * n, open = (26 + n % 4) * UNIT_PI / 180;
        const synth_point apex = {90.2 + n / 24.0, 101.7};
        const synth_point wedge[3] = {apex, {apex.x + 70 * cos(along), apex.y + 70 * sin(along)},
                                      {apex.x + 70 * cos(along + open), apex.y + 70 * sin(along + open)}};
        synth_scene scene;
        synth_scene_init(&scene, side, side, 110);
        synth_scene_add(&scene, wedge, 3, synth_flat(170), 0);
        uint8_t *pixels = unit_picture(&scene, 0.8, 1, 4);
        f->image = unit_gray8(pixels, side, side);
        asj_detection *whole = detect(f, NULL);
        for (uint32_t i = 0; i < whole->junction_count; i++, count++) {
            const asj_junction *expected = &whole->junctions[i];
            const asj_region own = {.x = pixel_of(expected->x, side), .y = pixel_of(expected->y, side), .width = 1, .height = 1};
            asj_detection *found = detect(f, &own);
            assert_true(found->junction_count >= 1 && found->junctions[0].x == expected->x && found->junctions[0].y == expected->y);
            asj_detection_free(&found);
        }
        asj_detection_free(&whole);
        free(pixels);
    }
    assert_true(count > 60);
}

/* A place less than half a float's last digit from the border between two pixels is where the caller reads it. */
static void test_between_pixels(void **state)
{
    const fixture *f = *state;
    const double edge = 52.5, below = edge - 1e-7;
    const asj_region above = {.width = WIDTH, .height = 53}, beneath = {.y = 53, .width = WIDTH, .height = 9};
    asj_hypothesis one;
    memset(&one, 0, sizeof one);
    one.x = 20;
    one.y = below;
    assert_true((float)below == (float)edge);
    assert_int_equal(asj_region_keep(&f->image, &above, &one, 1), 0);
    assert_int_equal(asj_region_keep(&f->image, &beneath, &one, 1), 1);
}

static void test_paper(void **state)
{
    fixture *f = *state;
    assert_int_equal(asj_detect_options_preset(&f->options, ASJ_PRESET_PAPER), ASJ_OK);
    f->options.standardise = 0;
    const asj_region region = {.x = 100, .y = 90, .width = 121, .height = 103};
    asj_detection *found = detect(f, &region);
    assert_true(found->junction_count >= 3);
    for (uint32_t i = 0; i < found->junction_count; i++)
        assert_true(is_inside(&region, &found->junctions[i]));
    asj_detection_free(&found);
}

typedef struct caller {
    int32_t calls, stops;
} caller;

static int32_t ask(void *user, int32_t stage, double done)
{
    caller *c = user;
    (void)done;
    assert_int_equal(stage, ASJ_STAGE_CANDIDATES);
    c->calls++;
    return c->stops;
}

/* Whoever has not been asked for long is asked while candidates far from a mask go, and stops that at once. */
static void test_stopped(void **state)
{
    fixture *f = *state;
    const asj_region region = {.mask = &f->mask_image};
    for (int32_t stops = 0; stops < 2; stops++) {
        caller c = {0, stops};
        asj_detection_run run;
        assert_int_equal(asj_detection_run_begin(&run, f->context, &f->image, &f->options, &run), ASJ_OK);
        const size_t count = (size_t)run.frame->blocks * HEIGHT;
        run.region = &region;
        run.candidates = asj_allocate(&f->context->memory, count, sizeof *run.candidates);
        assert_non_null(run.candidates);
        memset(run.candidates, 0xff, count * sizeof *run.candidates);
        f->context->options.progress = ask;
        f->context->options.progress_user = &c;
        f->context->asked_ms = asj_clock_ms() - 1000;
        assert_int_equal(asj_region_clear_candidates(&run), stops ? ASJ_ERROR_CANCELLED : ASJ_OK);
        assert_true(c.calls >= 1 && (!stops || c.calls == 1));
        for (size_t i = 0; i < count; i++) /* of an empty mask all go */
            assert_int_equal(run.candidates[i], stops ? 0xffff : 0);
        f->context->options.progress = NULL;
        asj_detection_run_end(&run);
    }
}

static void refuse(fixture *f, asj_region region, const char *word)
{
    asj_detection *found = NULL;
    assert_int_equal(asj_detect_region(f->context, &f->image, &region, NULL, &found), ASJ_ERROR_ARGUMENT);
    assert_null(found);
    assert_non_null(strstr(asj_context_message(f->context), word));
}

static void test_refused(void **state)
{
    fixture *f = *state;
    refuse(f, (asj_region){.x = 1, .width = WIDTH, .height = 5}, "not within");
    refuse(f, (asj_region){.x = -1, .width = 5, .height = 5}, "not within");
    refuse(f, (asj_region){.y = INT32_MAX, .width = 5, .height = INT32_MAX}, "not within");
    refuse(f, (asj_region){.width = 5}, "not within");
    refuse(f, (asj_region){.width = -5, .height = 5}, "not within");
    refuse(f, (asj_region){.x = 3}, "not within");
    asj_image mask = f->mask_image;
    mask.width--;
    refuse(f, (asj_region){.mask = &mask}, "319");
    mask = f->mask_image;
    mask.format = ASJ_FORMAT_RGB8;
    refuse(f, (asj_region){.mask = &mask}, "gray8");
    asj_detection *found = NULL;
    mask = f->mask_image;
    mask.data = NULL;
    assert_int_equal(asj_detect_region(f->context, &f->image, &(asj_region){.mask = &mask}, NULL, &found), ASJ_ERROR_IMAGE);
    assert_non_null(strstr(asj_context_message(f->context), "the mask has no data"));
    assert_int_equal(asj_detect_region(f->context, &f->image, &(asj_region){.reserved[3] = 1}, NULL, &found), ASJ_ERROR_OPTION);
    assert_non_null(strstr(asj_context_message(f->context), "reserved"));
    assert_int_equal(asj_detect_region(NULL, &f->image, NULL, NULL, &found), ASJ_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_rectangle, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_mask, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_extreme_masks, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_octaves, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_own_pixels, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_between_pixels, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_paper, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_stopped, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_refused, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
