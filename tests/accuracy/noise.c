/* SPDX-License-Identifier: BSD-2-Clause */
/* The paper's Table 1 ("Stability and Control of the Number of False Detection") with this library's own branch test: images of
 * 256 x 256 independent Gaussian pixels, from every pixel one ray in a random direction, counted per image as false detection
 * when its NFA is at most epsilon.
 *
 *     any      strip test, the best of 16 lengths, 4 to 64 px (cut by the option strip_length): an upper bound for whatever might
 *              choose a length
 *     scanned  strip test, the length that the scan gives (mean of forward and axial), when it is at least minimum_length: what
 *              the detector does
 *     steps    no strip test: the ray passes its first steps at scan_epsilon = epsilon, as far as the scan wants; rays start at
 *              scan_start, or at 3 px where that is 0. What the paper's text does, and no promise of ours
 *
 * and, without rays, the junctions that the whole detector finds at epsilon = scan_epsilon (segments at their own, which is above):
 *
 *     detector    as it is
 *     everywhere  every pixel a candidate, one radius enough, branches that share pixels: nothing but the NFA of isotropic
 *                 junctions, their branches' scans and what follows says no
 *
 * All but the steps are bounded by epsilon when the tests keep their promise; --check asserts it.
 *
 * Pixels are 128 + 20 times a normal number, rounded to 8 bits: the normalised gradient does not depend on mean and contrast. */
#define _POSIX_C_SOURCE 200809L

#include "random.h"
#include "render.h"

#include "detect/gradient.h"
#include "detect/detect_options.h"
#include "detect/scan.h"
#include "detect/scan_cache.h"
#include "detect/strip.h"

#include <asj/asj.h>

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 256
#define RAYS (SIDE * SIDE)
#define LENGTHS 16
#define TWO_PI 6.283185307179586476925

static const double epsilons[] = {0.01, 0.1, 1, 10, 100, 200};
enum { EPSILONS = sizeof epsilons / sizeof epsilons[0], ANY = 0, SCANNED = 1, STEPS = 2, DETECTOR = 3, EVERYWHERE = 4, WAYS = 5 };
static const char *const names[WAYS] = {"any", "scanned", "steps", "detector", "everywhere"};

typedef struct experiment {
    asj_context *context;
    asj_detect_options options;
    asj_frame frame;
    asj_field field;
    asj_scan scan;
    asj_scan_cache cache;
    asj_scratch scratch;
    asj_ray *rays;
    double *log_nfa[STEPS]; /* one a ray */
    double count[WAYS][EPSILONS];
    double worst[WAYS];    /* smallest log10 NFA of all */
    int ways[WAYS];        /* which are wanted */
    int32_t images, first, check;
} experiment;

static int fail(const char *what)
{
    fprintf(stderr, "noise: %s\n", what);
    return -1;
}

static int prepare(experiment *e)
{
    e->rays = malloc(RAYS * sizeof *e->rays);
    e->log_nfa[ANY] = malloc(RAYS * sizeof **e->log_nfa);
    e->log_nfa[SCANNED] = malloc(RAYS * sizeof **e->log_nfa);
    if (!e->rays || !e->log_nfa[ANY] || !e->log_nfa[SCANNED])
        return fail("out of memory");
    if (asj_frame_prepare(e->context, &e->frame, SIDE, SIDE) != ASJ_OK ||
        asj_field_create(e->context, &e->options, &e->field) != ASJ_OK)
        return fail(asj_context_message(e->context));
    e->scratch.size = asj_field_scratch(&e->field);
    e->scratch.memory = asj_allocate(&e->context->memory, e->scratch.size, sizeof *e->scratch.memory);
    if (!e->scratch.memory)
        return fail("out of memory");
    asj_scan_prepare(&e->options, &e->field, &e->cache, &e->scan);
    asj_scan_set_size(&e->options, SIDE, SIDE, &e->scan);
    return 0;
}

static int load(experiment *e, const asj_image *image, uint64_t seed)
{
    asj_status status = asj_frame_load(e->context, &e->frame, image, ASJ_PLANE_LUMA);
    if (status == ASJ_OK)
        status = asj_scan_cache_prepare(e->context, &e->frame, asj_context_threads(e->context), &e->cache);
    if (status == ASJ_OK)
        status = asj_gradient(e->context, &e->frame, &e->options);
    if (status != ASJ_OK)
        return fail(asj_context_message(e->context));
    synth_random random;
    synth_random_seed(&random, seed ^ UINT64_C(0xa11ce));
    for (int32_t i = 0; i < RAYS; i++) {
        const asj_ray ray = {i % SIDE, i / SIDE, TWO_PI * synth_random_unit(&random), e->options.scan_start, 0, 0};
        e->rays[i] = ray;
    }
    return 0;
}

