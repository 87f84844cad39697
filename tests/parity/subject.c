/* SPDX-License-Identifier: BSD-2-Clause */
#include "subject.h"
#include "detect/gradient.h"
#include "render.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LARGEST (ASJ_GRADIENT_LIMIT * ASJ_GRADIENT_ONE)

const char *content_name(int32_t content)
{
    static const char *const names[CONTENT_COUNT] = {"random", "zero", "constant", "saturated", "sparse", "scene"};
    return names[content];
}

static void set(const asj_frame *frame, int32_t x, int32_t y, double norm, double angle)
{
    const ptrdiff_t at = y * frame->stride + x;
    frame->gradient_x[at] = (int16_t)lrint(norm * cos(angle));
    frame->gradient_y[at] = (int16_t)lrint(norm * sin(angle));
}

static void fill_planes(subject *s)
{
    const double turn = 2 * acos(-1.0), constant = synth_random_between(&s->random, 0, turn);
    for (int32_t y = 0; y < s->frame.height; y++)
        for (int32_t x = 0; x < s->frame.width; x++) {
            const double norm = synth_random_between(&s->random, 0, LARGEST), angle = synth_random_between(&s->random, 0, turn);
            const int32_t patch = (x / 9 + 3 * (y / 7)) % 8;
            switch (s->content) {
            case CONTENT_RANDOM: set(&s->frame, x, y, norm, angle); break;
            case CONTENT_CONSTANT: set(&s->frame, x, y, 0.5 * LARGEST, constant); break;
            case CONTENT_SATURATED: set(&s->frame, x, y, LARGEST, patch * turn / 8); break;
            case CONTENT_SPARSE: set(&s->frame, x, y, synth_random_unit(&s->random) < 0.01 ? norm : 0, angle); break;
            default: set(&s->frame, x, y, 0, 0); break;
            }
        }
}

/* Grey levels of the same kinds. */
static void fill_pixels(subject *s, uint8_t *pixels)
{
    const int32_t width = s->frame.width, count = width * s->frame.height;
    for (int32_t i = 0; i < count; i++) {
        const int32_t x = i % width, y = i / width;
        const double level = synth_random_between(&s->random, 0, 255.99);
        switch (s->content) {
        case CONTENT_RANDOM: pixels[i] = (uint8_t)level; break;
        case CONTENT_CONSTANT: pixels[i] = (uint8_t)(x + 2 * y); break;
        case CONTENT_SATURATED: pixels[i] = (x / 2 + y / 3) % 2 ? 255 : 0; break;
        case CONTENT_SPARSE: pixels[i] = synth_random_unit(&s->random) < 0.01 ? (uint8_t)level : 0; break;
        default: pixels[i] = 0; break;
        }
    }
}

/* A scene with noise. */
static uint8_t *draw_scene(subject *s)
{
    synth_scene scene;
    synth_scene_init(&scene, s->frame.width, s->frame.height, 110);
    for (int i = 0; i < 4; i++) {
        const synth_point corner = {synth_random_between(&s->random, 0, s->frame.width),
                                    synth_random_between(&s->random, 0, s->frame.height)};
        const double angle = synth_random_between(&s->random, 0, 6);
        synth_add_rectangle(&scene, corner, 40, 25, angle, synth_random_between(&s->random, 30, 220));
    }
    uint8_t *pixels = synth_photograph(&scene, 0.8, 2, s->seed);
    synth_scene_free(&scene);
    return pixels;
}

/* The picture; of a scene, also the gradient, by the reference. */
static int fill_picture(subject *s)
{
    const int32_t width = s->frame.width, height = s->frame.height;
    uint8_t *pixels = s->content == CONTENT_SCENE ? draw_scene(s) : malloc((size_t)width * (size_t)height);
    asj_image image = {pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    s->picture = calloc(1, sizeof *s->picture);
    s->colours = malloc(4 * (size_t)width);
    int ok = pixels && s->picture && s->colours;
    if (ok && s->content != CONTENT_SCENE)
        fill_pixels(s, pixels);
    for (int32_t i = 0; ok && i < 4 * width; i++)
        s->colours[i] = s->content == CONTENT_SATURATED ? 255 : (uint8_t)(synth_random_bits(&s->random) >> 40);
    ok = ok && asj_frame_prepare(s->context, s->picture, width, height) == ASJ_OK &&
         asj_frame_load(s->context, s->picture, &image, ASJ_PLANE_LUMA) == ASJ_OK;
    if (ok && s->content == CONTENT_SCENE) {
        const asj_ops *ops = s->context->ops;
        asj_tables reference;
        asj_tables_fill(ASJ_SIMD_REFERENCE, &reference);
        s->context->ops = &reference.ops;
        ok = asj_frame_load(s->context, &s->frame, &image, ASJ_PLANE_LUMA) == ASJ_OK &&
             asj_gradient(s->context, &s->frame, &s->options) == ASJ_OK;
        s->context->ops = ops;
    }
    free(pixels);
    return ok;
}

int subject_create(asj_context *context, int32_t width, int32_t height, int32_t content, int32_t radius, double tau, uint64_t seed,
                   subject *s)
{
    memset(s, 0, sizeof *s);
    s->context = context;
    s->content = content;
    s->seed = seed;
    synth_random_seed(&s->random, seed);
    asj_detect_options_init(&s->options);
    s->options.field_radius = radius;
    s->options.sector_width = tau;
    s->options.gradient_epsilon = seed % 3 == 0 ? 0.05 : seed % 3 == 1 ? 0.4 : 16;
    s->options.candidate_step = 1 + (int32_t)(seed / 3 % 2);
    if (seed % 4 == 3) /* the smallest and the largest, and both kinds of units */
        s->options.isotropic_radii = 1u << 3 | 1u << 8 | 1u << 21 | 1u << 30;
    int ok = asj_frame_prepare(context, &s->frame, width, height) == ASJ_OK &&
             asj_field_create(context, &s->options, &s->field) == ASJ_OK &&
             asj_isotropic_create(context, &s->options, &s->isotropic) == ASJ_OK;
    if (ok && content != CONTENT_SCENE)
        fill_planes(s);
    ok = ok && fill_picture(s);
    if (ok) {
        asj_isotropic_set_size(&s->options, width, height, s->frame.octaves, &s->isotropic);
        s->scratch_size = asj_field_scratch(&s->field);
        if (s->isotropic.scratch > s->scratch_size)
            s->scratch_size = s->isotropic.scratch;
    }
    if (!ok)
        fprintf(stderr, "parity: no subject of %d x %d pixels: %s\n", (int)width, (int)height, asj_context_message(context));
    return ok;
}

void subject_free(subject *s)
{
    asj_isotropic_free(&s->context->memory, &s->isotropic);
    asj_field_free(&s->context->memory, &s->field);
    asj_frame_free(&s->context->memory, &s->frame);
    if (s->picture)
        asj_frame_free(&s->context->memory, s->picture);
    free(s->picture);
    free(s->colours);
}
