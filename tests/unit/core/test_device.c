/* SPDX-License-Identifier: BSD-2-Clause */
/* Which OpenCL device a selector means, lists where there are no devices, and contexts without one. */
#include "core/device.h"
#include "create.h"
#include "unit_test.h"

#include <asj/asj.h>

static const asj_device devices[] = {
    {.name = "Tiny CPU 9000", .platform = "Portable Language", .type = ASJ_DEVICE_CPU, .usable = 1},
    {.name = "Old Card", .platform = "Vendor A", .type = ASJ_DEVICE_GPU, .usable = 0, .reason = "old"},
    {.name = "New Card 2", .platform = "Vendor A", .type = ASJ_DEVICE_GPU, .usable = 1},
    {.name = "Board gpu-less", .platform = "Vendor B", .type = ASJ_DEVICE_ACCELERATOR, .usable = 1},
    {.name = "", .platform = "Empty", .type = ASJ_DEVICE_OTHER, .usable = 0, .reason = "the platform has no devices"},
    {.name = "New Card 2", .platform = "Vendor A", .type = ASJ_DEVICE_GPU, .usable = 1},
};
enum { COUNT = sizeof devices / sizeof devices[0], NONE = COUNT };

static void test_selectors(void **state)
{
    static const struct {
        const char *selector;
        size_t opencl, automatic;
    } cases[] = {
        {NULL, 2, 2},        {"", 2, 2},          {"0", 0, NONE},         {"1", NONE, NONE},     {"2", 2, 2},
        {"3", 3, NONE},      {"4", NONE, NONE},   {"5", 5, 5},            {"6", NONE, NONE},     {"02", 2, 2},
        {"cpu", 0, NONE},    {"GPU", 2, 2},       {"Accelerator", 3, NONE}, {"gp", 3, NONE},     {"gpu-", 3, NONE},
        {"card", 2, 2},      {"OLD", NONE, NONE}, {"vendor a", 2, 2},     {"vendor", 2, 2},      {"Portable", 0, NONE},
        {"d 2", 2, 2},       {" 2", 2, 2},        {"9000", NONE, NONE},   {"u 9", 0, NONE},      {"-1", NONE, NONE},
        {"other", NONE, NONE}, {"empty", NONE, NONE}, {"zz", NONE, NONE}, {"99999999999999999999999999", NONE, NONE},
        {"18446744073709551618", NONE, NONE}, {"4294967298", NONE, NONE}, {"New Card 2 or more", NONE, NONE},
    };
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(cases); i++) {
        const size_t opencl = asj_device_choose(devices, COUNT, ASJ_BACKEND_OPENCL, cases[i].selector);
        const size_t automatic = asj_device_choose(devices, COUNT, ASJ_BACKEND_AUTO, cases[i].selector);
        if (opencl != cases[i].opencl || automatic != cases[i].automatic)
            fail_msg("'%s' takes %zu and %zu", cases[i].selector ? cases[i].selector : "(NULL)", opencl, automatic);
    }
    assert_int_equal(asj_device_choose(NULL, 0, ASJ_BACKEND_OPENCL, NULL), 0);
    /* without a selector: GPUs, accelerators, the others, each in order */
    assert_int_equal(asj_device_choose(devices, 2, ASJ_BACKEND_OPENCL, NULL), 0);
    assert_int_equal(asj_device_choose(devices + 3, 2, ASJ_BACKEND_OPENCL, NULL), 0);
    const asj_device reversed[] = {devices[0], devices[3], devices[5]};
    assert_int_equal(asj_device_choose(reversed, 2, ASJ_BACKEND_OPENCL, NULL), 1);
    assert_int_equal(asj_device_choose(reversed, 3, ASJ_BACKEND_OPENCL, NULL), 2);
    assert_int_equal(asj_device_choose(reversed, 2, ASJ_BACKEND_AUTO, NULL), 2);
}

static void test_type_names(void **state)
{
    (void)state;
    assert_string_equal(asj_device_type_name(ASJ_DEVICE_GPU), "gpu");
    assert_string_equal(asj_device_type_name(ASJ_DEVICE_CPU), "cpu");
    assert_string_equal(asj_device_type_name(ASJ_DEVICE_ACCELERATOR), "accelerator");
    assert_string_equal(asj_device_type_name(ASJ_DEVICE_OTHER), "other");
    assert_string_equal(asj_device_type_name(-1), "other");
    assert_string_equal(asj_device_type_name(4), "other");
}

/* ---- no libOpenCL ---- */

static const char missing[] = "/nonexistent/libOpenCL.so.1";

