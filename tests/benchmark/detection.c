/* SPDX-License-Identifier: BSD-2-Clause */
/* Time of every stage of the detector, and its memory, on the sample room at several sizes: README.md here. */
#define _POSIX_C_SOURCE 200809L

#include "measure.h"
#include "memory_use.h"
#include "profile.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STAGES (ASJ_STAGE_DECOMPOSE + 1)
#define TOTAL STAGES
#define MAX_RUNS 99
#define MAX_SIZES 16
#define MAX_THREADS 8

typedef struct size {
    int32_t width, height;
} size;

typedef struct settings {
    size sizes[MAX_SIZES];
    int32_t threads[MAX_THREADS];
    int32_t size_count, thread_count, runs;
    int profile;
    asj_detect_options options;
} settings;

typedef struct measured {
    size size;
    int32_t threads;
    uint32_t junctions;
    double ms[STAGES + 1]; /* medians; the last one is the whole call */
    uint64_t context;      /* bytes: the most that the context has held */
    uint64_t process;      /* bytes: growth of the process while the first call ran; 0 = not known */
} measured;

static const char help[] =
    "usage: detection [--size WIDTHxHEIGHT]... [--threads N]... [--runs N] [--profile] [--quick] [key=value ...]\n"
    "\n"
    "Detects the junctions of the sample room, rendered at each size, and prints milliseconds for each stage: the medians of N\n"
    "runs (5 unless asked otherwise, 3 beyond 8 megapixels) after one that is not counted. key=value sets a detector option.\n"
    "--profile: for 1052 x 780, how far each stage is from the machine's bandwidth and peak. --quick: a small image, two runs.\n"
    "\n"
    "context   bytes per pixel that the library has taken from its allocator at most, results apart (asj_context_memory)\n"
    "process   bytes per pixel by which the resident memory of the process has grown at most during the first call, the image and\n"
    "          the context not counted (VmHWM of /proc/self/status; Linux only)\n";

static int fail(const char *what)
{
    fprintf(stderr, "detection: %s\n", what);
    return -1;
}

/* Run -1 is not counted: it warms up, and its memory is measured. */
static int run_all(asj_context *context, const asj_image *image, const settings *set, int32_t runs, measured *m)
{
    double ms[STAGES + 1][MAX_RUNS];
    for (int32_t run = -1; run < runs; run++) {
        asj_detection *found = NULL;
        const uint64_t before = run < 0 ? memory_use_reset() : 0;
        if (asj_detect(context, image, &set->options, &found) != ASJ_OK)
            return fail(asj_context_message(context));
        if (run < 0) {
            const uint64_t peak = memory_use_peak();
            m->process = before && peak > before ? peak - before : 0;
            m->junctions = found->junction_count;
        } else {
            ms[TOTAL][run] = found->total_ms;
            for (int s = 0; s < STAGES; s++)
                ms[s][run] = found->stage_ms[s];
        }
        asj_detection_free(&found);
    }
    for (int s = 0; s <= STAGES; s++)
        m->ms[s] = measure_median(ms[s], runs);
    asj_context_memory(context, NULL, &m->context);
    return 0;
}

static int measure(const uint8_t *pixels, const settings *set, measured *m)
{
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, m->size.width, m->size.height, 0, 0};
    const int large = (int64_t)m->size.width * m->size.height > 8000000;
    asj_context *context = measure_context(m->threads);
    if (!context)
        return fail("cannot make a context");
    m->threads = asj_context_threads(context); /* 1 in a build without threads */
    const int result = run_all(context, &image, set, set->runs ? set->runs : large ? 3 : 5, m);
    asj_context_free(&context);
    return result;
}

static double pixels_of(const measured *m)
{
    return (double)m->size.width * m->size.height;
}

static void print_header(void)
{
    printf("libasj %s, sample room, ms (medians)\n\n%-10s %6s %3s", asj_version_string(), "size", "Mpx", "thr");
    for (int s = 0; s < STAGES; s++)
        printf(" %10s", asj_stage_name(s));
    printf(" %10s %8s %9s %8s %8s\n", "total", "ns/px", "junctions", "context", "process");
}

static void print_row(const measured *m)
{
    char name[32];
    snprintf(name, sizeof name, "%dx%d", (int)m->size.width, (int)m->size.height);
    printf("%-10s %6.2f %3d", name, pixels_of(m) * 1e-6, (int)m->threads);
    for (int s = 0; s <= STAGES; s++)
        printf(" %10.2f", m->ms[s]);
    printf(" %8.1f %9u %6.1f B", m->ms[TOTAL] * 1e6 / pixels_of(m), (unsigned)m->junctions, (double)m->context / pixels_of(m));
    if (m->process)
        printf(" %6.1f B\n", (double)m->process / pixels_of(m));
    else
        printf(" %8s\n", "-");
    fflush(stdout);
}

