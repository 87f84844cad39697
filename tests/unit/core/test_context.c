/* SPDX-License-Identifier: BSD-2-Clause */
/* Contexts: how they are made, what they say and what they hold. */
#include "core/context.h"
#include "tables.h"
#include "unit_test.h"

static asj_context_options with(unit_counter *counter)
{
    asj_context_options options;
    asj_context_options_init(&options);
    memset(counter, 0, sizeof *counter);
    options.allocator = (asj_allocator){unit_allocate, unit_release, counter};
    return options;
}

static void test_defaults(void **state)
{
    asj_context_options options;
    asj_context *context = NULL;
    (void)state;
    asj_context_options_init(NULL);
    memset(&options, 0xff, sizeof options);
    asj_context_options_init(&options);
    assert_int_equal(options.backend, ASJ_BACKEND_AUTO);
    assert_int_equal(options.threads, 0);
    assert_null(options.device);
    assert_int_equal(options.log_level, ASJ_LOG_WARNING);
    assert_true(!options.log && !options.progress && !options.dump);
    for (size_t i = 0; i < UNIT_COUNT(options.reserved); i++)
        assert_true(options.reserved[i] == 0);
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    assert_string_equal(asj_context_message(context), "");
    assert_true(asj_context_threads(context) >= 1);
    asj_context_free(&context);
    assert_null(context);
    asj_context_free(&context);
    asj_context_free(NULL);
    /* a struct of zeros instead of the defaults: malloc and free */
    memset(&options, 0, sizeof options);
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    asj_context_free(&context);
}

typedef struct last_line {
    char text[128];
    int32_t level;
} last_line;

static void keep_last(void *user, int32_t level, const char *message)
{
    last_line *line = user;
    line->level = level;
    snprintf(line->text, sizeof line->text, "%s", message);
}

/* The number out of range is refused, and the log says which. */
static void refuse(asj_context_options *options, const char *word)
{
    static unit_counter nothing;
    asj_context *context = (asj_context *)&nothing;
    last_line line = {"", -1};
    options->log = keep_last;
    options->log_user = &line;
    assert_int_equal(asj_context_create(options, &context), ASJ_ERROR_OPTION);
    assert_null(context);
    assert_int_equal(line.level, ASJ_LOG_ERROR);
    assert_true(strncmp(line.text, word, strlen(word)) == 0);
}

static void test_refused(void **state)
{
    unit_counter counter;
    asj_context *context = (asj_context *)&counter;
    asj_context_options options = with(&counter);
    (void)state;
    assert_int_equal(asj_context_create(&options, NULL), ASJ_ERROR_ARGUMENT);
    options.allocator.release = NULL;
    assert_int_equal(asj_context_create(&options, &context), ASJ_ERROR_ARGUMENT);
    assert_null(context);
    options = with(&counter);
    options.allocator.allocate = NULL;
    assert_int_equal(asj_context_create(&options, &context), ASJ_ERROR_ARGUMENT);
    asj_context_options_init(&options); /* the other one is the default, which knows nothing of this one's memory */
    options.allocator.allocate = unit_allocate;
    assert_int_equal(asj_context_create(&options, &context), ASJ_ERROR_ARGUMENT);
    asj_context_options_init(&options);
    options.allocator.release = unit_release;
    assert_int_equal(asj_context_create(&options, &context), ASJ_ERROR_ARGUMENT);
    assert_null(context);
    static const int32_t backends[] = {-1, 3, INT32_MAX}, threads[] = {-1, 257, INT32_MIN, INT32_MAX};
    static const int32_t forms[] = {-1, ASJ_SIMD_COUNT, INT32_MAX}, levels[] = {-1, 77, INT32_MIN};
    for (size_t i = 0; i < UNIT_COUNT(backends); i++) {
        options = with(&counter);
        options.backend = backends[i];
        refuse(&options, "backend ");
    }
    for (size_t i = 0; i < UNIT_COUNT(threads); i++) {
        options = with(&counter);
        options.threads = threads[i];
        refuse(&options, "threads ");
    }
    for (size_t i = 0; i < UNIT_COUNT(forms); i++) {
        options = with(&counter);
        options.simd = forms[i];
        refuse(&options, "simd ");
    }
    for (size_t i = 0; i < UNIT_COUNT(levels); i++) {
        options = with(&counter);
        options.log_level = levels[i];
        refuse(&options, "log_level ");
    }
    options = with(&counter);
    options.reserved[10] = 1;
    refuse(&options, "a reserved field ");
    assert_int_equal(counter.live, 0);
}

