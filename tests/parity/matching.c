/* SPDX-License-Identifier: BSD-2-Clause */
/* The whole matcher in every variant, or with --devices on every OpenCL device: the same matches, bit for bit; on some rooms from
 * features that were made there and are matched there, or matched by the reference (asj_match_features()). Rooms always; pairs
 * of photographs (FOLDER/<pair>/1.png and 2.png) when a folder is named on the command line or by ASJ_PAIRS:
 *     match-parity [--devices | --quick] [FOLDER]
 * --quick: one room in place of eight with the defaults, one whose features are kept.
 * Exit status as parity. */
#include "render.h"
#include "room.h"
#include "targets.h"

#include <asj/features.h>
#include <asj/match.h>

#ifdef HAVE_PHOTOGRAPHS
#include "photograph.h"
#endif

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 360
#define HEIGHT 270

typedef struct run_state {
    target_list list;
    asj_match_options options;
    const char *setting; /* name of the options */
    size_t matches;
    int kept; /* whether features are kept, too */
    int failed;
} run_state;

/* What is matched: two images and what the reference detects in them. */
typedef struct pair {
    asj_image images[2];
    asj_detection *found[2];
} pair;

static int same(const asj_match_result *a, const asj_match_result *b)
{
    return a->match_count == b->match_count && a->candidates == b->candidates && a->l_junction_count1 == b->l_junction_count1 &&
           a->l_junction_count2 == b->l_junction_count2 &&
           (a->match_count == 0 || memcmp(a->matches, b->matches, a->match_count * sizeof *a->matches) == 0);
}

static asj_match_result *match(run_state *state, const target *t, const pair *p)
{
    asj_match_result *result = NULL;
    if (asj_match(t->context, &p->images[0], p->found[0]->junctions, p->found[0]->junction_count, &p->images[1],
                  p->found[1]->junctions, p->found[1]->junction_count, &state->options, &result) != ASJ_OK) {
        printf("FAIL %s: %s\n", t->name, asj_context_message(t->context));
        state->failed = 1;
    }
    return result;
}

/* The features of both images, made by one target, and what another makes of them; NULL on failure. */
static asj_match_result *match_kept(run_state *state, const target *maker, const target *t, const pair *p)
{
    asj_features *features[2] = {NULL, NULL};
    asj_match_result *result = NULL;
    asj_status status = ASJ_OK;
    for (int v = 0; v < 2 && status == ASJ_OK; v++)
        status = asj_features_create(maker->context, &p->images[v], p->found[v]->junctions, p->found[v]->junction_count,
                                     &state->options, &features[v]);
    if (status != ASJ_OK)
        printf("FAIL %s: %s\n", maker->name, asj_context_message(maker->context));
    else if (asj_match_features(t->context, features[0], features[1], &state->options, &result) != ASJ_OK)
        printf("FAIL %s: %s\n", t->name, asj_context_message(t->context));
    state->failed = state->failed || !result;
    asj_features_free(&features[0]);
    asj_features_free(&features[1]);
    return result;
}

static void compare_kept(run_state *state, target *t, const char *name, const pair *p, const asj_match_result *expected)
{
    const target *const by[2] = {t, &state->list.targets[0]};
    for (int k = 0; k < 2; k++) {
        asj_match_result *result = match_kept(state, t, by[k], p);
        t->compared++;
        if (result && !same(result, expected)) {
            printf("FAIL features of %s, matched by %s, differ from the reference: %s, options %s\n", t->name, by[k]->name, name,
                   state->setting);
            state->failed = 1;
        }
        asj_match_result_free(&result);
    }
}

static void compare(run_state *state, const char *name, const pair *p)
{
    asj_match_result *expected = match(state, &state->list.targets[0], p);
    for (int32_t i = 1; i < state->list.count && expected; i++) {
        target *t = &state->list.targets[i];
        if (!t->context)
            continue;
        asj_match_result *result = match(state, t, p);
        t->compared++;
        if (result && !same(result, expected)) {
            printf("FAIL %s differs from the reference: %s, options %s\n", t->name, name, state->setting);
            state->failed = 1;
        }
        asj_match_result_free(&result);
        if (state->kept)
            compare_kept(state, t, name, p, expected);
    }
    if (expected)
        state->matches += expected->match_count;
    asj_match_result_free(&expected);
}

/* By the strongest variant: what is compared is the matcher. */
static int detect(run_state *state, pair *p)
{
    asj_detect_options options;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    asj_context *context = NULL;
    int good = asj_context_create(NULL, &context) == ASJ_OK;
    for (int v = 0; v < 2 && good; v++)
        good = asj_detect(context, &p->images[v], &options, &p->found[v]) == ASJ_OK;
    asj_context_free(&context);
    if (!good)
        state->failed = 1;
    return good;
}

