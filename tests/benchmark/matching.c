/* SPDX-License-Identifier: BSD-2-Clause */
/* Time of the matcher on two views of the sample room: the whole call for several numbers of L-junctions a side, and what its
 * parts do in a second. Detection is not counted. */
#define _POSIX_C_SOURCE 200809L

#include "match/align.h"
#include "match/describe.h"
#include "match/image_features.h"
#include "match/l_junctions_create.h"
#include "match/match_options.h"
#include "match/shortlist.h"
#include "measure.h"
#include "views.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define WIDTH 1052
#define HEIGHT 780
#define MAX_RUNS 99
#define MAX_SIZES 16

static const char help[] =
    "usage: matching [--corners N]... [--threads N] [--runs N] [key=value ...]\n"
    "\n"
    "Matches two views of the sample room, 1052 x 780, with the N most meaningful L-junctions of either (50, 500 and 5000 unless\n"
    "asked otherwise; where the room has fewer, random ones fill up), and prints milliseconds for each stage: medians of so many\n"
    "runs (7) after one that is not counted, the least total, and the least of all threads' time. Then what the parts do in a\n"
    "second. key=value sets an option of the matcher; 2 threads unless asked otherwise.\n";

typedef struct settings {
    size_t corners[MAX_SIZES];
    int32_t corner_count, threads, runs;
    asj_match_options options;
} settings;

static int fail(const char *what)
{
    fprintf(stderr, "matching: %s\n", what);
    return -1;
}

/* --- the whole match -------------------------------------------------------------------------------------------------------- */

enum { PATCHES, DISTANCES, ALIGN, ASSIGN, TOTAL, PARTS };

static int whole(asj_context *context, const benchmark_view sides[2], const settings *set)
{
    static const int32_t stages[] = {ASJ_STAGE_PATCHES, ASJ_STAGE_DISTANCES, ASJ_STAGE_ALIGN, ASJ_STAGE_ASSIGN};
    double ms[PARTS][MAX_RUNS];
    uint32_t counts[3] = {0, 0, 0};
    uint64_t candidates = 0;
    double work = 0;
    for (int32_t run = -1; run < set->runs; run++) {
        asj_match_result *result = NULL;
        const clock_t start = clock();
        if (asj_match(context, &sides[0].image, sides[0].list, sides[0].count, &sides[1].image, sides[1].list, sides[1].count,
                      &set->options, &result) != ASJ_OK)
            return fail(asj_context_message(context));
        const double used = (double)(clock() - start) * 1e3 / CLOCKS_PER_SEC;
        work = run < 0 || used < work ? used : work;
        for (int p = 0; run >= 0 && p < PARTS; p++)
            ms[p][run] = p == TOTAL ? result->total_ms : result->stage_ms[stages[p]];
        counts[0] = result->l_junction_count1;
        counts[1] = result->l_junction_count2;
        counts[2] = result->match_count;
        candidates = result->candidates;
        asj_match_result_free(&result);
    }
    printf("%6u %6u", (unsigned)counts[0], (unsigned)counts[1]);
    for (int p = 0; p < PARTS; p++)
        printf(" %9.2f", measure_median(ms[p], set->runs));
    printf(" %9.2f %9.2f %10llu %8u\n", ms[TOTAL][0], work, (unsigned long long)candidates, (unsigned)counts[2]);
    fflush(stdout);
    return 0;
}

/* --- its parts -------------------------------------------------------------------------------------------------------------- */

typedef struct rates {
    double patches, pairs, refinements; /* least milliseconds */
    size_t frames, compared, refined;
} rates;

static void least(double *value, double since)
{
    const double now = asj_clock_ms() - since;
    if (*value <= 0 || now < *value)
        *value = now;
}

static asj_status prepare(asj_context *context, const benchmark_view *s, const settings *set, int32_t which,
                          asj_image_features *features)
{
    const asj_image_junctions input = {s->list, s->count, WIDTH, HEIGHT, which, 0};
    asj_status status = asj_l_junctions_create(context, &set->options, &input, &features->l_junctions);
    return status == ASJ_OK ? asj_pyramid_create(context, &s->image, set->options.smoothing, &features->pyramid) : status;
}

static asj_status one_round(asj_context *context, const settings *set, asj_image_features features[2], rates *r)
{
    asj_match_run run = {.context = context, .options = &set->options, .image = {&features[0], &features[1]}};
    asj_status status = ASJ_OK;
    double start = asj_clock_ms();
    for (int v = 0; v < 2 && status == ASJ_OK; v++) {
        asj_release(&context->memory, features[v].patches);
        asj_release(&context->memory, features[v].usable);
        features[v].patches = NULL;
        features[v].usable = NULL;
        status = asj_describe(context, &set->options, &features[v]);
    }
    least(&r->patches, start);
    start = asj_clock_ms();
    if (status == ASJ_OK)
        status = asj_shortlist(&run);
    least(&r->pairs, start);
    r->refined = run.candidates.count;
    start = asj_clock_ms();
    if (status == ASJ_OK)
        status = asj_align_candidates(&run, &run.candidates);
    least(&r->refinements, start);
    asj_release(&context->memory, run.candidates.list);
    return status;
}

