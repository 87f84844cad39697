/* SPDX-License-Identifier: BSD-2-Clause */
/* Time of two-view geometry, part by part, on rendered rooms seen from far apart whose cameras are known: what the matcher does for
 * `--geometry auto` once it has the features of both images (src/match/two_view.c). */
#define _POSIX_C_SOURCE 200809L

#include "geometry/estimate.h"
#include "match/align.h"
#include "match/consensus.h"
#include "match/geometry_candidate.h"
#include "match/image_features.h"
#include "match/match_options.h"
#include "match/prior.h"
#include "match/room_directions.h"
#include "match/shown_pictures.h"
#include "match/support.h"
#include "match/wide_shortlist.h"
#include "measure.h"
#include "views.h"
#include "wide_pair.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define MAX_RUNS 99
#define SHORTLIST 16 /* two_view.c */

static const char help[] =
    "usage: geometry [--corners N] [--first SEED] [--last SEED] [--threads N] [--runs N] [--seed N]\n"
    "\n"
    "For rendered rooms seen from far apart (seeds 0 to 9) with the N (200) most meaningful L-junctions a side (random ones fill\n"
    "up), milliseconds of each part of the geometry: lists of 16 candidates compared, aligned and supported; their priors; the\n"
    "directions that each image shows; the estimation, and all threads' time of it. Medians of so many runs (5) after one that is\n"
    "not counted, and the mean over the rooms. 2 threads unless asked otherwise.\n";

enum { CANDIDATES, PRIORS, DIRECTIONS, ESTIMATE, WORK, PARTS };

typedef struct settings {
    int32_t corners, first, last, threads, runs, seed;
} settings;

typedef struct scene {
    benchmark_view sides[2];
    asj_image_features features[2];
    asj_match_options options;
} scene;

static int fail(const char *what)
{
    fprintf(stderr, "geometry: %s\n", what);
    return -1;
}

/* --- one estimation, step by step -------------------------------------------------------------------------------------------- */

typedef struct steps {
    asj_match_run run;
    asj_geometry_candidate *given;
    double *probability, *colours;
    asj_geometry_hints hints;
    asj_shown_pictures shown;
    asj_geometry found;
} steps;

static void free_steps(asj_memory *memory, steps *s)
{
    asj_release(memory, s->run.candidates.list);
    asj_wide_shortlist_free(&s->run);
    asj_shown_pictures_free(memory, &s->shown);
    asj_support_free(memory, &s->run.support);
    asj_release(memory, s->given);
    asj_release(memory, s->probability);
    asj_release(memory, s->colours);
}

static asj_status make_candidates(steps *s)
{
    asj_status status = asj_wide_shortlist(&s->run);
    if (status == ASJ_OK)
        status = asj_align_candidates(&s->run, &s->run.candidates);
    if (status == ASJ_OK)
        status = asj_support_find(&s->run);
    return status == ASJ_OK ? asj_consensus(&s->run) : status;
}

static asj_status make_priors(steps *s)
{
    asj_memory *memory = &s->run.context->memory;
    const size_t count = s->run.candidates.count;
    s->given = asj_allocate(memory, count, sizeof *s->given);
    s->probability = asj_allocate(memory, count, sizeof *s->probability);
    s->colours = asj_allocate(memory, count, sizeof *s->colours);
    if (!s->given || !s->probability || !s->colours)
        return ASJ_ERROR_MEMORY;
    const asj_status status = asj_candidate_priors(&s->run, s->probability, s->colours);
    size_t kept = 0;
    for (size_t k = 0; k < count && status == ASJ_OK; k++) {
        const asj_candidate *c = &s->run.candidates.list[k];
        if (!asj_keeps_area(c->map.to))
            continue;
        s->given[kept] = asj_candidate_for_geometry(&s->run, c, s->probability[k]);
        s->colours[kept++] = s->colours[k];
    }
    s->run.candidates.count = kept;
    s->hints.colours = s->run.image[0]->colours && s->run.image[1]->colours ? s->colours : NULL;
    return status == ASJ_OK ? asj_show_pictures(&s->run, &s->shown, s->hints.pictures) : status;
}

static asj_status find_directions(steps *s)
{
    const asj_camera *cameras = s->run.options->geometry.cameras;
    return asj_room_directions(s->run.context, s->run.image, cameras, s->hints.directions);
}

static asj_status estimate(steps *s)
{
    asj_judge judge;
    return asj_estimate_with_hints(s->run.context, s->given, s->run.candidates.count, &s->hints, &s->run.options->geometry,
                                   s->probability, &judge, &s->found);
}

static asj_status one_round(asj_context *context, const scene *in, steps *s, double ms[PARTS])
{
    static asj_status (*const parts[WORK])(steps *) = {make_candidates, make_priors, find_directions, estimate};
    asj_status status = ASJ_OK;
    memset(s, 0, sizeof *s);
    s->run = (asj_match_run){.context = context, .options = &in->options, .image = {&in->features[0], &in->features[1]}};
    for (int p = 0; p < WORK && status == ASJ_OK; p++) {
        const double start = asj_clock_ms();
        const clock_t used = clock();
        status = parts[p](s);
        ms[p] = asj_clock_ms() - start;
        ms[WORK] = (double)(clock() - used) * 1e3 / CLOCKS_PER_SEC;
    }
    return status;
}

/* --- a room ------------------------------------------------------------------------------------------------------------------- */

static void free_scene(asj_context *context, scene *in)
{
    for (int32_t v = 0; v < 2; v++) {
        asj_image_features_free(&context->memory, &in->features[v]);
        free((void *)(uintptr_t)in->sides[v].image.data);
        benchmark_view_free(&in->sides[v]);
    }
}