static double log_nfa(const experiment *e, const asj_ray *ray, double length)
{
    const asj_strip_line line = {ray->x, ray->y, ray->angle, length};
    return asj_strip_test(e->context, &e->frame, &e->options, &line).log_nfa;
}

static void test_any_length(experiment *e)
{
    for (int32_t i = 0; i < RAYS; i++) {
        const asj_ray *ray = &e->rays[i];
        double best = HUGE_VAL;
        for (int k = 1; k <= LENGTHS; k++)
            best = fmin(best, log_nfa(e, ray, 4.0 * k));
        e->log_nfa[ANY][i] = best;
    }
}

static int test_scanned_length(experiment *e)
{
    if (asj_scan_rays(e->context, &e->scan, &e->frame, &e->scratch, e->rays, RAYS) != ASJ_OK)
        return fail(asj_context_message(e->context));
    for (int32_t i = 0; i < RAYS; i++) {
        const asj_ray *ray = &e->rays[i];
        const double length = e->options.scan_axial ? 0.5 * (ray->forward + ray->axial) : ray->forward;
        e->log_nfa[SCANNED][i] = HUGE_VAL;
        if (length > 0.0 && length >= e->options.minimum_length)
            e->log_nfa[SCANNED][i] = log_nfa(e, ray, length);
    }
    return 0;
}

/* The scan's own verdict. Its threshold depends on epsilon, so the rays are followed once for each. */
static int count_steps(experiment *e)
{
    for (int k = 0; k < EPSILONS; k++) {
        asj_detect_options options = e->options;
        asj_scan scan;
        options.scan_epsilon = epsilons[k];
        asj_scan_prepare(&options, &e->field, &e->cache, &scan);
        asj_scan_set_size(&options, SIDE, SIDE, &scan);
        for (int32_t i = 0; i < RAYS; i++)
            e->rays[i].start = options.scan_start > 0 ? options.scan_start : 3;
        if (asj_scan_rays(e->context, &scan, &e->frame, &e->scratch, e->rays, RAYS) != ASJ_OK)
            return fail(asj_context_message(e->context));
        for (int32_t i = 0; i < RAYS; i++)
            e->count[STEPS][k] += e->rays[i].forward > 0 || e->rays[i].axial > 0;
    }
    return 0;
}

static int count_junctions(experiment *e, const asj_image *image, int way)
{
    for (int k = 0; k < EPSILONS; k++) {
        asj_detect_options options = e->options;
        asj_detection *found = NULL;
        options.epsilon = options.scan_epsilon = epsilons[k];
        if (way == EVERYWHERE) {
            options.seeds = ASJ_SEEDS_FIELD;
            options.candidate_strength = 0.0;
            options.isotropic_persistence = 1;
            options.disjoint_sectors = 0;
        }
        if (asj_detect(e->context, image, &options, &found) != ASJ_OK)
            return fail(asj_context_message(e->context));
        e->count[way][k] += found->junction_count;
        asj_detection_free(&found);
    }
    return 0;
}

static void count(experiment *e)
{
    for (int way = 0; way < STEPS; way++)
        for (int32_t i = 0; i < RAYS && e->ways[way]; i++) {
            e->worst[way] = fmin(e->worst[way], e->log_nfa[way][i] / log(10.0));
            for (int k = 0; k < EPSILONS; k++)
                e->count[way][k] += e->log_nfa[way][i] <= log(epsilons[k]);
        }
}

static int follow_rays(experiment *e, const asj_image *image, uint64_t seed)
{
    int result = load(e, image, seed);
    if (result == 0 && e->ways[ANY])
        test_any_length(e);
    if (result == 0 && e->ways[SCANNED])
        result = test_scanned_length(e);
    if (result == 0)
        count(e);
    if (result == 0 && e->ways[STEPS])
        result = count_steps(e);
    return result;
}

static int run_image(experiment *e, uint64_t seed)
{
    uint8_t *pixels = synth_noise_image(SIDE, SIDE, 128.0, 20.0, seed);
    if (!pixels)
        return fail("out of memory");
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, SIDE, SIDE, 0, 0};
    int result = 0;
    if (e->ways[ANY] || e->ways[SCANNED] || e->ways[STEPS])
        result = follow_rays(e, &image, seed);
    for (int way = DETECTOR; way <= EVERYWHERE && result == 0; way++)
        if (e->ways[way])
            result = count_junctions(e, &image, way);
    free(pixels);
    return result;
}

static int run(experiment *e)
{
    int result = prepare(e);
    for (int32_t i = 0; i < e->images && result == 0; i++)
        result = run_image(e, (uint64_t)(e->first + i));
    return result;
}