static int parts(asj_context *context, const benchmark_view sides[2], const settings *set)
{
    asj_image_features features[2];
    const asj_l_junctions *in1 = &features[0].l_junctions, *in2 = &features[1].l_junctions;
    rates r;
    asj_status status = ASJ_OK;
    memset(features, 0, sizeof features);
    memset(&r, 0, sizeof r);
    for (int32_t v = 0; v < 2 && status == ASJ_OK; v++)
        status = prepare(context, &sides[v], set, v + 1, &features[v]);
    for (int32_t run = 0; run < set->runs && status == ASJ_OK; run++)
        status = one_round(context, set, features, &r);
    r.frames = (size_t)in1->frame_count + in2->frame_count;
    r.compared = (size_t)in1->count * in2->count;
    if (status == ASJ_OK)
        printf("%6u %6u  %9.0f %9.0f %12.0f   (%zu frames, %zu pairs, %zu refinements)\n", (unsigned)in1->count,
               (unsigned)in2->count, (double)r.frames / r.patches * 1e3, (double)r.compared / r.pairs * 1e3,
               (double)r.refined / r.refinements * 1e3, r.frames, r.compared, r.refined);
    for (int v = 0; v < 2; v++)
        asj_image_features_free(&context->memory, &features[v]);
    return status == ASJ_OK ? 0 : fail(asj_context_message(context));
}

static int make_side(asj_context *context, int32_t index, size_t more, benchmark_view *side)
{
    const asj_image image = {measure_room(index, WIDTH, HEIGHT), ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0};
    if (!image.data)
        return fail("cannot render the room");
    if (benchmark_view_make(context, &image, more, (uint64_t)index + 100, side) != 0)
        return fail("no memory");
    return 0;
}

static void free_side(benchmark_view *side)
{
    void *pixels = (void *)(uintptr_t)side->image.data;
    benchmark_view_free(side);
    free(pixels);
}

/* --- command line ----------------------------------------------------------------------------------------------------------- */

static int run(const settings *set)
{
    asj_context *context = measure_context(set->threads);
    benchmark_view sides[2];
    size_t most = 0;
    int result = 0;
    memset(sides, 0, sizeof sides);
    if (!context)
        return fail("cannot make a context");
    for (int32_t k = 0; k < set->corner_count; k++)
        most = set->corners[k] > most ? set->corners[k] : most;
    for (int32_t v = 0; v < 2 && result == 0; v++)
        result = make_side(context, v, most, &sides[v]);
    printf("libasj %s, sample room %d x %d, %d threads; ms (medians)\n\n%6s %6s %9s %9s %9s %9s %9s %9s %9s %10s %8s\n",
           asj_version_string(), WIDTH, HEIGHT, (int)asj_context_threads(context), "L1", "L2", "patches", "distances", "align",
           "assign", "total", "least", "work", "candidates", "matches");
    for (int pass = 0; pass < 2; pass++) {
        if (pass)
            printf("\n%6s %6s  %9s %9s %12s   each second\n", "L1", "L2", "patches", "pairs", "refinements");
        for (int32_t k = 0; k < set->corner_count && result == 0; k++) {
            for (int v = 0; v < 2; v++)
                benchmark_view_take(&sides[v], set->corners[k], set->options.minimum_opening);
            result = pass == 0 ? whole(context, sides, set) : parts(context, sides, set);
        }
        if (set->options.patches != ASJ_PATCHES_CANONICAL || set->options.align_iterations == 0)
            break; /* no such parts */
    }
    for (int v = 0; v < 2; v++)
        free_side(&sides[v]);
    asj_context_free(&context);
    return result;
}

static int set_option(settings *set, const char *text)
{
    char key[64], message[256];
    const char *value = measure_key_value(text, key);
    if (!value)
        return -1;
    if (asj_match_options_set(&set->options, key, value, message, sizeof message) == ASJ_OK)
        return 0;
    return fail(message);
}

static int parse(int argc, char **argv, settings *set)
{
    static const struct option longs[] = {{"corners", 1, NULL, 'c'}, {"threads", 1, NULL, 't'}, {"runs", 1, NULL, 'r'},
                                          {NULL, 0, NULL, 0}};
    int32_t value = 0;
    int c, result = 0;
    while (result == 0 && (c = getopt_long(argc, argv, "", longs, NULL)) != -1) {
        result = c == 'c' ? measure_number(optarg, 1, 100000, &value) : c == 't' ? measure_number(optarg, 1, 256, &value) :
                 c == 'r' ? measure_number(optarg, 1, MAX_RUNS, &value) : -1;
        if (c == 't')
            set->threads = value;
        else if (c == 'r')
            set->runs = value;
        else if (set->corner_count < MAX_SIZES)
            set->corners[set->corner_count++] = (size_t)value;
    }
    for (; result == 0 && optind < argc; optind++)
        result = set_option(set, argv[optind]);
    return result;
}

int main(int argc, char **argv)
{
    static const size_t usual[] = {50, 500, 5000};
    settings set = {.threads = 2, .runs = 7};
    asj_match_options_init(&set.options);
    if (parse(argc, argv, &set) != 0) {
        fputs(help, stderr);
        return 2;
    }
    if (set.corner_count == 0) {
        memcpy(set.corners, usual, sizeof usual);
        set.corner_count = sizeof usual / sizeof *usual;
    }
    return run(&set) == 0 ? 0 : 1;
}
