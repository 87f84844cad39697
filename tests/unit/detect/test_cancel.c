/* SPDX-License-Identifier: BSD-2-Clause */
/* A checkerboard is full of junctions, and each is on lines as long as the image: every step takes long. The caller is asked often
 * all the same, and what he says is done at once. */
#include "unit_test.h"

#include <asj/asj.h>

#include <time.h>

#ifdef ASJ_IS_SANITIZED
enum { SIDE = 200, SQUARE = 5 };
#define LONGEST 750.0 /* ms: ten times as long for a quarter of the pixels */
#else
enum { SIDE = 400, SQUARE = 5 };
#define LONGEST 300.0
#endif

typedef struct caller {
    double last, longest; /* ms: when it was asked, and the longest pause */
    int32_t stop_at;      /* a stage, or -1 */
    double stopped;       /* ms: when it said so */
    int32_t calls[16];
} caller;

/* Of all threads together: on a machine that has other work too, wall time says nothing. */
static double processor_ms(void)
{
    return 1e3 * (double)clock() / CLOCKS_PER_SEC;
}

static int32_t ask(void *user, int32_t stage, double done)
{
    caller *c = user;
    const double now = processor_ms();
    (void)done;
    c->longest = fmax(c->longest, now - c->last);
    c->last = now;
    c->calls[stage]++;
    if (stage != c->stop_at || c->calls[stage] < 2) /* in the middle of the stage */
        return 0;
    c->stopped = now;
    return 1;
}

static asj_status detect(caller *c, int32_t threads, uint32_t *count)
{
    uint8_t *pixels = malloc(SIDE * SIDE);
    asj_context_options options;
    asj_context *context = NULL;
    asj_detection *found = NULL;
    assert_non_null(pixels);
    for (int32_t i = 0; i < SIDE * SIDE; i++)
        pixels[i] = (i % SIDE / SQUARE + i / SIDE / SQUARE) % 2 ? 210 : 30;
    const asj_image image = unit_gray8(pixels, SIDE, SIDE);
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    options.threads = threads;
    options.progress = ask;
    options.progress_user = c;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    c->last = processor_ms();
    const asj_status status = asj_detect(context, &image, NULL, &found);
    const double end = processor_ms();
    *count = found ? found->junction_count : 0;
    c->longest = fmax(c->longest, end - (c->stopped > 0 ? c->stopped : c->last));
    asj_detection_free(&found);
    asj_context_free(&context);
    free(pixels);
    return status;
}

static void the_caller_is_asked_often(void **state)
{
    (void)state;
    for (int32_t threads = 1; threads <= 2; threads++) {
        caller c = {.stop_at = -1};
        uint32_t count;
        assert_int_equal(detect(&c, threads, &count), ASJ_OK);
        assert_true(count > 1000);
        if (c.longest > LONGEST * threads)
            fail_msg("%d threads: not asked for %.0f ms", (int)threads, c.longest);
    }
}

static void every_long_stage_stops_in_its_middle(void **state)
{
    static const int32_t stages[] = {ASJ_STAGE_LOCATE, ASJ_STAGE_SCAN, ASJ_STAGE_REFINE};
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(stages); i++) {
        caller c = {.stop_at = stages[i]};
        uint32_t count;
        assert_int_equal(detect(&c, 1, &count), ASJ_ERROR_CANCELLED);
        assert_true(c.stopped > 0);
        if (c.longest > LONGEST)
            fail_msg("stage %d: stopped after %.0f ms", (int)stages[i], c.longest);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_caller_is_asked_often),
        cmocka_unit_test(every_long_stage_stops_in_its_middle),
    };
    return cmocka_run_group_tests_name("cancel", tests, NULL, NULL);
}
