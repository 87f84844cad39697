/* SPDX-License-Identifier: BSD-2-Clause */
/* The OpenCL runtime: entries of the kernel store, and on the first device that there is buffers, transfers, runs, times, limits
 * and failures. Without a device the test is skipped, or fails when ASJ_REQUIRE_OPENCL is set. */
#include "cl/cache.h"
#include "cl/program.h"
#include "cl/runtime.h"
#include "cl/state.h"
#include "detect/gradient.h"
#include "unit_test.h"

#include <asj/asj.h>

/* ---- entries ---- */

static void test_keys(void **state)
{
    const asj_cl_source a = {"field", {"", ""}, {0, 0}, "0123"}, b = {"field", {"", ""}, {0, 0}, "0124"},
                        c = {"a_name_that_is_longer_than_anything_that_we_ever_use_for_a_program", {"", ""}, {0, 0}, "0123"};
    char one[ASJ_CL_KEY_SIZE], two[ASJ_CL_KEY_SIZE];
    (void)state;
    asj_cl_cache_key("device", &a, one);
    asj_cl_cache_key("device", &a, two);
    assert_string_equal(one, two);
    assert_int_equal(strspn(one, "abcdefghijklmnopqrstuvwxyz0123456789-_."), strlen(one));
    asj_cl_cache_key("Device", &a, two);
    assert_string_not_equal(one, two);
    asj_cl_cache_key("device", &b, two);
    assert_string_not_equal(one, two);
    asj_cl_cache_key("device", &c, two);
    assert_in_range(strlen(two), 20, ASJ_CL_KEY_SIZE - 1);
}

static void test_entries(void **state)
{
    static const uint8_t binary[] = {1, 2, 3, 0, 255, 6, 7};
    const asj_cl_source source = {"field", {"", ""}, {0, 0}, "0123"}, other = {"field", {"", ""}, {0, 0}, "0124"};
    const char identity[] = "card\ndriver 1";
    uint8_t entry[200];
    size_t size = 0;
    (void)state;
    const size_t total = asj_cl_cache_entry_size(identity, &source, sizeof binary);
    assert_in_range(total, sizeof binary + 1, sizeof entry);
    asj_cl_cache_pack(identity, &source, binary, sizeof binary, entry);
    const uint8_t *found = asj_cl_cache_unpack(identity, &source, entry, total, &size);
    assert_non_null(found);
    assert_int_equal(size, sizeof binary);
    assert_memory_equal(found, binary, size);
    assert_null(asj_cl_cache_unpack("card\ndriver 2", &source, entry, total, &size));
    assert_null(asj_cl_cache_unpack("card\ndriver 11", &source, entry, total, &size));
    assert_null(asj_cl_cache_unpack("card\ndriver ", &source, entry, total, &size));
    assert_null(asj_cl_cache_unpack(identity, &other, entry, total, &size));
    for (size_t cut = 0; cut < total; cut++)
        assert_null(asj_cl_cache_unpack(identity, &source, entry, cut, &size));
    assert_null(asj_cl_cache_unpack(identity, &source, entry, total + 1, &size));
    for (size_t i = 0; i < total; i++)
        for (int bit = 0; bit < 8; bit++) {
            entry[i] = (uint8_t)(entry[i] ^ 1u << bit);
            assert_null(asj_cl_cache_unpack(identity, &source, entry, total, &size));
            entry[i] = (uint8_t)(entry[i] ^ 1u << bit);
        }
}

/* ---- contexts on a device ---- */

typedef struct log_record {
    int lines[4]; /* by level */
    char text[600];
} log_record;

static void record(void *user, int32_t level, const char *message)
{
    log_record *r = user;
    r->lines[level]++;
    snprintf(r->text, sizeof r->text, "%s", message);
}

/* A store in memory with one trick: `damage` bytes into each entry a bit is wrong. */
typedef struct store {
    struct {
        char key[ASJ_CL_KEY_SIZE];
        uint8_t *data;
        size_t size;
    } entries[32];
    int count, gets, puts;
    size_t damage;
} store;