static void pair_free(pair *p)
{
    asj_detection_free(&p->found[0]);
    asj_detection_free(&p->found[1]);
}

static uint8_t *photograph_room(uint64_t seed, int32_t index)
{
    synth_room room;
    synth_view view;
    uint8_t *pixels = NULL;
    const synth_camera camera = synth_room_random_camera(seed, index, WIDTH, HEIGHT);
    if (synth_room_random(&room, seed) != 0)
        return NULL;
    if (synth_view_make(&room, &camera, 4.0, &view) == 0) {
        pixels = synth_photograph(&view.scene, 0.9, 2.0, seed + (uint64_t)index);
        synth_view_free(&view);
    }
    synth_room_free(&room);
    return pixels;
}

static void room(run_state *state, uint64_t seed)
{
    uint8_t *pixels[2] = {photograph_room(seed, 0), photograph_room(seed, 1)};
    pair p = {{{pixels[0], ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0}, {pixels[1], ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0}},
              {NULL, NULL}};
    char name[32];
    state->kept = seed % 4 == 1 || seed > 7;
    snprintf(name, sizeof name, "room %u", (unsigned)seed);
    if (!pixels[0] || !pixels[1])
        state->failed = 1;
    else if (detect(state, &p))
        compare(state, name, &p);
    pair_free(&p);
    free(pixels[0]);
    free(pixels[1]);
}

static void rooms(run_state *state, int quick)
{
    asj_match_options_init(&state->options);
    state->setting = "default";
    for (uint64_t seed = quick ? 1 : 0; seed < (quick ? 2 : 8); seed++)
        room(state, seed);
    state->options.patch_size = 12;
    state->options.shortlist = 9;
    state->options.smoothing = 0;
    state->setting = "patch_size=12, shortlist=9, smoothing=0";
    room(state, 8);
    asj_match_options_init(&state->options);
    state->options.descriptor = ASJ_DESCRIPTOR_SIFT;
    state->setting = "descriptor=sift";
    room(state, 9);
    asj_match_options_init(&state->options);
    state->options.normalise = 0;
    state->setting = "normalise=no";
    room(state, 10);
    asj_match_options_init(&state->options);
    state->setting = "default";
    state->kept = 0;
}

#ifdef HAVE_PHOTOGRAPHS
static void photographs(run_state *state, const char *folder)
{
    path_list list = {0};
    if (path_list_add(&list, folder) != 0 || list.count < 2)
        state->failed = 1;
    for (int32_t i = 0; i + 1 < list.count; i += 2) {
        photograph photo[2];
        pair p = {{{0}}, {NULL, NULL}};
        int good = photograph_read(list.paths[i], &photo[0]) == 0;
        if (good && photograph_read(list.paths[i + 1], &photo[1]) == 0) {
            for (int v = 0; v < 2; v++)
                p.images[v] = (asj_image){photo[v].pixels, ASJ_FORMAT_GRAY8, photo[v].width, photo[v].height, 0, 0};
            if (detect(state, &p))
                compare(state, list.paths[i], &p);
            photograph_free(&photo[1]);
        } else {
            state->failed = 1;
        }
        if (good)
            photograph_free(&photo[0]);
        pair_free(&p);
    }
    path_list_free(&list);
}
#endif

static void named_photographs(run_state *state, const char *folder)
{
#ifdef HAVE_PHOTOGRAPHS
    const char *pairs = folder ? folder : getenv("ASJ_PAIRS");
    if (pairs && *pairs)
        photographs(state, pairs);
    else
        printf("photographs: none named (ASJ_PAIRS)\n");
#else
    (void)state;
    (void)folder;
    printf("photographs: built without libasj-io\n");
#endif
}

int main(int argc, char **argv)
{
    static run_state state;
    const int devices = argc > 1 && strcmp(argv[1], "--devices") == 0, quick = argc > 1 && strcmp(argv[1], "--quick") == 0;
    const int words = devices || quick;
    const int32_t count = targets_open(devices, &state.list);
    int status = 1;
    if (count == 0)
        status = targets_missing(&state.list);
    if (count > 0) {
        rooms(&state, quick);
        named_photographs(&state, argc > 1 + words ? argv[1 + words] : NULL);
        status = targets_report(&state.list, "comparisons", state.matches, "matches", state.failed);
    }
    targets_close(&state.list);
    return status;
}