static void keep_line(void *user, int32_t level, const char *message)
{
    char *line = user;
    assert_int_equal(level, ASJ_LOG_ERROR);
    snprintf(line, 256, "%s", message);
}

/* Each form that runs here can be asked for by its name; of the others the log says why not, and the best is one that runs. */
static void test_simd(void **state)
{
    (void)state;
    for (int32_t simd = ASJ_SIMD_AUTO; simd < ASJ_SIMD_COUNT; simd++) {
        unit_counter counter;
        char line[256] = "";
        asj_context_options options = with(&counter);
        asj_context *context = NULL;
        options.backend = ASJ_BACKEND_CPU;
        options.simd = simd;
        options.log = keep_line;
        options.log_user = line;
        const asj_status status = asj_context_create(&options, &context);
        if (simd == ASJ_SIMD_AUTO || asj_tables_runs(simd)) {
            const int32_t expected = simd == ASJ_SIMD_AUTO ? asj_tables_best() : simd;
            assert_int_equal(status, ASJ_OK);
            assert_int_equal(asj_context_simd(context), expected);
            assert_string_equal(context->ops->name, asj_simd_name(expected));
            assert_string_equal(line, "");
            unit_context_free(&counter, &context);
            continue;
        }
        assert_int_equal(status, ASJ_ERROR_DEVICE);
        assert_null(context);
        assert_int_equal(counter.live, 0);
        assert_non_null(strstr(line, asj_simd_name(simd)));
        assert_non_null(strstr(line, asj_tables_has(simd) ? "this processor lacks them" : "not in this build"));
    }
    assert_true(asj_tables_runs(ASJ_SIMD_REFERENCE));
    assert_true(asj_tables_best() >= ASJ_SIMD_REFERENCE && asj_tables_runs(asj_tables_best()));
    assert_string_equal(asj_simd_name(ASJ_SIMD_AVX512), "avx512");
    assert_string_equal(asj_simd_name(ASJ_SIMD_COUNT), "unknown");
    assert_string_equal(asj_simd_name(-1), "unknown");
    assert_int_equal(asj_context_simd(NULL), ASJ_SIMD_AUTO);
}

/* No operation is missing in any form. */
static void test_tables(void **state)
{
    (void)state;
    for (int32_t simd = ASJ_SIMD_REFERENCE; simd < ASJ_SIMD_COUNT; simd++) {
        asj_tables tables;
        void (*operation)(void);
        memset(&tables, 0, sizeof tables);
        if (!asj_tables_fill(simd, &tables))
            continue;
        for (size_t at = offsetof(asj_tables, image); at < sizeof tables; at += sizeof operation) {
            memcpy(&operation, (const char *)&tables + at, sizeof operation);
            assert_true(operation != NULL);
        }
    }
    assert_false(asj_tables_fill(ASJ_SIMD_AUTO, NULL));
    assert_false(asj_tables_fill(ASJ_SIMD_COUNT, NULL));
}

static void test_threads(void **state)
{
    static const int32_t threads[] = {1, 2, 3, 256};
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(threads); i++) {
        unit_counter counter;
        asj_context_options options = with(&counter);
        asj_context *context = NULL;
        options.threads = threads[i];
        assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
#ifdef ASJ_HAVE_THREADS
        assert_int_equal(asj_context_threads(context), threads[i]);
#else
        assert_int_equal(asj_context_threads(context), 1);
#endif
        unit_context_free(&counter, &context);
    }
    assert_int_equal(asj_context_threads(NULL), 0);
}

/* What it holds is what it took from the allocator, to the byte, and all of it comes back. */
static size_t taken;