/* The two largest images tell how memory grows. */
static void print_growth(const measured *small, const measured *large)
{
    const double step = pixels_of(large) - pixels_of(small);
    if (step <= 0.0)
        return;
    const double context = ((double)large->context - (double)small->context) / step;
    printf("context: %.1f bytes per pixel plus %.1f MB", context, ((double)large->context - context * pixels_of(large)) * 1e-6);
    if (small->process && large->process) {
        const double process = ((double)large->process - (double)small->process) / step;
        const double constant = (double)large->process - process * pixels_of(large);
        printf("; process: %.1f bytes per pixel plus %.1f MB", process, constant * 1e-6);
    }
    printf("  (between %.1f and %.1f megapixels, %d thread%s)\n", pixels_of(small) * 1e-6, pixels_of(large) * 1e-6,
           (int)large->threads, large->threads == 1 ? "" : "s");
}

static int run_profile(const settings *set)
{
    int result = 0;
    for (int32_t i = 0; i < set->size_count && result == 0; i++) {
        const asj_image image = {measure_room(0, set->sizes[i].width, set->sizes[i].height), ASJ_FORMAT_GRAY8, set->sizes[i].width,
                                 set->sizes[i].height, 0, 0};
        if (!image.data)
            return fail("cannot render the room");
        for (int32_t t = 0; t < set->thread_count && result == 0; t++) {
            result = profile_print(&image, &set->options, set->threads[t], set->runs ? set->runs : 15);
            printf("\n");
        }
        free((void *)(uintptr_t)image.data);
    }
    return result;
}

static int run_sizes(const settings *set)
{
    measured last[MAX_THREADS], before_last[MAX_THREADS];
    int result = 0;
    print_header();
    for (int32_t i = 0; i < set->size_count && result == 0; i++) {
        uint8_t *pixels = measure_room(0, set->sizes[i].width, set->sizes[i].height);
        if (!pixels)
            return fail("cannot render the room");
        for (int32_t t = 0; t < set->thread_count && result == 0; t++) {
            measured m = {.size = set->sizes[i], .threads = set->threads[t]};
            result = measure(pixels, set, &m);
            if (result == 0)
                print_row(&m);
            before_last[t] = i > 0 ? last[t] : m;
            last[t] = m;
        }
        free(pixels);
    }
    printf("\n");
    for (int32_t t = 0; t < set->thread_count && result == 0; t++)
        print_growth(&before_last[t], &last[t]);
    return result;
}

static int add_size(settings *set, const char *text)
{
    int width, height, used = 0;
    if (set->size_count == MAX_SIZES || sscanf(text, "%dx%d%n", &width, &height, &used) != 2 || text[used] || width < 16 ||
        height < 16 || width > ASJ_MAX_SIDE || height > ASJ_MAX_SIDE)
        return -1;
    set->sizes[set->size_count++] = (size){width, height};
    return 0;
}

static int add_threads(settings *set, const char *text)
{
    return set->thread_count == MAX_THREADS ? -1 : measure_number(text, 1, 256, &set->threads[set->thread_count++]);
}

static int set_option(settings *set, const char *text)
{
    char key[64], message[256];
    const char *value = measure_key_value(text, key);
    if (!value)
        return -1;
    if (asj_detect_options_set(&set->options, key, value, message, sizeof message) == ASJ_OK)
        return 0;
    return fail(message);
}

static void set_defaults(settings *set)
{
    static const size sizes[] = {{640, 480}, {1052, 780}, {2048, 1536}, {4000, 3000}, {8192, 6144}};
    if (set->size_count == 0 && set->profile) {
        set->sizes[set->size_count++] = sizes[1];
    } else if (set->size_count == 0) {
        memcpy(set->sizes, sizes, sizeof sizes);
        set->size_count = sizeof sizes / sizeof *sizes;
    }
    if (set->thread_count == 0) {
        set->threads[0] = 1;
        set->threads[1] = 2;
        set->thread_count = 2;
    }
}

static int parse(int argc, char **argv, settings *set)
{
    static const struct option longs[] = {{"size", 1, NULL, 's'}, {"threads", 1, NULL, 't'}, {"runs", 1, NULL, 'r'},
                                          {"profile", 0, NULL, 'p'}, {"quick", 0, NULL, 'q'}, {NULL, 0, NULL, 0}};
    int c, result = 0;
    while (result == 0 && (c = getopt_long(argc, argv, "", longs, NULL)) != -1) {
        if (c == 'p') {
            set->profile = 1;
        } else if (c == 'q') {
            result = add_size(set, "320x240");
            set->runs = 2;
        } else {
            result = c == 's' ? add_size(set, optarg) : c == 't' ? add_threads(set, optarg) :
                     c == 'r' ? measure_number(optarg, 1, MAX_RUNS, &set->runs) : -1;
        }
    }
    for (; result == 0 && optind < argc; optind++)
        result = set_option(set, argv[optind]);
    set_defaults(set);
    return result;
}

int main(int argc, char **argv)
{
    settings set;
    memset(&set, 0, sizeof set);
    asj_detect_options_init(&set.options);
    if (parse(argc, argv, &set) != 0) {
        fputs(help, stderr);
        return 2;
    }
    return (set.profile ? run_profile(&set) : run_sizes(&set)) == 0 ? 0 : 1;
}
