/* SPDX-License-Identifier: BSD-2-Clause */
/* Every call of OpenCL fails once: the n-th alone, for every n, and the n-th with all after it, for some; where kernels are
 * compiled, those about programs. A context that asked for OpenCL reports an error, or gives the right result; one that may choose
 * gives the right result in any case. Nothing is left behind: no memory, no object of OpenCL. The same where there is nothing to
 * use: a platform without devices, a library that is none.
 *
 * usage: test_faults PATH-OF-STUB [STEP]. With a step, only the first two calls from each place in the library, and
 * every so many of the others. Exit code 77 = there is no device, unless ASJ_REQUIRE_OPENCL is 1. */
#define _POSIX_C_SOURCE 200809L
#include "core/context.h"
#include "create.h"
#include "stub.h"

#include "work.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
    char key[64];
    void *data;
    size_t size;
} entry;

typedef struct setting {
    const char *name;
    int32_t backend;
    int32_t from_there; /* all calls after the n-th fail too */
    int32_t step;       /* n is 1, 1 + step, .. */
    int32_t work;       /* 0 = only asj_prepare(), without stored kernels */
    const char *counted;/* NULL = all calls, else those with this in their name */
} setting;

static const char *library;
static int32_t step = 1;
static stub_state *stub;
static work_images images;
static work_answer expected;
static entry entries[64];
static size_t entry_count;
static int64_t allocated;
static char heard[4096];
static int warnings;
static int problems;
static int tried; /* contexts that could be used on after a failure; every tenth is */

static void complain(const setting *set, int64_t n, const char *format, ...)
{
    va_list arguments;
    fprintf(stderr, "%s, call %ld (%s): ", set->name, (long)n, stub->failed ? stub->failed : "none failed");
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fprintf(stderr, "\n");
    problems++;
}

/* --- hooks ------------------------------------------------------------------------------------------------------------------ */

static void *allocate(void *user, size_t size)
{
    (void)user;
    void *memory = malloc(size);
    allocated += memory != NULL;
    return memory;
}

static void release(void *user, void *memory)
{
    (void)user;
    allocated--;
    free(memory);
}

static void hear(void *user, int32_t level, const char *message)
{
    const size_t used = strlen(heard);
    (void)user;
    warnings += level == ASJ_LOG_WARNING;
    snprintf(heard + used, sizeof heard - used, "%s\n", message);
}

static size_t get(void *user, const char *key, void *data, size_t capacity)
{
    (void)user;
    for (size_t i = 0; i < entry_count; i++)
        if (strcmp(entries[i].key, key) == 0) {
            if (entries[i].size <= capacity)
                memcpy(data, entries[i].data, entries[i].size);
            return entries[i].size;
        }
    return 0;
}

static void put(void *user, const char *key, const void *data, size_t size)
{
    (void)user;
    for (size_t i = 0; i < entry_count; i++)
        if (strcmp(entries[i].key, key) == 0)
            return;
    entry *e = &entries[entry_count];
    if (entry_count == sizeof entries / sizeof entries[0] || !(e->data = malloc(size)))
        return;
    snprintf(e->key, sizeof e->key, "%s", key);
    memcpy(e->data, data, size);
    e->size = size;
    entry_count++;
}

/* --- work ------------------------------------------------------------------------------------------------------------------- */

static asj_status open_context(const setting *set, asj_context **context)
{
    asj_context_options options;
    asj_context_options_init(&options);
    options.backend = set->backend;
    options.threads = 1;
    options.allocator = (asj_allocator){allocate, release, NULL};
    options.log = hear;
    options.log_level = ASJ_LOG_WARNING;
    options.kernel_cache = (asj_kernel_cache){set->work ? get : NULL, put, NULL};
    return asj_context_create_from(library, &options, context);
}

/* --- one failure ------------------------------------------------------------------------------------------------------------ */

static void tell_stub(const setting *set, int64_t n)
{
    memset(stub->live, 0, sizeof stub->live);
    stub->calls = stub->failures = 0;
    stub->failed = NULL;
    stub->fail_at = n;
    stub->fail_from_there = set->from_there;
    stub->all_are_gpus = set->backend == ASJ_BACKEND_AUTO;
    stub->counted = set->counted;
    allocated = 0;
    heard[0] = '\0';
    warnings = 0;
}