static void *sized_allocate(void *user, size_t size)
{
    size_t *block = malloc(size + 64);
    (void)user;
    if (!block)
        return NULL;
    *block = size;
    taken += size;
    return (char *)block + 64;
}

static void sized_release(void *user, void *memory)
{
    size_t *block = (size_t *)(void *)((char *)memory - 64);
    (void)user;
    taken -= *block;
    free(block);
}

static void test_memory(void **state)
{
    asj_context_options options;
    asj_context *context = NULL;
    asj_detection *found = NULL;
    uint64_t now, peak, first = 0;
    uint8_t *pixels = synth_noise_image(90, 70, 100, 10, 1);
    (void)state;
    assert_non_null(pixels);
    asj_context_options_init(&options);
    options.allocator = (asj_allocator){sized_allocate, sized_release, NULL};
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    asj_context_memory(context, &now, &peak);
    assert_true(now == taken && peak >= now);
    assert_in_range(now, 1000, 2000000);
    const asj_image image = unit_gray8(pixels, 90, 70);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(asj_detect(context, &image, NULL, &found), ASJ_OK);
        asj_detection_free(&found);
        asj_context_memory(context, &now, NULL);
        assert_true(now == taken); /* results do not count */
        asj_context_memory(context, NULL, &peak);
        assert_true(peak >= now);
        first = i == 0 ? now : first;
        assert_true(now == first); /* scratch of the call is kept */
    }
    asj_context_memory(NULL, &now, &peak);
    assert_true(now == 0 && peak == 0);
    asj_context_memory(context, NULL, NULL);
    asj_context_free(&context);
    assert_int_equal(taken, 0);
    free(pixels);
}

/* Planes of a large image are given back as all else is that several calls had no use for, upsampled ones too. */
static void test_large_image_is_forgotten(void **state)
{
    enum { WIDTH = 90, HEIGHT = 70, LARGE = 900 };
    asj_context_options options;
    asj_detect_options detect_options;
    asj_context *context = NULL;
    asj_detection *found = NULL;
    uint64_t now, small, large;
    uint8_t *pixels = synth_noise_image(LARGE, LARGE, 100, 10, 1);
    (void)state;
    assert_non_null(pixels);
    const asj_image images[2] = {unit_gray8(pixels, WIDTH, HEIGHT), unit_gray8(pixels, LARGE, LARGE)};
    asj_context_options_init(&options);
    options.threads = 1;
    options.allocator = (asj_allocator){sized_allocate, sized_release, NULL};
    for (int32_t first_octave = -1; first_octave <= 0; first_octave++) {
        asj_detect_options_init(&detect_options);
        detect_options.first_octave = first_octave;
        assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
        assert_int_equal(asj_detect(context, &images[0], &detect_options, &found), ASJ_OK);
        asj_detection_free(&found);
        asj_context_memory(context, &small, NULL);
        assert_int_equal(asj_detect(context, &images[1], &detect_options, &found), ASJ_OK);
        asj_detection_free(&found);
        asj_context_memory(context, &large, NULL);
        assert_true(large > 5 * small);
        for (int i = 0; i < 12; i++) {
            assert_int_equal(asj_detect(context, &images[0], &detect_options, &found), ASJ_OK);
            asj_detection_free(&found);
        }
        asj_context_memory(context, &now, NULL);
        print_message("first octave %d: %llu bytes, with a large image %llu, and then %llu\n", (int)first_octave,
                      (unsigned long long)small, (unsigned long long)large, (unsigned long long)now);
        assert_true(now == taken && now < 2 * small);
        asj_context_free(&context);
        assert_int_equal(taken, 0);
    }
    free(pixels);
}

/* ---- messages and log ---- */

typedef struct log_record {
    int lines, level;
    char text[600];
} log_record;

static void record(void *user, int32_t level, const char *message)
{
    log_record *r = user;
    r->lines++;
    r->level = level;
    snprintf(r->text, sizeof r->text, "%s", message);
}

