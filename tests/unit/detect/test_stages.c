/* SPDX-License-Identifier: BSD-2-Clause */
/* What a call does besides its result: progress, cancellation, dumps, times. */
#include "unit_test.h"

#include <asj/asj.h>

typedef struct watcher {
    int calls, stop_at;
    double last;
    int stage_last, choices;
    int wrong;
    unsigned stages; /* bits */
} watcher;

static int32_t watch(void *user, int32_t stage, double done)
{
    watcher *w = user;
    w->wrong += done < w->last || done < 0 || done > 1 || stage < 0 || stage >= ASJ_STAGE_COUNT;
    /* GRADIENT begins an octave, LOCATE a second choice, after REFINE and once an octave */
    const int again = stage == ASJ_STAGE_LOCATE && w->stage_last == ASJ_STAGE_REFINE;
    w->choices = stage == ASJ_STAGE_GRADIENT ? 0 : w->choices + again;
    w->wrong += stage < w->stage_last - 1 && stage != ASJ_STAGE_GRADIENT && !again;
    w->wrong += w->choices > 1;
    w->last = done;
    w->stage_last = stage;
    w->stages |= 1u << stage;
    w->calls++;
    return w->calls == w->stop_at;
}

typedef struct dumps {
    int count;
    char names[40][24];
    size_t points[40];
    int wrong;
    int halves; /* a smaller one begins the next octave */
    int32_t width, height;
} dumps;

/* Reads the whole plane, so that the sanitizers see it; points lie in the image, or next to it after a line fit. */
static void look(void *user, const asj_dump *dump)
{
    dumps *d = user;
    long sum = 0;
    if (d->halves && dump->width < d->width) {
        d->width /= 2;
        d->height /= 2;
    }
    d->wrong += dump->width != d->width || dump->height != d->height || !dump->data || d->count >= 40;
    if (d->count >= 40)
        return;
    snprintf(d->names[d->count], sizeof d->names[0], "%s", dump->name);
    d->points[d->count++] = dump->kind == ASJ_DUMP_POINTS ? dump->count : 0;
    if (dump->kind == ASJ_DUMP_POINTS) {
        const int32_t *xy = dump->data;
        for (size_t i = 0; i < dump->count; i++)
            d->wrong += xy[2 * i] < -10 || xy[2 * i] > d->width + 10 || xy[2 * i + 1] < -10 || xy[2 * i + 1] > d->height + 10;
        return;
    }
    d->wrong += dump->stride < dump->width || !(dump->unit > 0);
    for (int32_t y = 0; y < dump->height; y++)
        for (int32_t x = 0; x < dump->width; x++) {
            const ptrdiff_t at = y * dump->stride + x;
            sum += dump->kind == ASJ_DUMP_PLANE_U16 ? ((const uint16_t *)dump->data)[at] : ((const int16_t *)dump->data)[at];
        }
    d->wrong += sum == 12345678; /* the sum is used */
}

typedef struct fixture {
    unit_counter counter;
    uint8_t *pixels;
    asj_image image;
    watcher watcher;
    dumps dumps;
    asj_context *context;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    asj_context_options options;
    synth_scene scene;
    *state = f;
    if (!f)
        return -1;
    synth_parallelograms(&scene, 60, 11);
    f->image = unit_gray8(NULL, scene.width, scene.height);
    f->image.data = f->pixels = unit_picture(&scene, 1, 3, 8);
    asj_context_options_init(&options);
    options.allocator = (asj_allocator){unit_allocate, unit_release, &f->counter};
    options.threads = 2;
    options.progress = watch;
    options.progress_user = &f->watcher;
    options.dump = look;
    options.dump_user = &f->dumps;
    f->dumps.width = f->image.width;
    f->dumps.height = f->image.height;
    return asj_context_create(&options, &f->context) == ASJ_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    asj_context_free(&f->context);
    unit_nothing_left(&f->counter);
    free(f->pixels);
    free(f);
    return 0;
}

static void test_progress(void **state)
{
    fixture *f = *state;
    asj_detection *found = NULL;
    for (int i = 0; i < 2; i++) { /* the second call starts from the beginning */
        memset(&f->watcher, 0, sizeof f->watcher);
        assert_int_equal(asj_detect(f->context, &f->image, NULL, &found), ASJ_OK);
        asj_detection_free(&found);
        assert_int_equal(f->watcher.wrong, 0);
        assert_in_range(f->watcher.calls, 8, 100);
        assert_true(f->watcher.last > 0.9);
        assert_int_equal(f->watcher.stages & 0x3f, 0x3f); /* gradient .. refine */
    }
}