static void check_status(const setting *set, int64_t n, asj_status status, const asj_context *context)
{
    const char *said = context ? asj_context_message(context) : heard;
    if (status == ASJ_OK)
        return;
    if (set->backend == ASJ_BACKEND_AUTO || status != ASJ_ERROR_DEVICE)
        complain(set, n, "status %d: %s", (int)status, said);
    if (!*said)
        complain(set, n, "an error without a message");
    if (stub->failures == 0)
        complain(set, n, "an error although nothing failed: %s", said);
}

static void check_rest(const setting *set, int64_t n)
{
    static const char *const kinds[STUB_KINDS] = {"contexts", "queues", "buffers", "programs", "kernels", "events"};
    for (int kind = 0; kind < STUB_KINDS; kind++)
        if (stub->live[kind] != 0)
            complain(set, n, "%ld %s are left", (long)stub->live[kind], kinds[kind]);
    if (allocated != 0)
        complain(set, n, "%ld blocks of memory are left", (long)allocated);
    if (warnings > 3)
        complain(set, n, "%d warnings: %s", warnings, heard);
}

/* After an error the context must go on as if nothing had happened, once the device does. */
static void try_again(const setting *set, int64_t n, asj_context *context)
{
    work_answer a;
    stub->fail_at = 0;
    const asj_status status = work_run(context, &images, &a);
    if (status != ASJ_OK)
        complain(set, n, "afterwards: %s", asj_context_message(context));
    else if (!work_same(&a, &expected))
        complain(set, n, "afterwards: another result");
    work_forget(&a);
}

/* Returns whether a call has failed. */
static int one_failure(const setting *set, int64_t n)
{
    asj_context *context = NULL;
    work_answer a;
    memset(&a, 0, sizeof a);
    tell_stub(set, n);
    asj_status status = open_context(set, &context);
    if (status == ASJ_OK && !set->work)
        status = asj_prepare(context, NULL, WORK_WIDTH, WORK_HEIGHT);
    if (status == ASJ_OK && set->work)
        status = work_run(context, &images, &a);
    check_status(set, n, status, context);
    if (status == ASJ_OK && set->work && !work_same(&a, &expected))
        complain(set, n, "another result");
    if (context && set->work && n > 0 && ++tried % 10 == 0)
        try_again(set, n, context);
    work_forget(&a);
    const int failed = stub->failures > 0;
    asj_context_free(&context);
    check_rest(set, n);
    return failed || stub->failures > 0;
}

/* --- all failures ----------------------------------------------------------------------------------------------------------- */

/* Calls of a run without failures: where they come from. */
static const void *sites[STUB_SITES];
static int64_t traced;

static void trace(const setting *set)
{
    one_failure(set, 0);
    traced = stub->calls < STUB_SITES ? stub->calls : STUB_SITES;
    memcpy(sites, stub->sites, (size_t)traced * sizeof *sites);
}

/* Is call n among the first two that come from its place in the library? */
static int is_new(int64_t n)
{
    int before = 0;
    for (int64_t i = 0; i < n - 1 && n <= traced; i++)
        before += sites[i] == sites[n - 1];
    return before < 2;
}

/* The next call that is to fail. With a step, all that are new, and every so many of the others. */
static int64_t next(const setting *set, int64_t n)
{
    do
        n += set->step;
    while (n <= traced && (n - 1) / set->step % step != 0 && !is_new(n));
    return n;
}

static void all_failures(const setting *set)
{
    const double start = asj_clock_ms();
    int64_t n = 1, failures = 0;
    traced = 0;
    if (step > 1)
        trace(set);
    for (; one_failure(set, n) && problems < 20; n = next(set, n))
        failures++;
    printf("%-32s %5ld calls, %4ld failed, %7.0f ms\n", set->name, (long)(n - 1), (long)failures, asj_clock_ms() - start);
    fflush(stdout);
}

/* --- nothing to use --------------------------------------------------------------------------------------------------------- */