static void test_messages(void **state)
{
    unit_counter counter;
    log_record heard = {0, -1, ""};
    asj_context_options options = with(&counter);
    asj_context *context = NULL;
    asj_detection *found = NULL;
    (void)state;
    options.log = record;
    options.log_user = &heard;
    options.log_level = ASJ_LOG_ERROR;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    assert_int_equal(heard.lines, 0);
    assert_int_equal(asj_detect(context, NULL, NULL, &found), ASJ_ERROR_ARGUMENT);
    assert_true(strlen(asj_context_message(context)) > 0);
    assert_int_equal(heard.lines, 1);
    assert_int_equal(heard.level, ASJ_LOG_ERROR);
    assert_string_equal(heard.text, asj_context_message(context));
    assert_null(strchr(heard.text, '\n'));
    assert_non_null(asj_context_message(NULL));
    unit_context_free(&counter, &context);
}

/* Internal: levels, and lines longer than any buffer. */
static void test_log(void **state)
{
    unit_counter counter;
    log_record heard = {0, -1, ""};
    asj_context_options options = with(&counter);
    asj_context *context = NULL;
    char longest[2000];
    (void)state;
    memset(longest, 'w', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    options.log = record;
    options.log_user = &heard;
    options.log_level = ASJ_LOG_INFO;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    heard.lines = 0;
    asj_log(context, ASJ_LOG_DEBUG, "not %s", "wanted");
    assert_int_equal(heard.lines, 0);
    asj_log(context, ASJ_LOG_INFO, "%d and %s", 12, "text");
    assert_string_equal(heard.text, "12 and text");
    asj_log(context, ASJ_LOG_WARNING, "%s", longest);
    assert_int_equal(heard.lines, 2);
    assert_in_range(strlen(heard.text), 100, 599);
    assert_int_equal(asj_fail(context, ASJ_ERROR_IMAGE, "%s", longest), ASJ_ERROR_IMAGE);
    assert_in_range(strlen(asj_context_message(context)), 100, 599);
    unit_context_free(&counter, &context);
}

/* ---- progress ---- */

typedef struct progress_record {
    int calls, stop_at;
    double last;
    int32_t stage;
} progress_record;

static int32_t count_progress(void *user, int32_t stage, double done)
{
    progress_record *r = user;
    r->calls++;
    r->last = done;
    r->stage = stage;
    return r->calls == r->stop_at ? 17 : 0;
}

static void test_progress(void **state)
{
    unit_counter counter;
    progress_record seen = {0, 3, -1, -1};
    log_record heard = {0, -1, ""};
    asj_context_options options = with(&counter);
    asj_context *context = NULL;
    (void)state;
    options.progress = count_progress;
    options.progress_user = &seen;
    options.log = record;
    options.log_user = &heard;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    assert_int_equal(asj_progress(context, ASJ_STAGE_SCAN, 0.5), ASJ_OK);
    assert_true(seen.last == 0.5 && seen.stage == ASJ_STAGE_SCAN);
    assert_int_equal(asj_progress(context, ASJ_STAGE_REFINE, 0.25), ASJ_OK);
    assert_true(seen.last == 0.5 && seen.stage == ASJ_STAGE_REFINE); /* never falls */
    assert_int_equal(asj_progress(context, ASJ_STAGE_REFINE, 0.75), ASJ_ERROR_CANCELLED);
    assert_non_null(strstr(asj_context_message(context), "refine"));
    assert_int_equal(heard.lines, 0); /* what the caller asked for is no error to log */
    unit_context_free(&counter, &context);
}

static void test_clock(void **state)
{
    (void)state;
    const double start = asj_clock_ms();
    double now = start;
    for (int i = 0; i < 1000000 && now == start; i++) {
        now = asj_clock_ms();
        assert_true(now >= start);
    }
    assert_true(now > start);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults), cmocka_unit_test(test_refused), cmocka_unit_test(test_threads),
            cmocka_unit_test(test_memory), cmocka_unit_test(test_simd), cmocka_unit_test(test_tables),
        cmocka_unit_test(test_large_image_is_forgotten),
        cmocka_unit_test(test_messages), cmocka_unit_test(test_log),     cmocka_unit_test(test_progress),
            cmocka_unit_test(test_clock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