/* The mean over the images may exceed its expectation by chance: epsilon x images events are expected at most, so three Poisson
 * standard deviations are allowed on top. */
static int report(const experiment *e)
{
    static const double paper[EPSILONS] = {.002, .006, .198, 5.923, 66.472, 132.676};
    int broken = 0;
    printf("%-12s", "epsilon");
    for (int k = 0; k < EPSILONS; k++)
        printf("%10g", epsilons[k]);
    printf("   smallest log10 NFA (%d images)\n%-12s", (int)e->images, "paper");
    for (int k = 0; k < EPSILONS; k++)
        printf("%10.3f", paper[k]);
    printf("\n");
    for (int way = 0; way < WAYS; way++) {
        if (!e->ways[way])
            continue;
        printf("%-12s", names[way]);
        for (int k = 0; k < EPSILONS; k++) {
            const double expected = epsilons[k] * e->images;
            printf("%10.3f", e->count[way][k] / e->images);
            broken += way != STEPS && e->count[way][k] > expected + 3.0 * sqrt(expected) + 1.0;
        }
        if (way >= STEPS)
            printf("\n");
        else
            printf("%10.2f\n", e->worst[way]);
    }
    if (broken)
        fprintf(stderr, "noise: %d figures are above epsilon\n", broken);
    return e->check && broken ? 1 : 0;
}

/* "any,scanned" */
static int take_ways(const char *text, experiment *e)
{
    memset(e->ways, 0, sizeof e->ways);
    while (*text) {
        const size_t length = strcspn(text, ",");
        int way = 0;
        while (way < WAYS && (strlen(names[way]) != length || strncmp(names[way], text, length) != 0))
            way++;
        if (way == WAYS)
            return fail("--ways: any, scanned, steps, detector, everywhere");
        e->ways[way] = 1;
        text += length + (text[length] == ',');
    }
    return 0;
}

static int parse(int argc, char **argv, experiment *e)
{
    static const struct option longs[] = {{"images", 1, NULL, 'n'}, {"first", 1, NULL, 'f'}, {"check", 0, NULL, 'c'},
                                          {"ways", 1, NULL, 'w'}, {"preset", 1, NULL, 'p'}, {"help", 0, NULL, 'h'},
                                          {NULL, 0, NULL, 0}};
    int c;
    while ((c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case 'n': e->images = (int32_t)strtol(optarg, NULL, 10); break;
        case 'f': e->first = (int32_t)strtol(optarg, NULL, 10); break;
        case 'c': e->check = 1; break;
        case 'w':
            if (take_ways(optarg, e) != 0)
                return -1;
            break;
        case 'p':
            if (strcmp(optarg, "paper") == 0)
                asj_detect_options_preset(&e->options, ASJ_PRESET_PAPER);
            else if (strcmp(optarg, "default") != 0)
                return fail("--preset: default, paper");
            break;
        case 'h':
            printf("usage: noise [--images N] [--first SEED] [--preset default|paper] [--check]\n"
                   "             [--ways any,scanned,steps,detector,everywhere] [key=value ...]\n"
                   "Images of 256 x 256 Gaussian noise: false branches an image, one ray in a random direction from every pixel;\n"
                   "detector, everywhere: junctions an image.\n");
            return 1;
        default: return -1;
        }
    for (; optind < argc; optind++) {
        char message[256];
        char *equals = strchr(argv[optind], '=');
        if (!equals)
            return fail("options are given as key=value");
        *equals = '\0';
        if (asj_detect_options_set(&e->options, argv[optind], equals + 1, message, sizeof message) != ASJ_OK)
            return fail(message);
    }
    return e->images > 0 ? 0 : fail("--images must be at least 1");
}

int main(int argc, char **argv)
{
    static experiment e;
    asj_context_options how;
    e.images = 20;
    e.first = 1;
    e.worst[ANY] = e.worst[SCANNED] = HUGE_VAL;
    e.ways[ANY] = e.ways[SCANNED] = 1;
    asj_detect_options_init(&e.options);
    const int parsed = parse(argc, argv, &e);
    if (parsed != 0)
        return parsed < 0 ? 2 : 0;
    asj_context_options_init(&how);
    how.backend = ASJ_BACKEND_CPU;
    how.threads = 1;
    if (asj_context_create(&how, &e.context) != ASJ_OK)
        return 2;
    int result = run(&e) == 0 ? report(&e) : 2;
    asj_frame_free(&e.context->memory, &e.frame);
    asj_field_free(&e.context->memory, &e.field);
    asj_scan_cache_free(&e.context->memory, &e.cache);
    asj_release(&e.context->memory, e.scratch.memory);
    asj_context_free(&e.context);
    free(e.rays);
    free(e.log_nfa[ANY]);
    free(e.log_nfa[SCANNED]);
    return result;
}