/* Choosing gives the CPU's result in silence, insisting an error that says why. */
static void nothing_to_use(const char *name, const char *reason)
{
    const setting choose = {name, ASJ_BACKEND_AUTO, 0, 1, 1, NULL}, insist = {name, ASJ_BACKEND_OPENCL, 0, 1, 1, NULL};
    asj_context *context = NULL;
    work_answer a;
    memset(&a, 0, sizeof a);
    tell_stub(&choose, 0);
    if (open_context(&choose, &context) != ASJ_OK || work_run(context, &images, &a) != ASJ_OK || !work_same(&a, &expected))
        complain(&choose, 0, "no result: %s", heard);
    if (*heard || a.backend != ASJ_BACKEND_CPU)
        complain(&choose, 0, "not the CPU in silence: %s", heard);
    work_forget(&a);
    asj_context_free(&context);
    check_rest(&choose, 0);
    tell_stub(&insist, 0);
    if (open_context(&insist, &context) != ASJ_ERROR_DEVICE || context || !strstr(heard, reason))
        complain(&insist, 0, "not an error about '%s': %s", reason, heard);
    check_rest(&insist, 0);
}

static void all_that_is_nothing(void)
{
    const char *const whole = library;
    stub->no_devices = 1;
    nothing_to_use("a platform without devices", "has no devices");
    stub->no_devices = 0;
    library = "libm.so.6";
    nothing_to_use("a library without OpenCL", "libm.so.6 has no cl");
    library = "/nonexistent/libOpenCL.so.1";
    nothing_to_use("no library", "no OpenCL library");
    library = whole;
}

/* --- beginning and end ------------------------------------------------------------------------------------------------------ */

static int find_stub(void)
{
    void *handle = dlopen(library, RTLD_NOW), *symbol = handle ? dlsym(handle, "stub_get_state") : NULL;
    stub_getter getter;
    if (!symbol) {
        fprintf(stderr, "%s\n", dlerror());
        return -1;
    }
    memcpy(&getter, &symbol, sizeof symbol);
    stub = getter();
    return 0;
}

/* What the CPU says, and the device without failures, which also fills the store of kernels. */
static int make_expected(void)
{
    static const setting on_cpu = {"cpu", ASJ_BACKEND_CPU, 0, 1, 1, NULL},
                         on_device = {"opencl", ASJ_BACKEND_OPENCL, 0, 1, 1, NULL};
    asj_context *context = NULL;
    work_answer a;
    tell_stub(&on_cpu, 0);
    if (open_context(&on_cpu, &context) != ASJ_OK || work_run(context, &images, &expected) != ASJ_OK || expected.counts[0] < 6 ||
        expected.match_count < 4) {
        fprintf(stderr, "the CPU finds %zu junctions and %zu matches\n", expected.counts[0], expected.match_count);
        return 99;
    }
    asj_context_free(&context);
    tell_stub(&on_device, 0);
    if (!stub->loaded || open_context(&on_device, &context) != ASJ_OK) {
        printf("there is no OpenCL device: %s\n", heard);
        return work_without_device();
    }
    if (work_run(context, &images, &a) != ASJ_OK || !work_same(&a, &expected) || a.backend != ASJ_BACKEND_OPENCL)
        complain(&on_device, 0, "not the result of the CPU: %s", asj_context_message(context));
    work_forget(&a);
    asj_context_free(&context);
    check_rest(&on_device, 0);
    return problems ? 1 : 0;
}

int main(int argc, char **argv)
{
    static const setting settings[] = {
        {"opencl, compiled, one call", ASJ_BACKEND_OPENCL, 0, 1, 0, "Program"},
        {"opencl, one call", ASJ_BACKEND_OPENCL, 0, 1, 1, NULL},
        {"opencl, from there on", ASJ_BACKEND_OPENCL, 1, 5, 1, NULL},
        {"auto, one call", ASJ_BACKEND_AUTO, 0, 1, 1, NULL},
        {"auto, from there on", ASJ_BACKEND_AUTO, 1, 5, 1, NULL},
    };
    if (argc == 3)
        step = (int32_t)strtol(argv[2], NULL, 10);
    if (argc < 2 || argc > 3 || step < 1) {
        fprintf(stderr, "usage: test_faults PATH-OF-STUB [STEP]\n");
        return 2;
    }
    library = argv[1];
    if (find_stub() != 0 || work_images_make(&images) != 0)
        return 99;
    int result = make_expected();
    if (result == 0)
        all_that_is_nothing();
    for (size_t i = 0; i < sizeof settings / sizeof settings[0] && result == 0 && problems < 20; i++)
        all_failures(&settings[i]);
    for (size_t i = 0; i < entry_count; i++)
        free(entries[i].data);
    work_images_free(&images);
    work_forget(&expected);
    return result ? result : problems > 0;
}