static size_t store_get(void *user, const char *key, void *data, size_t capacity)
{
    store *s = user;
    s->gets++;
    for (int i = 0; i < s->count; i++)
        if (strcmp(s->entries[i].key, key) == 0) {
            if (s->entries[i].size <= capacity) {
                memcpy(data, s->entries[i].data, s->entries[i].size);
                if (s->damage > 0)
                    ((uint8_t *)data)[s->damage % s->entries[i].size] ^= 16;
            }
            return s->entries[i].size;
        }
    return 0;
}

static void store_put(void *user, const char *key, const void *data, size_t size)
{
    store *s = user;
    int i = 0;
    s->puts++;
    while (i < s->count && strcmp(s->entries[i].key, key) != 0)
        i++;
    assert_in_range(i, 0, UNIT_COUNT(s->entries) - 1);
    snprintf(s->entries[i].key, sizeof s->entries[i].key, "%s", key);
    free(s->entries[i].data);
    s->entries[i].data = malloc(size);
    assert_non_null(s->entries[i].data);
    memcpy(s->entries[i].data, data, size);
    s->entries[i].size = size;
    if (i == s->count)
        s->count++;
}

static unit_counter counter;
static log_record heard;
static store kept;
static int keeps_programs; /* what the library found: the program that runs while a context is made was not stored then */

static asj_context *open_device(void)
{
    asj_context_options options;
    asj_context *context = NULL;
    asj_context_options_init(&options);
    memset(&heard, 0, sizeof heard);
    counter = (unit_counter){0, 0, 0, 0};
    options.backend = ASJ_BACKEND_OPENCL;
    options.threads = 2;
    options.allocator = (asj_allocator){unit_allocate, unit_release, &counter};
    options.log = record;
    options.log_user = &heard;
    options.kernel_cache = (asj_kernel_cache){store_get, store_put, &kept};
    if (asj_context_create(&options, &context) != ASJ_OK)
        fail_msg("%s", heard.text);
    keeps_programs = context->cl->keeps_programs;
    context->cl->keeps_programs = 0; /* so that there is a store to test, on PoCL too */
    return context;
}

static void test_open(void **state)
{
    asj_context *context = open_device();
    (void)state;
    assert_int_equal(asj_context_backend(context), ASJ_BACKEND_OPENCL);
    assert_true(strlen(asj_context_device(context)) > 0);
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    assert_true(limits->max_work_group >= 64 && limits->local_memory >= 16384);
    assert_true(limits->max_work_item[0] > 0 && limits->max_work_item[1] > 0 && limits->max_work_item[2] > 0);
    assert_true(limits->largest_buffer > 0 && limits->global_memory >= limits->largest_buffer);
    assert_true(limits->compute_units > 0);
    unit_context_free(&counter, &context);
}

/* All programs build; from the store the second time; what is damaged is built anew and replaced. */
static void test_store(void **state)
{
    (void)state;
    asj_context *context = open_device();
    assert_int_equal(asj_cl_build_all(context), ASJ_OK);
    unit_context_free(&counter, &context);
    const int programs = kept.count;
    assert_int_equal(programs, asj_cl_source_count - keeps_programs);

    kept.puts = 0;
    context = open_device();
    assert_int_equal(asj_cl_build_all(context), ASJ_OK);
    assert_int_equal(asj_cl_build_all(context), ASJ_OK);
    unit_context_free(&counter, &context);
    assert_int_equal(kept.puts, 0);

    static const size_t damage[] = {1, 20, 100, 1500};
    for (size_t i = 0; i < UNIT_COUNT(damage); i++) {
        int32_t kernel;
        kept.damage = damage[i];
        context = open_device();
        kept.puts = 0;
        assert_int_equal(asj_cl_find_kernel(context, "gradient_norms", &kernel), ASJ_OK);
        unit_context_free(&counter, &context);
        assert_int_equal(kept.puts, 1);
        assert_int_equal(kept.count, programs);
    }
    kept.damage = 0;
}