/* Stopped at every report: the status, nothing held but what a whole call keeps, no result; and the next call is not disturbed. */
static void test_cancel(void **state)
{
    fixture *f = *state;
    asj_detection *found = NULL;
    int n = 1;
    assert_int_equal(asj_detect(f->context, &f->image, NULL, &found), ASJ_OK);
    asj_detection_free(&found);
    const long live = f->counter.live;
    for (;; n++) {
        memset(&f->watcher, 0, sizeof f->watcher);
        f->watcher.stop_at = n;
        found = (asj_detection *)(uintptr_t)f;
        const asj_status status = asj_detect(f->context, &f->image, NULL, &found);
        if (status == ASJ_OK)
            break;
        assert_int_equal(status, ASJ_ERROR_CANCELLED);
        assert_int_equal(f->watcher.calls, n); /* not asked again */
        assert_null(found);
        assert_non_null(strstr(asj_context_message(f->context), "cancel"));
        assert_in_range(f->counter.live, 1, live);
    }
    assert_in_range(n, 9, 100);
    asj_detection_free(&found);
    memset(&f->watcher, 0, sizeof f->watcher);
}

static void test_cancel_field(void **state)
{
    fixture *f = *state;
    const size_t count = (size_t)f->image.width * (size_t)f->image.height * ASJ_FIELD_BRANCHES;
    asj_local_branch *branches = malloc(count * sizeof *branches);
    assert_non_null(branches);
    memset(&f->watcher, 0, sizeof f->watcher);
    assert_int_equal(asj_local_field(f->context, &f->image, NULL, branches), ASJ_OK); /* what is kept is there */
    int n = 1;
    for (;; n++) {
        memset(&f->watcher, 0, sizeof f->watcher);
        f->watcher.stop_at = n;
        const long live = f->counter.live;
        const asj_status status = asj_local_field(f->context, &f->image, NULL, branches);
        assert_int_equal(f->counter.live, live);
        assert_int_equal(f->watcher.wrong, 0);
        if (status == ASJ_OK)
            break;
        assert_int_equal(status, ASJ_ERROR_CANCELLED);
    }
    assert_in_range(n, 2, 50);
    free(branches);
    memset(&f->watcher, 0, sizeof f->watcher);
}

/* A hook that calls with the context that called it gets an error, and the call goes on as if nothing had been. */
typedef struct intruder {
    asj_context *context;
    asj_image image;
    int calls, refused, logged;
} intruder;

static void intrude(intruder *who)
{
    asj_detection *found = NULL;
    asj_detect_options options;
    asj_context *same = who->context;
    asj_detect_options_init(&options);
    options.isotropic_radii = 1u << 5;
    who->calls += 2;
    who->refused += asj_detect(same, &who->image, &options, &found) == ASJ_ERROR_ARGUMENT && !found;
    who->refused += asj_prepare(same, &options, 640, 480) == ASJ_ERROR_ARGUMENT;
    asj_context_free(&same);
}

static int32_t intrude_by_progress(void *user, int32_t stage, double done)
{
    intrude(user);
    return stage < 0 || done < 0;
}

static void intrude_by_log(void *user, int32_t level, const char *line)
{
    intruder *who = user;
    (void)level;
    who->logged += line[0] != 0;
    if (who->context)
        intrude(who);
}

static void intrude_by_dump(void *user, const asj_dump *dump)
{
    (void)dump;
    intrude(user);
}

static void test_calls_of_hooks(void **state)
{
    fixture *f = *state;
    asj_detection *alone = NULL, *found = NULL;
    asj_context_options options;
    intruder who = {NULL, {f->pixels, ASJ_FORMAT_GRAY8, f->image.width - 9, f->image.height - 9, 0, f->image.width}, 0, 0, 0};
    assert_int_equal(asj_detect(f->context, &f->image, NULL, &alone), ASJ_OK);
    asj_context_options_init(&options);
    options.allocator = (asj_allocator){unit_allocate, unit_release, &f->counter};
    options.log = intrude_by_log;
    options.progress = intrude_by_progress;
    options.dump = intrude_by_dump;
    options.log_level = ASJ_LOG_DEBUG;
    options.log_user = options.progress_user = options.dump_user = &who;
    assert_int_equal(asj_context_create(&options, &who.context), ASJ_OK);
    assert_int_equal(asj_detect(who.context, &f->image, NULL, &found), ASJ_OK);
    assert_in_range(who.calls, 40, 1000);
    assert_int_equal(who.refused, who.calls);
    assert_int_equal(found->junction_count, alone->junction_count);
    assert_memory_equal(found->junctions, alone->junctions, found->junction_count * sizeof *found->junctions);
    asj_detection_free(&found);
    assert_int_equal(asj_detect(who.context, NULL, NULL, &found), ASJ_ERROR_ARGUMENT); /* logged, which calls again */
    assert_in_range(who.logged, 1, 1000);
    asj_detection_free(&alone);
    asj_context_free(&who.context);
    assert_null(who.context);
}

