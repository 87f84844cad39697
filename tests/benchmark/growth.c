/* SPDX-License-Identifier: BSD-2-Clause */
/* How time and memory grow with the pixels of an image and with the number of L-junctions. */
#define _POSIX_C_SOURCE 200809L

#include "growth_plot.h"
#include "measure.h"
#include "views.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 1052 /* of the images that are matched */
#define HEIGHT 780
#define MAX_RUNS 99
#define LONG 5000  /* ms: what takes longer needs no warming up and no second run */

static const char help[] =
    "usage: growth [--threads N] [--runs N] [--plot FILE] [--quick]\n"
    "\n"
    "Detects in the sample room rendered with 0.1 to 100 megapixels, and matches 10 to 10 000 L-junctions of either of two\n"
    "views of it (1052 x 780; where the room has no more, random ones fill up), with 2 threads unless asked otherwise. Prints\n"
    "medians of N runs (5; 3 beyond 8 megapixels or 2000 L-junctions; what takes longer than 5 s is run once) after one that is\n"
    "not counted, the most memory that the context has held, and the exponents of powers fitted to both. --plot draws them: PNG,\n"
    "SVG or PDF. --quick: only what takes a second or two.\n"
    "Rendering 100 megapixels takes 2 GB of memory.\n";

typedef struct settings {
    int32_t threads, runs;
    int32_t pixel_steps, corner_steps;
    const char *plot;
} settings;

static const double megapixels[] = {0.1, 0.3, 1, 3, 10, 30, 100};
static const size_t corner_counts[] = {10, 30, 100, 300, 1000, 3000, 10000};
#define STEPS 7

enum { PIXELS_TIME, CORNERS_TIME, PIXELS_MEMORY, CORNERS_MEMORY, CURVES };

static int fail(const char *what)
{
    fprintf(stderr, "growth: %s\n", what);
    return -1;
}

static void add(growth_curve *curve, double x, double y)
{
    curve->x[curve->count] = x;
    curve->y[curve->count++] = y;
}

static double context_bytes(const asj_context *context)
{
    uint64_t peak = 0;
    asj_context_memory(context, NULL, &peak);
    return (double)peak;
}

typedef struct timing {
    double times[MAX_RUNS];
    int32_t count, wanted;
    int warm;
} timing;

static void take(timing *t, double ms)
{
    if (t->warm || ms > LONG)
        t->times[t->count++] = ms;
    if (ms > LONG)
        t->wanted = t->count;
    t->warm = 1;
}

/* --- pixels ----------------------------------------------------------------------------------------------------------------- */

static int detect(asj_context *context, const asj_image *image, int32_t runs, double *ms, uint32_t *junctions)
{
    timing t = {.wanted = runs};
    while (t.count < t.wanted) {
        asj_detection *found = NULL;
        if (asj_detect(context, image, NULL, &found) != ASJ_OK)
            return fail(asj_context_message(context));
        take(&t, found->total_ms);
        *junctions = found->junction_count;
        asj_detection_free(&found);
    }
    *ms = measure_median(t.times, t.count);
    return 0;
}

static int one_size(const settings *set, double wanted, growth_curve *time, growth_curve *memory)
{
    const int32_t width = (int32_t)lrint(sqrt(wanted * 1e6 * 4 / 3)), height = (int32_t)lrint(width * 0.75);
    const double pixels = (double)width * height;
    const asj_image image = {measure_room(0, width, height), ASJ_FORMAT_GRAY8, width, height, 0, 0};
    asj_context *context = measure_context(set->threads);
    uint32_t junctions = 0;
    double ms = 0;
    int result = -1;
    if (image.data && context)
        result = detect(context, &image, set->runs ? set->runs : pixels > 8e6 ? 3 : 5, &ms, &junctions);
    else
        fail("no memory");
    if (result == 0) {
        const double bytes = context_bytes(context);
        printf("%7d x %-7d %10.3f %12.2f %9.1f %12.2f %9.1f %10u\n", (int)width, (int)height, pixels * 1e-6, ms, ms * 1e6 / pixels,
               bytes * 1e-6, bytes / pixels, (unsigned)junctions);
        fflush(stdout);
        add(time, pixels * 1e-6, ms);
        add(memory, pixels * 1e-6, bytes * 1e-6);
    }
    asj_context_free(&context);
    free((void *)(uintptr_t)image.data);
    return result;
}

/* --- L-junctions ------------------------------------------------------------------------------------------------------------ */

static int match(asj_context *context, const benchmark_view views[2], int32_t runs, double *ms, uint32_t *matches)
{
    timing t = {.wanted = runs};
    while (t.count < t.wanted) {
        asj_match_result *found = NULL;
        if (asj_match(context, &views[0].image, views[0].list, views[0].count, &views[1].image, views[1].list, views[1].count, NULL,
                      &found) != ASJ_OK)
            return fail(asj_context_message(context));
        take(&t, found->total_ms);
        *matches = found->match_count;
        asj_match_result_free(&found);
    }
    *ms = measure_median(t.times, t.count);
    return 0;
}