/* A driver that keeps programs itself is not asked for them. */
static void test_driver_store(void **state)
{
    (void)state;
    asj_context *context = open_device();
    int32_t kernel;
    context->cl->keeps_programs = 1;
    kept.damage = 1; /* so that there is no entry to build from */
    kept.puts = 0;
    assert_int_equal(asj_cl_find_kernel(context, "gradient_norms", &kernel), ASJ_OK);
    assert_int_equal(kept.puts, 0);
    kept.damage = 0;
    unit_context_free(&counter, &context);
}

static void test_transfers(void **state)
{
    enum { PITCH = 24, ROWS = 5, HOST = 17 };
    uint8_t in[PITCH * ROWS], out[PITCH * ROWS], host[HOST * ROWS];
    asj_cl_buffer buffer = {0};
    (void)state;
    asj_context *context = open_device();
    for (int i = 0; i < PITCH * ROWS; i++)
        in[i] = (uint8_t)(7 * i + 1);
    assert_int_equal(asj_cl_reserve(context, &buffer, 0), ASJ_OK);
    assert_true(buffer.memory && buffer.size >= 1);
    assert_int_equal(asj_cl_reserve(context, &buffer, sizeof in), ASJ_OK);
    assert_true(buffer.size >= sizeof in);
    const cl_mem memory = buffer.memory;
    assert_int_equal(asj_cl_reserve(context, &buffer, 3), ASJ_OK);
    assert_true(buffer.memory == memory); /* never smaller */
    assert_int_equal(asj_cl_write(context, &buffer, 0, in, sizeof in), ASJ_OK);
    assert_int_equal(asj_cl_read(context, &buffer, 0, out, sizeof out), ASJ_OK);
    assert_memory_equal(in, out, sizeof in);
    assert_int_equal(asj_cl_write(context, &buffer, 30, NULL, 0), ASJ_OK);
    assert_int_equal(asj_cl_read(context, &buffer, 30, NULL, 0), ASJ_OK);
    /* rows of 11 bytes from column 3, row 1 of the buffer on */
    memset(host, 0, sizeof host);
    assert_int_equal(asj_cl_read_rows(context, &buffer, PITCH + 3, PITCH, host, HOST, 11, ROWS - 1), ASJ_OK);
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < HOST; x++)
            assert_int_equal(host[y * HOST + x], y < ROWS - 1 && x < 11 ? in[(y + 1) * PITCH + 3 + x] : 0);
    /* back, two rows further up and five columns to the right; the rest stays */
    assert_int_equal(asj_cl_write_rows(context, &buffer, 8, PITCH, host, HOST, 11, 2), ASJ_OK);
    assert_int_equal(asj_cl_zero(context, &buffer, PITCH * 4, 9), ASJ_OK);
    assert_int_equal(asj_cl_zero(context, &buffer, 0, 0), ASJ_OK);
    assert_int_equal(asj_cl_read(context, &buffer, 0, out, sizeof out), ASJ_OK);
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < PITCH; x++) {
            const int copied = y < 2 && x >= 8 && x < 19, zero = y == 4 && x < 9;
            assert_int_equal(out[y * PITCH + x], copied ? host[y * HOST + x - 8] : zero ? 0 : in[y * PITCH + x]);
        }
    asj_cl_release(context, &buffer);
    asj_cl_release(context, &buffer);
    assert_true(!buffer.memory && buffer.size == 0);
    unit_context_free(&counter, &context);
}

