/* SPDX-License-Identifier: BSD-2-Clause */
/* From images to matches: what is refused, who may stop it, and what happens without memory. */
#include "pages.h"

#include "look.h"

static void what_cannot_be_is_refused(void **state)
{
    static const asj_stretch outside[] = {{0.4, 1}, {1, 8.5}, {NAN, 1}, {1, -1}, {INFINITY, 2}, {0, 1}, {3, 0}};
    const pages *p = *state;
    const asj_stretch along = {1, 2}, most = {8, 8};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_result *r = (asj_match_result *)&counter;
    for (size_t k = 0; k < UNIT_COUNT(outside); k++) {
        assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &outside[k], NULL, NULL, &r), ASJ_ERROR_OPTION);
        assert_null(r);
    }
    const asj_stretch least = {0.5, 0.5};
    assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &least, NULL, NULL, &r), ASJ_OK);
    assert_true(r->stretch[0] == 0.5 && r->stretch[1] == 0.5);
    asj_match_result_free(&r);
    assert_int_equal(asj_match_images(context, NULL, &p->images[1], NULL, NULL, NULL, &r), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], NULL, NULL, NULL, NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match_images(NULL, &p->images[0], &p->images[1], NULL, NULL, NULL, &r), ASJ_ERROR_ARGUMENT);
    const asj_image wide = {p->pixels[0], ASJ_FORMAT_GRAY8, 10000, 8, 0, 0}, empty = {p->pixels[0], ASJ_FORMAT_GRAY8, 0, 8, 0, 0};
    assert_int_equal(asj_match_images(context, &wide, &p->images[1], &most, NULL, NULL, &r), ASJ_ERROR_LIMIT);
    const asj_image large = {p->pixels[0], ASJ_FORMAT_GRAY8, 16384, 8192, 0, 0};
    assert_true(asj_look_fits(&large, &(asj_stretch){2, 2}) && !asj_look_fits(&large, &(asj_stretch){2, 2.01}));
    assert_true(asj_look_fits(&wide, &(asj_stretch){6.5, 1}) && !asj_look_fits(&wide, &(asj_stretch){6.56, 1}));
    assert_int_equal(asj_match_images(context, &p->images[0], &empty, &along, NULL, NULL, &r), ASJ_ERROR_IMAGE);
    assert_null(r);
    unit_context_free(&counter, &context);
}

/* An image that is too long to be stretched is looked at as it is. */
static void automatically_nothing_is_too_large(void **state)
{
    static uint8_t thin[ASJ_MAX_SIDE / 2 * 8];
    static const asj_stretch automatic = {0, 0}, along = {3, 1};
    const asj_image images[2] = {unit_gray8(thin, ASJ_MAX_SIDE / 2, 8), unit_gray8(thin, 8, ASJ_MAX_SIDE / 2)};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_result *r = NULL;
    (void)state;
    assert_int_equal(asj_match_images(context, &images[0], &images[1], &along, NULL, NULL, &r), ASJ_ERROR_LIMIT);
    assert_int_equal(asj_match_images(context, &images[0], &images[1], &automatic, NULL, NULL, &r), ASJ_OK);
    assert_true(r->match_count == 0 && r->stretch[0] == 1 && r->stretch[1] == 1);
    asj_match_result_free(&r);
    /* and with octave -1, which upsamples it once more */
    asj_detect_options upsampled;
    asj_detect_options_preset(&upsampled, ASJ_PRESET_MATCH);
    upsampled.first_octave = -1;
    const asj_image flat[2] = {unit_gray8(thin, ASJ_MAX_SIDE / 5, 8), unit_gray8(thin, ASJ_MAX_SIDE / 5, 8)};
    assert_int_equal(asj_match_images(context, &flat[0], &flat[1], &along, &upsampled, NULL, &r), ASJ_ERROR_LIMIT);
    assert_int_equal(asj_match_images(context, &flat[0], &flat[1], &automatic, &upsampled, NULL, &r), ASJ_OK);
    asj_match_result_free(&r);
    unit_context_free(&counter, &context);
}

/* What the caller is told, and when it says stop. */
typedef struct listener {
    double last;
    int falls, calls, stop_at;
} listener;