/* In a context of its own, so that its memory is that of this number. */
static int one_number(const settings *set, benchmark_view views[2], size_t corners, growth_curve *time, growth_curve *memory)
{
    asj_match_options options;
    asj_context *context = measure_context(set->threads);
    uint32_t matches = 0;
    double ms = 0;
    if (!context)
        return fail("no memory");
    asj_match_options_init(&options);
    for (int v = 0; v < 2; v++)
        benchmark_view_take(&views[v], corners, options.minimum_opening);
    const int result = match(context, views, set->runs ? set->runs : corners > 2000 ? 3 : 5, &ms, &matches);
    if (result == 0) {
        const double bytes = context_bytes(context);
        printf("%25zu %12.2f %9.2f %12.2f %9.1f %10u\n", corners, ms, ms * 1e3 / (double)corners, bytes * 1e-6,
               bytes * 1e-3 / (double)corners, (unsigned)matches);
        fflush(stdout);
        add(time, (double)corners, ms);
        add(memory, (double)corners, bytes * 1e-6);
    }
    asj_context_free(&context);
    return result;
}

static int all_numbers(const settings *set, growth_curve *time, growth_curve *memory)
{
    const size_t most = corner_counts[set->corner_steps - 1];
    asj_context *context = measure_context(set->threads);
    asj_image images[2];
    benchmark_view views[2];
    int result = context ? 0 : fail("no memory");
    memset(views, 0, sizeof views);
    for (int v = 0; v < 2; v++) {
        images[v] = (asj_image){measure_room(v, WIDTH, HEIGHT), ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0};
        if (result == 0 && (!images[v].data || benchmark_view_make(context, &images[v], most, (uint64_t)v + 100, &views[v]) != 0))
            result = fail("no memory");
    }
    asj_context_free(&context);
    for (int32_t i = 0; i < set->corner_steps && result == 0; i++)
        result = one_number(set, views, corner_counts[i], time, memory);
    for (int v = 0; v < 2; v++) {
        benchmark_view_free(&views[v]);
        free((void *)(uintptr_t)images[v].data);
    }
    return result;
}

/* --- all -------------------------------------------------------------------------------------------------------------------- */

static void print_exponents(const growth_curve *curve)
{
    double factor, all, upper;
    growth_fit(curve, 0, &factor, &all);
    growth_fit(curve, curve->count / 2, &factor, &upper);
    printf("%-24s grows with the power %5.2f; from %.3g %s on %5.2f\n", curve->title, all, curve->x[curve->count / 2],
           curve->x_label, upper);
}

static int run(const settings *set)
{
    growth_curve curves[CURVES] = {
        {.title = "time of detection", .x_label = "megapixels", .y_label = "ms"},
        {.title = "time of matching", .x_label = "L-junctions of either image", .y_label = "ms"},
        {.title = "memory of detection", .x_label = "megapixels", .y_label = "MB"},
        {.title = "memory of matching", .x_label = "L-junctions of either image", .y_label = "MB"},
    };
    int result = 0;
    printf("libasj %s, sample room, %d threads, medians\n\n%-17s %10s %12s %9s %12s %9s %10s\n", asj_version_string(),
           (int)set->threads, "detection", "megapixels", "ms", "ns/px", "MB", "bytes/px", "junctions");
    for (int32_t i = 0; i < set->pixel_steps && result == 0; i++)
        result = one_size(set, megapixels[i], &curves[PIXELS_TIME], &curves[PIXELS_MEMORY]);
    printf("\n%-13s %11s %12s %9s %12s %9s %10s\n", "matching", "L-junctions", "ms", "us/each", "MB", "kB/each", "matches");
    if (result == 0)
        result = all_numbers(set, &curves[CORNERS_TIME], &curves[CORNERS_MEMORY]);
    printf("\n");
    for (int i = 0; i < CURVES && result == 0; i++)
        print_exponents(&curves[i]);
    return result == 0 && set->plot ? growth_plot(set->plot, curves) : result;
}

static int parse(int argc, char **argv, settings *set)
{
    static const struct option longs[] = {{"threads", 1, NULL, 't'}, {"runs", 1, NULL, 'r'}, {"plot", 1, NULL, 'p'},
                                          {"quick", 0, NULL, 'q'}, {NULL, 0, NULL, 0}};
    int c, result = 0;
    while (result == 0 && (c = getopt_long(argc, argv, "", longs, NULL)) != -1) {
        if (c == 't') {
            result = measure_number(optarg, 1, 256, &set->threads);
        } else if (c == 'r') {
            result = measure_number(optarg, 1, MAX_RUNS, &set->runs);
        } else if (c == 'p') {
            set->plot = optarg;
        } else if (c == 'q') {
            set->pixel_steps = set->corner_steps = 3;
            set->runs = 1;
        } else {
            result = -1;
        }
    }
    return optind < argc ? -1 : result;
}

int main(int argc, char **argv)
{
    settings set = {.threads = 2, .pixel_steps = STEPS, .corner_steps = STEPS};
    if (parse(argc, argv, &set) != 0) {
        fputs(help, stderr);
        return 2;
    }
    return run(&set) == 0 ? 0 : 1;
}
