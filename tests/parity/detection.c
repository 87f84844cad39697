/* SPDX-License-Identifier: BSD-2-Clause */
/* The whole detector in every variant, or with --devices on every OpenCL device: the same junctions, bit for bit. Scenes always;
 * photographs (PNG files, or folders of them) when named on the command line or found below ASJ_PAIRS:
 *     detection-parity [--devices | --quick] [FILE|FOLDER...]
 * --quick: two scenes of each kind in place of six with the defaults.
 * Exit status as parity. */
#include "render.h"
#include "scenes.h"
#include "targets.h"

#ifdef HAVE_PHOTOGRAPHS
#include "photograph.h"
#endif

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct run_state {
    target_list list;
    asj_detect_options options;
    const char *setting; /* name of the options */
    size_t junctions;
    int failed;
} run_state;

/* Of empty lists there is no first byte. */
static int equal(const void *a, const void *b, size_t count, size_t size)
{
    return count == 0 || memcmp(a, b, count * size) == 0;
}

static int same(const asj_detection *a, const asj_detection *b)
{
    return a->junction_count == b->junction_count && a->l_junction_count == b->l_junction_count && a->candidates == b->candidates &&
           a->isotropic == b->isotropic && equal(a->junctions, b->junctions, a->junction_count, sizeof *a->junctions) &&
           equal(a->l_junctions, b->l_junctions, a->l_junction_count, sizeof *a->l_junctions);
}

static asj_detection *detect(run_state *state, target *t, const asj_image *image)
{
    asj_detection *found = NULL;
    target_prepare(t, (image->width + ASJ_LANES - 1) / ASJ_LANES * ASJ_LANES + 2 * ASJ_MARGIN);
    if (asj_detect(t->context, image, &state->options, &found) != ASJ_OK) {
        printf("FAIL %s: %s\n", t->name, asj_context_message(t->context));
        state->failed = 1;
    }
    return found;
}

static void compare_image(run_state *state, const char *name, const asj_image *image)
{
    asj_detection *expected = detect(state, &state->list.targets[0], image);
    for (int32_t i = 1; i < state->list.count && expected; i++) {
        target *t = &state->list.targets[i];
        if (!t->context)
            continue;
        asj_detection *found = detect(state, t, image);
        t->compared++;
        if (found && !same(found, expected)) {
            printf("FAIL %s differs from the reference: %s, %d x %d, options %s\n", t->name, name, (int)image->width,
                   (int)image->height, state->setting);
            state->failed = 1;
        }
        asj_detection_free(&found);
    }
    if (expected)
        state->junctions += expected->junction_count;
    asj_detection_free(&expected);
}

static void compare(run_state *state, const char *name, const uint8_t *pixels, int32_t width, int32_t height)
{
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    compare_image(state, name, &image);
}

/* The levels as red and, the other way round, as green and blue: with little luma. */
static void compare_colours(run_state *state, const char *name, const uint8_t *pixels, int32_t width, int32_t height)
{
    const size_t count = (size_t)width * (size_t)height;
    uint8_t *rgb = malloc(3 * count);
    const asj_image image = {rgb, ASJ_FORMAT_RGB8, width, height, 0, 0};
    for (size_t k = 0; rgb && k < count; k++) {
        rgb[3 * k] = pixels[k];
        rgb[3 * k + 1] = (uint8_t)(192 - pixels[k] / 2);
        rgb[3 * k + 2] = (uint8_t)(255 - pixels[k]);
    }
    if (rgb)
        compare_image(state, name, &image);
    else
        state->failed = 1;
    free(rgb);
}

static void compare_scene(run_state *state, const char *name, synth_scene *scene, double blur, double noise, uint64_t seed)
{
    uint8_t *pixels = synth_photograph(scene, blur, noise, seed);
    if (pixels)
        (state->options.colours ? compare_colours : compare)(state, name, pixels, scene->width, scene->height);
    else
        state->failed = 1;
    free(pixels);
    synth_scene_free(scene);
}

static void scenes(run_state *state, uint64_t count)
{
    for (uint64_t seed = 0; seed < count; seed++) {
        synth_scene scene;
        synth_parallelograms(&scene, 40, seed);
        compare_scene(state, "parallelograms", &scene, 0.8, 4, seed);
        synth_random_star(&scene, 25, seed);
        compare_scene(state, "star", &scene, 1, 2, seed);
        synth_tiles(&scene, seed % 2 ? SYNTH_RANDOM_TILES : SYNTH_CHECKERBOARD, seed);
        compare_scene(state, "tiles", &scene, 0.8, (double)(seed % 3) * 4, seed);
        synth_scene_init(&scene, 1 + (int32_t)(seed * 37 % 90), 1 + (int32_t)(seed * 23 % 70), 128);
        compare_scene(state, "noise", &scene, 0, 20, seed);
    }
}

#ifdef HAVE_PHOTOGRAPHS
static void photographs(run_state *state, int count, char **paths)
{
    path_list list = {0};
    for (int i = 0; i < count; i++)
        if (path_list_add(&list, paths[i]) != 0)
            state->failed = 1;
    for (int32_t i = 0; i < list.count; i++) {
        photograph p;
        if (photograph_read(list.paths[i], &p) != 0) {
            state->failed = 1;
            continue;
        }
        compare(state, list.paths[i], p.pixels, p.width, p.height);
        photograph_free(&p);
    }
    path_list_free(&list);
}
#endif

static void settings(run_state *state, int quick)
{
    asj_detect_options_init(&state->options);
    state->setting = "default";
    scenes(state, state->list.devices ? 50 : quick ? 2 : 6);
    asj_detect_options_preset(&state->options, ASJ_PRESET_PAPER);
    state->setting = "paper";
    scenes(state, 1);
    asj_detect_options_init(&state->options);
    state->options.field_radius = 5;
    state->options.sector_width = 1.5;
    state->setting = "field_radius=5, sector_width=1.5";
    scenes(state, 2);
    asj_detect_options_init(&state->options);
    state->options.first_octave = -1;
    state->setting = "first_octave=-1";
    scenes(state, quick ? 1 : 3);
    asj_detect_options_init(&state->options);
    state->options.half_octaves = 1;
    state->setting = "half_octaves=1";
    scenes(state, quick ? 1 : 3);
    asj_detect_options_init(&state->options);
    state->options.complete_junctions = 1;
    state->setting = "complete_junctions=1";
    scenes(state, quick ? 1 : 3);
    asj_detect_options_init(&state->options);
    state->options.colours = 1;
    state->setting = "colours=1";
    scenes(state, quick ? 1 : 3);
    asj_detect_options_init(&state->options);
    state->options.three_sizes = 1;
    state->setting = "three_sizes=1";
    scenes(state, quick ? 1 : 3);
    asj_detect_options_init(&state->options);
    state->setting = "default";
}

static void named_photographs(run_state *state, int count, char **paths)
{
#ifdef HAVE_PHOTOGRAPHS
    char *pairs = getenv("ASJ_PAIRS");
    if (count > 0)
        photographs(state, count, paths);
    else if (pairs && *pairs)
        photographs(state, 1, &pairs);
    else
        printf("photographs: none named (ASJ_PAIRS)\n");
#else
    (void)state;
    (void)count;
    (void)paths;
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
        settings(&state, quick);
        named_photographs(&state, argc - 1 - words, argv + 1 + words);
        status = targets_report(&state.list, "images", state.junctions, "junctions", state.failed);
    }
    targets_close(&state.list);
    return status;
}
