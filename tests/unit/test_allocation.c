/* SPDX-License-Identifier: BSD-2-Clause */
/* Memory that cannot be had: the n-th allocation fails, for every n. No crash, no leak, the right status, and the context works
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
static void check_detect(int fresh, int for_good, int dump)
{
    uint8_t *pixels = picture(WIDTH, HEIGHT);
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
    unit_counter counter;
    asj_context *context = NULL;
    asj_status status = ASJ_ERROR_MEMORY;
    long n = 1;
    for (; status != ASJ_OK && n < MOST; n++) {
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
        status = asj_detect(context, &image, NULL, &found);
        counter.fail_at = 0;
        if (status == ASJ_OK) {
            assert_true(found->junction_count >= 3);
        } else {
            assert_int_equal(status, ASJ_ERROR_MEMORY);
            assert_null(found);
            assert_non_null(strstr(asj_context_message(context), "memory"));
            assert_int_equal(asj_detect(context, &image, NULL, &found), ASJ_OK); /* works afterwards */
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
    check_detect(1, 0, 1);
    check_detect(0, 1, 1);
    check_detect(0, 0, 0);
}

static void test_local_field(void **state)
{
    uint8_t *pixels = picture(WIDTH, HEIGHT);
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
    static asj_local_branch expected[WIDTH * HEIGHT * ASJ_FIELD_BRANCHES], branches[WIDTH * HEIGHT * ASJ_FIELD_BRANCHES];
    asj_status status = ASJ_ERROR_MEMORY;
    unit_counter counter;
    asj_context *context = unit_context(&counter, 2);
    long n = 1;
    (void)state;
    assert_int_equal(asj_local_field(context, &image, NULL, expected), ASJ_OK);
    unit_context_free(&counter, &context);
    for (; status != ASJ_OK && n < MOST; n++) {
        context = unit_context(&counter, 2);
        counter.calls = 0;
        counter.fail_at = n;
        status = asj_local_field(context, &image, NULL, branches);
        assert_true(status == ASJ_OK || status == ASJ_ERROR_MEMORY);
        counter.fail_at = 0;
        assert_int_equal(asj_local_field(context, &image, NULL, branches), ASJ_OK);
        assert_memory_equal(branches, expected, sizeof branches);
        unit_context_free(&counter, &context);
    }
    assert_in_range(n, 5, MOST - 1);
    free(pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_create),
        cmocka_unit_test(test_detect),
        cmocka_unit_test(test_local_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
