/* SPDX-License-Identifier: BSD-2-Clause */
/* Memory that runs out: the n-th allocation fails, for every n. No crash, no leak, the right status, and the context works
 * on. */
#include "unit_test.h"

#include <asj/asj.h>

static uint8_t *picture(int32_t width, int32_t height)
{
    synth_scene scene;
    synth_scene_init(&scene, width, height, 110);
    synth_add_rectangle(&scene, (synth_point){12.4, 14.2}, 31, 26, 0.2, 170);
    return unit_picture(&scene, 1, 2, 4);
}

enum { WIDTH = 64, HEIGHT = 52, MOST = 2000 };

static void test_create(void **state)
{
    asj_status status = ASJ_ERROR_MEMORY;
    long n = 1;
    (void)state;
    for (; status != ASJ_OK && n < MOST; n++) {
        unit_counter counter = {0, 0, n, n % 2 == 0};
        asj_context_options options;
        asj_context *context = (asj_context *)&counter;
        asj_context_options_init(&options);
        options.allocator = (asj_allocator){unit_allocate, unit_release, &counter};
        status = asj_context_create(&options, &context);
        assert_true(status == ASJ_OK || (status == ASJ_ERROR_MEMORY && !context));
        asj_context_free(&context);
        assert_int_equal(counter.live, 0);
    }
    assert_in_range(n, 3, MOST - 1);
}

static void ignore_dump(void *user, const asj_dump *dump)
{
    (void)user;
    (void)dump;
}

/* From a new context every time (`fresh`), and with one that has worked and failed before. */
static void check_detect(int32_t preset, int fresh, int for_good, int dump, int32_t more)
{
    asj_detect_options detect_options;
    uint8_t *pixels = picture(WIDTH, HEIGHT);
    static uint8_t rgb[WIDTH * HEIGHT][3];
    for (int k = 0; k < WIDTH * HEIGHT; k++)
        rgb[k][0] = rgb[k][1] = (uint8_t)(255 - (rgb[k][2] = pixels[k]));
    const asj_image image = more ? (asj_image){rgb, ASJ_FORMAT_RGB8, WIDTH, HEIGHT, 0, 0} : unit_gray8(pixels, WIDTH, HEIGHT);
    unit_counter counter;
    asj_context *context = NULL;
    int reached = 1;
    long n = 1;
    asj_detect_options_preset(&detect_options, preset);
    detect_options.half_octaves = detect_options.complete_junctions = detect_options.colours = detect_options.three_sizes = more;
    for (; reached && n < MOST; n++) {
        asj_detection *found = (asj_detection *)pixels;
        if (!context) {
            asj_context_options options;
            memset(&counter, 0, sizeof counter);
            asj_context_options_init(&options);
            options.allocator = (asj_allocator){unit_allocate, unit_release, &counter};
            options.threads = 2;
            options.dump = dump ? ignore_dump : NULL;
            assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
        }
        counter.calls = 0;
        counter.fail_at = n;
        counter.for_good = for_good;
        const asj_status status = asj_detect(context, &image, &detect_options, &found);
        reached = unit_reached(&counter);
        if (status == ASJ_OK) {
            assert_true(found->junction_count >= 3);
        } else {
            assert_true(reached && status == ASJ_ERROR_MEMORY);
            assert_null(found);
            assert_non_null(strstr(asj_context_message(context), "memory"));
            assert_int_equal(asj_detect(context, &image, &detect_options, &found), ASJ_OK); /* works afterwards */
            assert_true(found->junction_count >= 3);
        }
        asj_detection_free(&found);
        if (fresh)
            unit_context_free(&counter, &context);
    }
    if (context)
        unit_context_free(&counter, &context);
    assert_in_range(n, 5, MOST - 1);
    free(pixels);
}

static void test_detect(void **state)
{
    (void)state;
    check_detect(ASJ_PRESET_DEFAULT, 1, 0, 1, 0);
    check_detect(ASJ_PRESET_DEFAULT, 0, 1, 1, 0);
    check_detect(ASJ_PRESET_DEFAULT, 0, 0, 0, 0);
    check_detect(ASJ_PRESET_DEFAULT, 0, 0, 0, 1);
    check_detect(ASJ_PRESET_PAPER, 0, 0, 0, 0);
}

static void test_local_field(void **state)
{
    uint8_t *pixels = picture(WIDTH, HEIGHT);
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
    static asj_local_branch expected[WIDTH * HEIGHT * ASJ_FIELD_BRANCHES], branches[WIDTH * HEIGHT * ASJ_FIELD_BRANCHES];
    unit_counter counter;
    asj_context *context = unit_context(&counter, 2);
    int reached = 1;
    long n = 1;
    (void)state;
    assert_int_equal(asj_local_field(context, &image, NULL, expected), ASJ_OK);
    unit_context_free(&counter, &context);
    for (; reached && n < MOST; n++) {
        context = unit_context(&counter, 2);
        counter.calls = 0;
        counter.fail_at = n;
        const asj_status status = asj_local_field(context, &image, NULL, branches);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK || (reached && status == ASJ_ERROR_MEMORY));
        assert_int_equal(asj_local_field(context, &image, NULL, branches), ASJ_OK);
        assert_memory_equal(branches, expected, sizeof branches);
        unit_context_free(&counter, &context);
    }
    assert_in_range(n, 5, MOST - 1);
    free(pixels);
}