static void test_list(void **state)
{
    asj_device_list *list = (asj_device_list *)&list;
    unit_counter counter;
    asj_context_options options;
    (void)state;
    assert_int_equal(asj_device_list_create(NULL, NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_device_list_create_from(missing, NULL, &list), ASJ_OK);
    assert_int_equal(list->count, 0);
    assert_null(list->devices);
    assert_non_null(strstr(list->message, "OpenCL"));
    asj_device_list_free(&list);
    assert_null(list);
    asj_device_list_free(&list);
    asj_device_list_free(NULL);

    asj_context_options_init(&options);
    options.allocator.release = NULL;
    assert_int_equal(asj_device_list_create(&options, &list), ASJ_ERROR_ARGUMENT);
    asj_status status = ASJ_ERROR_MEMORY;
    for (long n = 1; status != ASJ_OK && n < 100; n++) { /* whatever devices there are here */
        counter = (unit_counter){0, 0, n, 0};
        options.allocator = (asj_allocator){unit_allocate, unit_release, &counter};
        list = (asj_device_list *)&counter;
        status = asj_device_list_create(&options, &list);
        assert_true(status == ASJ_OK ? list != NULL : status == ASJ_ERROR_MEMORY && !list);
        if (status == ASJ_OK)
            assert_true((list->count == 0) == (list->message[0] != '\0'));
        asj_device_list_free(&list);
        assert_int_equal(counter.live, 0);
    }
    assert_int_equal(status, ASJ_OK);
}

typedef struct log_record {
    int lines;
    int32_t level;
    char text[600];
} log_record;

static void record(void *user, int32_t level, const char *message)
{
    log_record *r = user;
    r->lines++;
    r->level = level;
    snprintf(r->text, sizeof r->text, "%s", message);
}

static void test_contexts(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    log_record heard = {0, -1, ""};
    asj_context *context = NULL;
    asj_context_options options;
    (void)state;
    asj_context_options_init(&options);
    options.allocator = (asj_allocator){unit_allocate, unit_release, &counter};
    options.log = record;
    options.log_user = &heard;
    /* what chooses takes the CPU and says nothing */
    assert_int_equal(asj_context_create_from(missing, &options, &context), ASJ_OK);
    assert_int_equal(heard.lines, 0);
    assert_string_equal(asj_context_message(context), "");
    assert_int_equal(asj_context_backend(context), ASJ_BACKEND_CPU);
    assert_null(asj_context_device(context));
    unit_context_free(&counter, &context);
    /* unless it is asked */
    options.log_level = ASJ_LOG_INFO;
    assert_int_equal(asj_context_create_from(missing, &options, &context), ASJ_OK);
    unit_context_free(&counter, &context);
#ifdef ASJ_HAVE_OPENCL
    assert_int_equal(heard.lines, 1);
    assert_int_equal(heard.level, ASJ_LOG_INFO);
#endif
    /* what insists fails, with the reason in the log */
    options.backend = ASJ_BACKEND_OPENCL;
    heard.lines = 0;
    assert_int_equal(asj_context_create_from(missing, &options, &context), ASJ_ERROR_DEVICE);
    assert_null(context);
    assert_int_equal(heard.lines, 1);
    assert_int_equal(heard.level, ASJ_LOG_ERROR);
    assert_non_null(strstr(heard.text, "OpenCL"));
    assert_int_equal(counter.live, 0);
    /* the CPU never looks */
    options.backend = ASJ_BACKEND_CPU;
    heard.lines = 0;
    assert_int_equal(asj_context_create_from(missing, &options, &context), ASJ_OK);
    assert_int_equal(heard.lines, 0);
    unit_context_free(&counter, &context);
    assert_int_equal(asj_context_backend(NULL), ASJ_BACKEND_CPU);
    assert_null(asj_context_device(NULL));
}

static void test_prepare(void **state)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 2);
    asj_detect_options options;
    uint64_t before, after;
    (void)state;
    assert_int_equal(asj_prepare(NULL, NULL, 10, 10), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_prepare(context, NULL, 0, 10), ASJ_ERROR_IMAGE);
    assert_int_equal(asj_prepare(context, NULL, 10, -1), ASJ_ERROR_IMAGE);
    assert_int_equal(asj_prepare(context, NULL, ASJ_MAX_SIDE + 1, 1), ASJ_ERROR_LIMIT);
    asj_detect_options_init(&options);
    options.epsilon = -1;
    assert_int_equal(asj_prepare(context, &options, 10, 10), ASJ_ERROR_OPTION);
    asj_context_memory(context, &before, NULL);
    assert_int_equal(asj_prepare(context, NULL, 1, 1), ASJ_OK);
    assert_int_equal(asj_prepare(context, NULL, 133, 97), ASJ_OK);
    asj_context_memory(context, &after, NULL);
    assert_true(after > before);
    long calls = counter.calls;
    assert_int_equal(asj_prepare(context, NULL, 133, 97), ASJ_OK); /* what the first one made is kept, its result apart */
    asj_context_memory(context, &before, NULL);
    assert_true(before - after < after / 50); /* kept blocks fit other requests too, so one more may be wanted: once */
    assert_in_range(counter.calls - calls, 1, 6); /* the picture, the result and its lists */
    for (int i = 0; i < 3; i++) {
        calls = counter.calls;
        assert_int_equal(asj_prepare(context, NULL, 133, 97), ASJ_OK);
        asj_context_memory(context, &after, NULL);
        assert_true(after <= before);
        assert_in_range(counter.calls - calls, 1, 5);
        before = after;
    }
    unit_context_free(&counter, &context);
}

static int32_t stop(void *user, int32_t stage, double done)
{
    (void)user, (void)stage, (void)done;
    return 1;
}

static void test_prepare_can_be_cancelled(void **state)
{
    asj_context_options options;
    asj_context *context = NULL;
    (void)state;
    asj_context_options_init(&options);
    options.progress = stop;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    assert_int_equal(asj_prepare(context, NULL, 133, 97), ASJ_ERROR_CANCELLED);
    asj_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_selectors), cmocka_unit_test(test_type_names), cmocka_unit_test(test_list),
        cmocka_unit_test(test_contexts),  cmocka_unit_test(test_prepare),
        cmocka_unit_test(test_prepare_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