/* All that context.h names, in the order of the steps of one octave, with as many points as the result says. */
static void test_dumps(void **state)
{
    static const char *const names[] = {"gray",     "gradient_x", "gradient_y", "candidates", "isotropic", "opening",  "guessed",
                                        "distinct", "fitted",     "apart",      "located",    "validated", "junctions"};
    fixture *f = *state;
    asj_detection *found = NULL;
    asj_detect_options one;
    asj_detect_options_init(&one);
    one.octaves = 1;
    f->dumps.count = f->dumps.wrong = 0;
    assert_int_equal(asj_detect(f->context, &f->image, &one, &found), ASJ_OK);
    assert_int_equal(f->dumps.count, UNIT_COUNT(names));
    assert_int_equal(f->dumps.wrong, 0);
    for (size_t i = 0; i < UNIT_COUNT(names); i++)
        assert_string_equal(f->dumps.names[i], names[i]);
    assert_int_equal(f->dumps.points[3], found->candidates);
    assert_true(f->dumps.points[4] <= f->dumps.points[3]);
    for (size_t i = 5; i < UNIT_COUNT(names); i++)
        assert_true(f->dumps.points[i] <= f->dumps.points[i - 1]);
    assert_int_equal(f->dumps.points[UNIT_COUNT(names) - 1], found->junction_count);
    asj_detection_free(&found);
    /* an image without candidates: lists of no points */
    static const uint8_t flat[100] = {0};
    const asj_image image = unit_gray8(flat, 10, 10);
    f->dumps = (dumps){.width = 10, .height = 10};
    assert_int_equal(asj_detect(f->context, &image, NULL, &found), ASJ_OK);
    assert_int_equal(f->dumps.count, UNIT_COUNT(names));
    assert_int_equal(f->dumps.wrong, 0);
    asj_detection_free(&found);
    f->dumps = (dumps){.width = f->image.width, .height = f->image.height};
}

/* The stages' times are parts of the total, and what is not in them is little; no assertion says how long anything takes. */
static void test_times(void **state)
{
    fixture *f = *state;
    asj_detection *found = NULL;
    double sum = 0;
    assert_int_equal(asj_detect(f->context, &f->image, NULL, &found), ASJ_OK);
    for (int i = 0; i < 16; i++) {
        assert_true(found->stage_ms[i] >= 0);
        if (i > ASJ_STAGE_DECOMPOSE)
            assert_true(found->stage_ms[i] == 0);
        sum += found->stage_ms[i];
    }
    unit_near("sum of the stages / total", 0, 0, sum / found->total_ms, 1, 1e-6);
    asj_detection_free(&found);
}

/* What each step says it did, at the resolution of an image whose rows are more than one group. */
static void test_counts(void **state)
{
    fixture *f = *state;
    asj_detection *found = NULL;
    assert_true(f->image.height > 128);
    assert_int_equal(asj_detect(f->context, &f->image, NULL, &found), ASJ_OK);
    assert_true(found->candidates > found->isotropic);
    assert_true(found->isotropic >= found->junction_count);
    assert_true(found->junction_count >= 8);
    assert_int_equal(found->width, f->image.width);
    assert_int_equal(found->height, f->image.height);
    assert_true(found->l_junction_count >= found->junction_count);
    asj_detection_free(&found);
}

/* Each octave hands out everything again, half as large: 320 x 240, 160 x 120, 80 x 60. */
static void test_octave_dumps(void **state)
{
    fixture *f = *state;
    asj_detection *found = NULL;
    asj_detect_options all;
    asj_detect_options_init(&all);
    all.octaves = 16;
    f->dumps = (dumps){.width = f->image.width, .height = f->image.height, .halves = 1};
    assert_int_equal(asj_detect(f->context, &f->image, &all, &found), ASJ_OK);
    assert_int_equal(f->dumps.count, 3 * 13);
    assert_int_equal(f->dumps.wrong, 0);
    assert_int_equal(f->dumps.width, 80);
    assert_int_equal(f->dumps.points[3] + f->dumps.points[16] + f->dumps.points[29], found->candidates);
    assert_int_equal(f->dumps.points[4] + f->dumps.points[17] + f->dumps.points[30], found->isotropic);
    assert_true(f->dumps.points[12] + f->dumps.points[25] + f->dumps.points[38] >= found->junction_count);
    asj_detection_free(&found);
    f->dumps = (dumps){.width = f->image.width, .height = f->image.height};
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_progress), cmocka_unit_test(test_cancel), cmocka_unit_test(test_cancel_field),
        cmocka_unit_test(test_dumps),    cmocka_unit_test(test_octave_dumps), cmocka_unit_test(test_times),
        cmocka_unit_test(test_counts),   cmocka_unit_test(test_calls_of_hooks),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