static int32_t listen(void *user, int32_t stage, double done)
{
    listener *l = user;
    (void)stage;
    l->falls += done < l->last || done > 1;
    l->last = done;
    return ++l->calls == l->stop_at;
}

/* Over the whole call, and never back; stopped anywhere, there is no result and nothing is lost. */
static void progress_never_falls_and_the_caller_may_stop(void **state)
{
    static const asj_stretch stretches[] = {{1, 2}, {0, 0}};
    const pages *p = *state;
    listener l = {0};
    int all = 0;
    for (int n = 0; n < 2 || n * 9 < all; n++) { /* twice to the end */
        const int whole = n < 2;
        unit_counter counter = {0};
        asj_context_options options;
        asj_context *context = NULL;
        asj_match_result *r = NULL;
        asj_context_options_init(&options);
        options.allocator = (asj_allocator){unit_allocate, unit_release, &counter};
        options.threads = 1;
        options.progress = listen;
        options.progress_user = &l;
        l = (listener){.stop_at = whole ? 0 : n * 9};
        assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
        const asj_status status = asj_match_images(context, &p->images[0], &p->images[1], &stretches[n % 2], NULL, NULL, &r);
        assert_int_equal(l.falls, 0);
        if (whole) {
            assert_int_equal(status, ASJ_OK);
            unit_near("at the end", 0, 0, l.last, 1, 1e-9);
            assert_true(r->stage_ms[ASJ_STAGE_CANDIDATES] > 0 && r->total_ms > r->stage_ms[ASJ_STAGE_CANDIDATES]);
            all = l.calls;
        } else {
            assert_true(status == ASJ_ERROR_CANCELLED || (status == ASJ_OK && l.calls < l.stop_at)); /* the clock asks, too */
        }
        asj_match_result_free(&r);
        unit_context_free(&counter, &context);
    }
    assert_true(all > 20);
}

/* A second call with the same context begins at 0, though it stretches the images first and its caller has not been asked for long;
 * and a part that ends at the whole ends at 1, however its limits are rounded. */
static void progress_begins_and_ends_where_it_should(void **state)
{
    static const asj_stretch twice = {2, 2};
    const pages *p = *state;
    listener l = {0};
    asj_context_options options;
    asj_context *context = NULL;
    asj_match_result *r = NULL;
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    options.threads = 1;
    options.progress = listen;
    options.progress_user = &l;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    for (int n = 0; n < 2; n++) {
        l = (listener){0};
        context->asked_ms -= 1000;
        assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &twice, NULL, NULL, &r), ASJ_OK);
        assert_int_equal(l.falls, 0);
        assert_true(l.last == 1);
        asj_match_result_free(&r);
    }
    l = (listener){0};
    context->progress = 0;
    context->progress_from = 0.9;
    context->progress_part = 0.1 + 1e-15;
    assert_int_equal(asj_progress(context, ASJ_STAGE_ASSIGN, 1), ASJ_OK);
    assert_true(l.last == 1);
    asj_context_free(&context);
}

static void expect_allocations_may_fail(const asj_image *image, const asj_stretch *stretch)
{
    int reached = 1;
    for (long n = 1; n < 2000 && reached; n++) {
        unit_counter counter = {0};
        asj_context *poor = unit_context(&counter, 1);
        asj_match_result *r = NULL;
        counter.fail_at = counter.calls + n;
        const asj_status status = asj_match_images(poor, image, image, stretch, NULL, NULL, &r);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK ? r != NULL : reached && status == ASJ_ERROR_MEMORY && !r);
        asj_match_result_free(&r);
        unit_context_free(&counter, &poor);
    }
    assert_false(reached);
}

static void every_allocation_may_fail(void **state)
{
    static const uint8_t dark[24 * 20];
    static const asj_stretch stretches[] = {{2, 1}, {0, 0}};
    const asj_image image = unit_gray8(dark, 24, 20);
    (void)state;
    for (size_t s = 0; s < UNIT_COUNT(stretches); s++)
        expect_allocations_may_fail(&image, &stretches[s]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(automatically_nothing_is_too_large),
        cmocka_unit_test(progress_never_falls_and_the_caller_may_stop),
        cmocka_unit_test(progress_begins_and_ends_where_it_should),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, pages_set_up, pages_tear_down);
}