static int make_side(asj_context *context, const settings *set, const synth_wide_pair *pair, int32_t v, scene *in)
{
    const double f = pair->cameras[v].focal;
    benchmark_view *side = &in->sides[v];
    const asj_image image = {synth_wide_picture(pair, v), ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
    if (!image.data)
        return fail("no memory for a picture");
    if (benchmark_view_make(context, &image, (size_t)set->corners, pair->seed + 100 * (uint64_t)v, side) != 0) {
        side->image = image;
        return fail("no memory");
    }
    benchmark_view_take(side, (size_t)set->corners, in->options.minimum_opening);
    in->options.geometry.cameras[v] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    in->options.geometry.widths[v] = SYNTH_WIDE_WIDTH;
    in->options.geometry.heights[v] = SYNTH_WIDE_HEIGHT;
    asj_status status = asj_image_features_create(context, &in->options, &image, side->list, side->count, v + 1, 0,
                                                  &in->features[v]);
    if (status == ASJ_OK)
        status = asj_image_features_add_colours(context, &image, &in->features[v]);
    return status == ASJ_OK ? 0 : fail(asj_context_message(context));
}

static int measure(asj_context *context, const settings *set, const scene *in, uint64_t seed, double sums[PARTS])
{
    double ms[PARTS][MAX_RUNS];
    asj_geometry found;
    size_t candidates = 0;
    memset(&found, 0, sizeof found);
    for (int32_t run = -1; run < set->runs; run++) {
        double once[PARTS] = {0};
        steps s;
        const asj_status status = one_round(context, in, &s, once);
        found = s.found;
        candidates = s.run.candidates.count;
        free_steps(&context->memory, &s);
        if (status != ASJ_OK)
            return fail(asj_context_message(context));
        for (int p = 0; run >= 0 && p < PARTS; p++)
            ms[p][run] = once[p];
    }
    printf("%6lu %6u %6u %10zu", (unsigned long)seed, (unsigned)in->features[0].l_junctions.count,
           (unsigned)in->features[1].l_junctions.count, candidates);
    for (int p = 0; p < PARTS; p++) {
        const double median = measure_median(ms[p], set->runs);
        sums[p] += median;
        printf(" %10.1f", median);
    }
    printf("  %s, log10 NFA %.2f\n", asj_geometry_status_name(found.status), found.log10_nfa);
    fflush(stdout);
    return 0;
}

static int one_room(asj_context *context, const settings *set, const synth_wide_pair *pair, double sums[PARTS])
{
    static scene in;
    int result = 0;
    memset(&in, 0, sizeof in);
    asj_match_options_init(&in.options);
    in.options.shortlist = SHORTLIST;
    in.options.geometry.model = ASJ_GEOMETRY_AUTO;
    in.options.geometry.seed = (uint64_t)set->seed;
    for (int32_t v = 0; v < 2 && result == 0; v++)
        result = make_side(context, set, pair, v, &in);
    if (result == 0)
        result = measure(context, set, &in, pair->seed, sums);
    free_scene(context, &in);
    return result;
}

static int run(const settings *set)
{
    static const char *const names[PARTS] = {"candidates", "priors", "directions", "estimate", "work"};
    asj_context *context = measure_context(set->threads);
    double sums[PARTS] = {0};
    int32_t rooms = 0;
    int result = 0;
    if (!context)
        return fail("cannot make a context");
    printf("libasj %s, rooms of %d x %d, %d threads; ms (medians)\n\n%6s %6s %6s %10s", asj_version_string(), SYNTH_WIDE_WIDTH,
           SYNTH_WIDE_HEIGHT, (int)asj_context_threads(context), "seed", "L1", "L2", "candidates");
    for (int p = 0; p < PARTS; p++)
        printf(" %10s", names[p]);
    puts("");
    for (int32_t seed = set->first; seed <= set->last && result == 0; seed++) {
        synth_wide_pair pair;
        if (synth_wide_pair_make(&pair, (uint64_t)seed) != 0)
            continue; /* no such viewpoints in this room */
        result = one_room(context, set, &pair, sums);
        rooms++;
        synth_wide_pair_free(&pair);
    }
    if (rooms > 0 && result == 0) {
        printf("%31s", "mean");
        for (int p = 0; p < PARTS; p++)
            printf(" %10.1f", sums[p] / rooms);
        puts("");
    }
    asj_context_free(&context);
    return result;
}

int main(int argc, char **argv)
{
    static const struct option longs[] = {{"corners", 1, NULL, 'c'}, {"first", 1, NULL, 'f'}, {"last", 1, NULL, 'l'},
                                          {"threads", 1, NULL, 't'}, {"runs", 1, NULL, 'r'}, {"seed", 1, NULL, 's'},
                                          {NULL, 0, NULL, 0}};
    settings set = {.corners = 200, .last = 9, .threads = 2, .runs = 5, .seed = 1};
    int c, bad = 0;
    while (!bad && (c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case 'c': bad = measure_number(optarg, 10, 100000, &set.corners); break;
        case 'f': bad = measure_number(optarg, 0, 99999, &set.first); break;
        case 'l': bad = measure_number(optarg, 0, 99999, &set.last); break;
        case 't': bad = measure_number(optarg, 1, 256, &set.threads); break;
        case 'r': bad = measure_number(optarg, 1, MAX_RUNS, &set.runs); break;
        case 's': bad = measure_number(optarg, 0, 1000000, &set.seed); break;
        default: bad = 1;
        }
    if (bad || optind < argc) {
        fputs(help, stderr);
        return 2;
    }
    return run(&set) == 0 ? 0 : 1;
}