static void test_runs(void **state)
{
    uint32_t once[64], again[64];
    asj_cl_buffer buffer = {0};
    asj_cl_time times[64];
    size_t global = 64, local = 16, most = 0, multiple = 0;
    (void)state;
    asj_context *context = open_device();
    assert_int_equal(asj_cl_get_times(context, times, 64), 0);
    assert_int_equal(asj_cl_profile(context, 0), ASJ_OK);
    assert_int_equal(asj_cl_profile(context, 1), ASJ_OK);
    assert_int_equal(asj_cl_reserve(context, &buffer, sizeof once), ASJ_OK);
    const asj_cl_argument arguments[] = {ASJ_CL_BUFFER(&buffer)};
    const asj_cl_arguments first = ASJ_CL_ARGUMENTS(arguments);
    assert_int_equal(asj_cl_run(context, "check", 1, &global, NULL, first), ASJ_OK);
    assert_int_equal(asj_cl_read(context, &buffer, 0, once, sizeof once), ASJ_OK);
    assert_int_equal(asj_cl_zero(context, &buffer, 0, sizeof once), ASJ_OK);
    assert_int_equal(asj_cl_run(context, "check", 1, &global, &local, first), ASJ_OK);
    global = 0;
    assert_int_equal(asj_cl_run(context, "check", 1, &global, &local, first), ASJ_OK); /* nothing to do */
    assert_int_equal(asj_cl_finish(context), ASJ_OK);
    assert_int_equal(asj_cl_read(context, &buffer, 0, again, sizeof again), ASJ_OK);
    assert_memory_equal(once, again, sizeof once);
    /* two runs, two reads, one zero; then none */
    const int32_t used = asj_cl_get_times(context, times, 64);
    assert_int_equal(used, 3);
    for (int32_t i = 0; i < used; i++) {
        assert_int_equal(times[i].runs, strcmp(times[i].name, "zero") == 0 ? 1 : 2);
        assert_int_equal(times[i].bytes, strcmp(times[i].name, "check") == 0 ? 0 : sizeof once * times[i].runs);
        assert_true(times[i].ms >= 0);
    }
    assert_int_equal(asj_cl_get_times(context, NULL, 0), 3);
    assert_int_equal(asj_cl_profile(context, 1), ASJ_OK);
    assert_int_equal(asj_cl_get_times(context, times, 64), 0);
    assert_int_equal(asj_cl_profile(context, 0), ASJ_OK);
    assert_int_equal(asj_cl_write(context, &buffer, 0, once, sizeof once), ASJ_OK);
    assert_int_equal(asj_cl_get_times(context, times, 64), 0);
    assert_int_equal(asj_cl_kernel_limits(context, "check", &most, &multiple), ASJ_OK);
    assert_true(most >= 1 && multiple >= 1);
    assert_int_equal(asj_cl_kernel_limits(context, "check", NULL, NULL), ASJ_OK);
    asj_cl_release(context, &buffer);
    unit_context_free(&counter, &context);
}

