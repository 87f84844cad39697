/* SPDX-License-Identifier: BSD-2-Clause */
/* Every option of the tables counts: with some value of it two views of the sample room, in colours, have other junctions or other
 * matches than with a preset as it is. That an option is in range, written and read says nothing of whether a step asks for it. */
#include "match/match_options.h"
#include "unit_test.h"

#include <asj/detect.h>
#include <asj/match.h>

#define WIDTH 224
#define HEIGHT 168

enum { VALUES = 4 };

/* Red is a view of the room, green the same, blue has a stripe of its own. Freed with free(). */
static uint8_t *coloured_room(int32_t viewpoint)
{
    uint8_t *gray = unit_room_picture(viewpoint, WIDTH, HEIGHT), *pixels = malloc(3 * WIDTH * HEIGHT);
    assert_non_null(pixels);
    for (int32_t k = 0; k < WIDTH * HEIGHT; k++) {
        const int32_t striped = k % WIDTH > 60 && k % WIDTH < 110 && k / WIDTH > 40 && k / WIDTH < 120;
        pixels[3 * k] = pixels[3 * k + 1] = gray[k];
        pixels[3 * k + 2] = (uint8_t)(striped ? 255 - gray[k] : gray[k]);
    }
    free(gray);
    return pixels;
}

/* One of the values that an option may have, as text. */
static void name_value(const asj_option_info *row, int which, char *text, size_t size)
{
    const double at[VALUES] = {row->minimum, row->maximum, 0.5 * (row->minimum + row->maximum),
                               fmin(row->minimum + 1, row->maximum)};
    double value = at[which];
    if (row->step > 0)
        value = row->minimum + floor((value - row->minimum) / row->step) * row->step;
    if (row->type == ASJ_OPTION_CHOICE)
        snprintf(text, size, "%s", row->choices[(int)value]);
    else
        snprintf(text, size, row->type == ASJ_OPTION_NUMBER ? "%.9g" : "%.0f", value);
}

/* A number that differs where results do. */
static uint64_t mix(uint64_t sum, const void *bytes, size_t size)
{
    const uint8_t *b = bytes;
    for (size_t k = 0; k < size; k++)
        sum = (sum ^ b[k]) * 1099511628211u;
    return sum;
}

static uint64_t detect(asj_context *context, const asj_image *image, const asj_detect_options *options)
{
    asj_detection *found;
    assert_int_equal(asj_detect(context, image, options, &found), ASJ_OK);
    uint64_t sum = mix(found->edge_count, &found->junction_count, sizeof found->junction_count);
    for (uint32_t k = 0; k < found->junction_count; k++) {
        const asj_junction *j = &found->junctions[k];
        sum = mix(mix(mix(sum, &j->x, sizeof j->x), &j->y, sizeof j->y), &j->log10_nfa, sizeof j->log10_nfa);
        for (int32_t b = 0; b < j->branch_count; b++) {
            sum = mix(sum, &j->branches[b].angle, sizeof j->branches[b].angle);
            sum = mix(sum, &j->branches[b].length, sizeof j->branches[b].length);
            sum = mix(sum, &j->branches[b].end, sizeof j->branches[b].end);
        }
    }
    asj_detection_free(&found);
    return sum;
}

static void test_detector_options_count(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    uint8_t *pixels = coloured_room(0);
    const asj_image image = {pixels, ASJ_FORMAT_RGB8, WIDTH, HEIGHT, 0, 0};
    uint64_t as_it_is[3];
    for (int32_t preset = ASJ_PRESET_DEFAULT; preset <= ASJ_PRESET_MATCH; preset++) {
        asj_detect_options options;
        asj_detect_options_preset(&options, preset);
        as_it_is[preset] = detect(context, &image, &options);
        assert_true(detect(context, &image, &options) == as_it_is[preset]);
    }
    for (size_t k = 0; k < asj_detect_option_count(); k++) {
        const asj_option_info *row = asj_detect_option(k);
        int counts = 0;
        for (int32_t n = 0; n < 3 * VALUES && !counts; n++) {
            asj_detect_options options;
            char text[64], message[256];
            asj_detect_options_preset(&options, n / VALUES);
            name_value(row, n % VALUES, text, sizeof text);
            if (asj_detect_options_set(&options, row->key, text, message, sizeof message) != ASJ_OK)
                continue;
            counts = detect(context, &image, &options) != as_it_is[n / VALUES];
        }
        if (!counts)
            fail_msg("%s changes nothing", row->key);
    }
    free(pixels);
}

/* Of two photographs, by all that matching them automatically looks at. */
static uint64_t match(asj_context *context, const asj_image images[2], const asj_match_options *options)
{
    const asj_stretch automatically = {0, 0};
    asj_match_result *found;
    assert_int_equal(asj_match_images(context, &images[0], &images[1], &automatically, NULL, options, &found), ASJ_OK);
    uint64_t sum = mix(found->match_count, &found->l_junction_count1, sizeof found->l_junction_count1);
    for (uint32_t k = 0; k < found->match_count; k++) {
        const asj_junction_match *m = &found->matches[k];
        sum = mix(mix(sum, m->affine, sizeof m->affine), &m->distance, sizeof m->distance);
        sum = mix(mix(sum, &m->support, sizeof m->support), &m->ax1, sizeof m->ax1);
    }
    asj_match_result_free(&found);
    return sum;
}

static void test_matcher_options_count(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    uint8_t *pixels[2] = {coloured_room(0), coloured_room(1)};
    const asj_image images[2] = {{pixels[0], ASJ_FORMAT_RGB8, WIDTH, HEIGHT, 0, 0},
                                 {pixels[1], ASJ_FORMAT_RGB8, WIDTH, HEIGHT, 0, 0}};
    uint64_t as_it_is[2];
    for (int32_t preset = ASJ_PRESET_DEFAULT; preset <= ASJ_PRESET_PAPER; preset++) {
        asj_match_options options;
        asj_match_options_preset(&options, preset);
        as_it_is[preset] = match(context, images, &options);
        assert_true(match(context, images, &options) == as_it_is[preset]);
    }
    for (size_t k = 0; k < asj_match_option_count(); k++) {
        const asj_option_info *row = asj_match_option(k);
        int counts = 0;
        for (int32_t n = 0; n < 2 * VALUES && !counts; n++) {
            asj_match_options options;
            char text[64], message[256];
            asj_match_options_preset(&options, n / VALUES);
            name_value(row, n % VALUES, text, sizeof text);
            if (asj_match_options_set(&options, row->key, text, message, sizeof message) != ASJ_OK)
                continue;
            counts = match(context, images, &options) != as_it_is[n / VALUES];
        }
        if (!counts && strcmp(row->key, "look_at_colours") != 0) /* of a geometry that is not sure: test_match_images_upsampled.c */
            fail_msg("%s changes nothing", row->key);
    }
    free(pixels[0]);
    free(pixels[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_detector_options_count),
        cmocka_unit_test(test_matcher_options_count),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