/* A stream of frames: a scene that moves, with other noise in every frame. */
static void test_stream(void **state)
{
    enum { FRAMES = 6, STREAM_WIDTH = 160, STREAM_HEIGHT = 120 };
    unit_counter counter;
    asj_context *context = unit_context(&counter, 2);
    asj_detection *found = NULL;
    long calls = 0;
    (void)state;
    for (int frame = 0; frame < FRAMES; frame++) {
        synth_scene scene;
        synth_scene_init(&scene, STREAM_WIDTH, STREAM_HEIGHT, 110);
        for (int i = 0; i < 6; i++)
            synth_add_rectangle(&scene, (synth_point){10 + 24 * i + 0.7 * frame, 20 + 11 * i}, 20, 26, 0.1 * i + 0.02 * frame, 170);
        uint8_t *pixels = unit_picture(&scene, 1, 2, (uint64_t)frame);
        const asj_image image = unit_gray8(pixels, STREAM_WIDTH, STREAM_HEIGHT);
        assert_int_equal(asj_detect_into(context, &image, NULL, &found), ASJ_OK);
        assert_true(found->junction_count >= 8 && found->width == STREAM_WIDTH);
        asj_detection *fresh = NULL;
        const long before = counter.calls;
        assert_int_equal(asj_detect(context, &image, NULL, &fresh), ASJ_OK);
        assert_int_equal(counter.calls - before, 4); /* the result and its three lists */
        counter.calls -= 4;
        assert_int_equal(fresh->junction_count, found->junction_count);
        assert_memory_equal(fresh->junctions, found->junctions, found->junction_count * sizeof *found->junctions);
        assert_memory_equal(fresh->l_junctions, found->l_junctions, found->l_junction_count * sizeof *found->l_junctions);
        asj_detection_free(&fresh);
        if (frame > 0)
            assert_int_equal(counter.calls, calls); /* nothing after the first frame */
        calls = counter.calls;
        free(pixels);
    }
    asj_detection_free(&found);
    unit_context_free(&counter, &context);
}

/* A result that is used again is emptied first, also when nothing comes of the call. */
/* Lists that grow by a little find room in the blocks that are kept. */
static void test_stream_that_grows(void **state)
{
    enum { FRAMES = 14, BOARD_WIDTH = 200, BOARD_HEIGHT = 150, TILE = 9 };
    static uint8_t pixels[BOARD_WIDTH * BOARD_HEIGHT];
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    asj_detection *found = NULL;
    asj_detect_options options;
    long calls = 0;
    (void)state;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    for (int frame = 0; frame < FRAMES; frame++) {
        const asj_image image = unit_gray8(pixels, BOARD_WIDTH, BOARD_HEIGHT);
        for (int n = 0; n < BOARD_WIDTH * BOARD_HEIGHT; n++)
            pixels[n] = ((n % BOARD_WIDTH + frame) / TILE + (n / BOARD_WIDTH + frame / 2) / TILE) % 2 ? 180 : 60;
        assert_int_equal(asj_detect_into(context, &image, &options, &found), ASJ_OK);
        if (frame > 0)
            assert_int_equal(counter.calls, calls);
        calls = counter.calls;
    }
    asj_detection_free(&found);
    unit_context_free(&counter, &context);
}

static void test_into(void **state)
{
    uint8_t *pixels = picture(WIDTH, HEIGHT);
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT), none = {0};
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    asj_detection *found = NULL;
    (void)state;
    assert_int_equal(asj_detect_into(context, &none, NULL, &found), ASJ_ERROR_IMAGE);
    assert_null(found);
    assert_int_equal(asj_detect_into(context, &image, NULL, NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_detect_into(context, &image, NULL, &found), ASJ_OK);
    assert_true(found->junction_count >= 3);
    asj_detection *same = found;
    assert_int_equal(asj_detect_into(context, &none, NULL, &found), ASJ_ERROR_IMAGE);
    assert_ptr_equal(found, same);
    assert_true(found->junction_count == 0 && !found->junctions && found->l_junction_count == 0 && !found->l_junctions);
    assert_int_equal(asj_detect_into(context, &image, NULL, &found), ASJ_OK);
    assert_true(found->junction_count >= 3);
    assert_int_equal(asj_detect_into(NULL, &image, NULL, &found), ASJ_ERROR_ARGUMENT);
    assert_int_equal(found->junction_count, 0);
    asj_context_free(&context); /* the result lives on */
    asj_detection_free(&found);
    assert_int_equal(counter.live, 0);
    free(pixels);
}

/* Each allocation fails while a result that was empty is filled: it stays empty. */
static void test_into_without_memory(void **state)
{
    static const uint8_t flat[WIDTH * HEIGHT] = {0};
    uint8_t *pixels = picture(WIDTH, HEIGHT);
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT), nothing = unit_gray8(flat, WIDTH, HEIGHT);
    int reached = 1;
    (void)state;
    for (long n = 1; n < MOST && reached; n++) {
        unit_counter counter;
        asj_context *context = unit_context(&counter, 1);
        asj_detection *found = NULL;
        assert_int_equal(asj_detect_into(context, &nothing, NULL, &found), ASJ_OK);
        counter.calls = 0;
        counter.fail_at = n;
        const asj_status status = asj_detect_into(context, &image, NULL, &found);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK || (reached && status == ASJ_ERROR_MEMORY));
        if (status != ASJ_OK)
            assert_true(found->junction_count == 0 && found->l_junction_count == 0 && !found->junctions && found->width == 0);
        asj_detection_free(&found);
        unit_context_free(&counter, &context);
    }
    assert_false(reached);
    free(pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_create),
        cmocka_unit_test(test_detect),
        cmocka_unit_test(test_local_field),
        cmocka_unit_test(test_stream),
        cmocka_unit_test(test_stream_that_grows),
        cmocka_unit_test(test_into),
        cmocka_unit_test(test_into_without_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