static void test_failures(void **state)
{
    asj_cl_buffer buffer = {0};
    uint32_t number = 0;
    size_t global = 64, local = (size_t)1 << 40;
    (void)state;
    asj_context *context = open_device();
    const char *device = asj_context_device(context);
    assert_int_equal(asj_cl_reserve(context, &buffer, SIZE_MAX), ASJ_ERROR_DEVICE);
    assert_true(!buffer.memory && buffer.size == 0);
    assert_non_null(strstr(asj_context_message(context), "CL_INVALID_BUFFER_SIZE"));
    assert_non_null(strstr(asj_context_message(context), device));
    assert_int_equal(heard.lines[ASJ_LOG_ERROR], 1);
    assert_int_equal(asj_cl_reserve(context, &buffer, sizeof number), ASJ_OK);
    assert_int_equal(asj_cl_write(context, &buffer, 1, &number, sizeof number), ASJ_ERROR_DEVICE);
    assert_non_null(strstr(asj_context_message(context), "clEnqueueWriteBuffer"));
    assert_int_equal(asj_cl_read(context, &buffer, 4, &number, 1), ASJ_ERROR_DEVICE);
    assert_non_null(strstr(asj_context_message(context), "clEnqueueReadBuffer"));
    const asj_cl_argument arguments[] = {ASJ_CL_BUFFER(&buffer), ASJ_CL_INT(1), ASJ_CL_INT(2)};
    const asj_cl_arguments first = {arguments, 1};
    const asj_cl_argument wrong[] = {ASJ_CL_STRUCT(&number, 3)};
    assert_int_equal(asj_cl_run(context, "no_such_kernel", 1, &global, NULL, first), ASJ_ERROR_DEVICE);
    assert_non_null(strstr(asj_context_message(context), "no_such_kernel"));
    assert_int_equal(asj_cl_run(context, "check", 1, &global, NULL, ASJ_CL_ARGUMENTS(arguments)), ASJ_ERROR_DEVICE);
    assert_non_null(strstr(asj_context_message(context), "clSetKernelArg(check, 1): CL_INVALID_ARG_INDEX"));
    assert_int_equal(asj_cl_run(context, "check", 1, &global, NULL, ASJ_CL_ARGUMENTS(wrong)), ASJ_ERROR_DEVICE);
    assert_non_null(strstr(asj_context_message(context), "CL_INVALID_ARG_SIZE"));
    assert_int_equal(asj_cl_run(context, "check", 1, &global, &local, first), ASJ_ERROR_DEVICE);
    assert_non_null(strstr(asj_context_message(context), "clEnqueueNDRangeKernel(check): CL_INVALID_WORK_"));
    asj_cl_release(context, &buffer);
    unit_context_free(&counter, &context);
}

/* Memory that runs out while a context is made and a picture worked on. */
static void test_memory(void **state)
{
    asj_status status = ASJ_ERROR_MEMORY;
    long n = 1;
    (void)state;
    for (; status != ASJ_OK && n < 2000; n++) {
        asj_context_options options;
        asj_context *context = NULL;
        asj_context_options_init(&options);
        counter = (unit_counter){0, 0, n, 0};
        options.backend = ASJ_BACKEND_OPENCL;
        options.threads = 2;
        options.allocator = (asj_allocator){unit_allocate, unit_release, &counter};
        options.kernel_cache = (asj_kernel_cache){store_get, store_put, &kept};
        status = asj_context_create(&options, &context);
        assert_true(status == ASJ_OK ? context != NULL : !context);
        if (status == ASJ_OK)
            status = asj_prepare(context, NULL, 48, 40);
        assert_true(status == ASJ_OK || status == ASJ_ERROR_MEMORY);
        if (counter.calls >= n && status == ASJ_OK)
            status = ASJ_ERROR_MEMORY; /* what a cache does not get is no error: there may be more to come */
        asj_context_free(&context);
        assert_int_equal(counter.live, 0);
    }
    assert_in_range(n, 10, 1999);
}

/* ---- the local field ---- */

/* How often a kernel has run since the measurement began. */
static uint64_t runs_of(const asj_context *context, const char *kernel)
{
    asj_cl_time times[64];
    const int32_t count = asj_cl_get_times(context, times, 64);
    uint64_t runs = 0;
    for (int32_t i = 0; i < count && i < 64; i++)
        runs += strcmp(times[i].name, kernel) == 0 ? times[i].runs : 0;
    return runs;
}

/* Computed there, at once or in as many bands as the device's memory asks for, and the same as on the CPU. */
static void test_local_field(void **state)
{
    enum { WIDTH = 70, HEIGHT = 90 };
    static asj_local_branch here[WIDTH * HEIGHT][ASJ_FIELD_BRANCHES], there[WIDTH * HEIGHT][ASJ_FIELD_BRANCHES];
    static uint8_t pixels[WIDTH * HEIGHT];
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0};
    asj_context_options options;
    asj_context *cpu = NULL;
    (void)state;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        pixels[i] = (uint8_t)(30 + 3 * (i * 7 % 5) + (i % WIDTH > 31 ? 90 : 0) + (i / WIDTH > 40 ? 60 : 0));
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    assert_int_equal(asj_context_create(&options, &cpu), ASJ_OK);
    assert_int_equal(asj_local_field(cpu, &image, NULL, here[0]), ASJ_OK);
    asj_context_free(&cpu);

    asj_context *context = open_device();
    const char *kernel = asj_cl_get_limits(context)->type == ASJ_DEVICE_CPU ? "scan_runs" : "scan_pixels";
    for (int bands = 1; bands <= 2; bands++) {
        memset(there, 0, sizeof there);
        if (bands == 2) /* a quarter of it holds the branches of 50 rows */
            context->cl->limits.global_memory = (uint64_t)4 * 50 * 80 * ASJ_FIELD_BRANCHES * sizeof(uint32_t);
        assert_int_equal(asj_cl_profile(context, 1), ASJ_OK);
        assert_int_equal(asj_local_field(context, &image, NULL, there[0]), ASJ_OK);
        assert_int_equal(runs_of(context, kernel), bands);
        assert_memory_equal(here, there, sizeof here);
    }
    unit_context_free(&counter, &context);
}

/* ---- images larger than the device ---- */

enum { LARGE_WIDTH = 200, LARGE_HEIGHT = 300 };

/* Tiles of two grey levels, a little turned, so that edges run through many bands. */
static void draw_tiles(uint8_t *pixels)
{
    for (int y = 0; y < LARGE_HEIGHT; y++)
        for (int x = 0; x < LARGE_WIDTH; x++) {
            const int right = (4 * x + y + 700) / 360, down = (4 * y - x + 700) / 520;
            pixels[y * LARGE_WIDTH + x] = (uint8_t)((right + down) % 2 ? 190 + (3 * x + 5 * y) % 7 : 60 + (2 * x + 7 * y) % 5);
        }
}

/* Rays are walked on the device, in as many bands of rows as its memory asks for, and the same as on the CPU. */
static void test_bands_of_rays(void **state)
{
    static uint8_t pixels[LARGE_WIDTH * LARGE_HEIGHT];
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, LARGE_WIDTH, LARGE_HEIGHT, 0, 0};
    asj_detect_options detect;
    asj_context_options options;
    asj_context *cpu = NULL;
    asj_detection *here = NULL, *there = NULL;
    uint64_t whole = 0;
    (void)state;
    draw_tiles(pixels);
    asj_detect_options_init(&detect);
    detect.octaves = 1;
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    assert_int_equal(asj_context_create(&options, &cpu), ASJ_OK);
    assert_int_equal(asj_detect(cpu, &image, &detect, &here), ASJ_OK);
    assert_in_range(here->junction_count, 8, 100);

    asj_context *context = open_device();
    for (int bands = 0; bands < 2; bands++) {
        if (bands) /* an eighth of it holds a plane of 40 rows and the margins */
            context->cl->limits.global_memory = (uint64_t)8 * (40 + 2 * ASJ_MARGIN + 1) * 272 * sizeof(int16_t);
        assert_int_equal(asj_cl_profile(context, 1), ASJ_OK);
        assert_int_equal(asj_detect_into(context, &image, &detect, &there), ASJ_OK);
        assert_int_equal(there->junction_count, here->junction_count);
        assert_memory_equal(there->junctions, here->junctions, here->junction_count * sizeof *here->junctions);
        if (bands)
            assert_true(runs_of(context, "scan_walk") > whole + 20); /* 14 bands, down and up */
        whole = runs_of(context, "scan_walk");
        assert_true(whole >= 2);
    }
    asj_detection_free(&there);
    asj_detection_free(&here);
    asj_context_free(&cpu);
    unit_context_free(&counter, &context);
}

/* ---- back to the CPU ---- */

static asj_status fail_gradient(asj_context *context, asj_frame *frame, const asj_detect_options *options)
{
    (void)frame;
    (void)options;
    return asj_fail(context, ASJ_ERROR_DEVICE, "the device has %s", "gone");
}

static uint8_t *picture(void)
{
    synth_scene scene;
    synth_scene_init(&scene, 100, 90, 110);
    synth_add_rectangle(&scene, (synth_point){40, 42}, 31, 26, 0.2, 170);
    return unit_picture(&scene, 1, 2, 4);
}

static void test_restart(void **state)
{
    uint8_t *pixels = picture();
    const asj_image image = unit_gray8(pixels, 100, 90);
    asj_detection *found = NULL, *expected = NULL;
    (void)state;
    unit_counter other;
    asj_context *context = unit_context(&other, 2);
    assert_int_equal(asj_detect(context, &image, NULL, &expected), ASJ_OK);
    assert_true(expected->junction_count >= 4);
    assert_int_equal(expected->backend, ASJ_BACKEND_CPU);
    asj_context_free(&context);

    context = open_device();
    context->ops->gradient->planes = fail_gradient;
    assert_int_equal(asj_detect(context, &image, NULL, &found), ASJ_ERROR_DEVICE); /* it was asked for */
    assert_string_equal(asj_context_message(context), "the device has gone");
    assert_int_equal(heard.lines[ASJ_LOG_ERROR], 1);
    memset(&heard, 0, sizeof heard);

    context->options.backend = ASJ_BACKEND_AUTO;
    for (int i = 1; i <= 4; i++) {
        assert_int_equal(asj_context_backend(context), i <= 3 ? ASJ_BACKEND_OPENCL : ASJ_BACKEND_CPU);
        assert_int_equal(asj_detect(context, &image, NULL, &found), ASJ_OK);
        assert_int_equal(found->backend, ASJ_BACKEND_CPU);
        assert_int_equal(found->junction_count, expected->junction_count);
        assert_memory_equal(found->junctions, expected->junctions, found->junction_count * sizeof *found->junctions);
        asj_detection_free(&found);
        assert_int_equal(heard.lines[ASJ_LOG_WARNING], i <= 3 ? i : 3);
        assert_int_equal(heard.lines[ASJ_LOG_ERROR], 0);
        assert_non_null(strstr(heard.text, "the device has gone"));
        assert_string_equal(asj_context_message(context), "");
    }
    assert_null(asj_context_device(context));
    unit_context_free(&counter, &context);
    asj_detection_free(&expected);
    assert_int_equal(other.live, 0);
    free(pixels);
}

int main(void)
{
    const struct CMUnitTest anywhere[] = {cmocka_unit_test(test_keys), cmocka_unit_test(test_entries)};
    const struct CMUnitTest on_a_device[] = {
        cmocka_unit_test(test_open), cmocka_unit_test(test_store),    cmocka_unit_test(test_driver_store),
        cmocka_unit_test(test_transfers),
        cmocka_unit_test(test_runs), cmocka_unit_test(test_failures), cmocka_unit_test(test_memory),
        cmocka_unit_test(test_local_field), cmocka_unit_test(test_bands_of_rays), cmocka_unit_test(test_restart),
    };
    asj_device_list *list = NULL;
    uint32_t usable = 0;
    int failed = cmocka_run_group_tests(anywhere, NULL, NULL);
    if (asj_device_list_create(NULL, &list) != ASJ_OK)
        return 1;
    for (uint32_t i = 0; i < list->count; i++)
        usable += list->devices[i].usable != 0;
    if (usable > 0) {
        failed += cmocka_run_group_tests(on_a_device, NULL, NULL);
    } else {
        printf("%s: %s\n", getenv("ASJ_REQUIRE_OPENCL") ? "FAILED" : "SKIPPED",
               list->count > 0 ? list->devices[0].reason : list->message);
        failed = failed || getenv("ASJ_REQUIRE_OPENCL") ? 1 : 77;
    }
    asj_device_list_free(&list);
    for (int i = 0; i < kept.count; i++)
        free(kept.entries[i].data);
    return failed;
}
