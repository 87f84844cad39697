/* SPDX-License-Identifier: BSD-2-Clause */
#include "match/describe.h"
#include "match/expected.h"
#include "more_operations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* L-junctions of an image and room for their patches. */
typedef struct described {
    asj_match_options options;
    asj_image_features features;
    int16_t *patches;
    uint8_t *usable;
} described;

static uint32_t corner_count(const subject *s, int32_t which)
{
    return 5 + (uint32_t)(s->seed % 11) * (uint32_t)which + (uint32_t)s->frame.width * (uint32_t)s->frame.height / 1000;
}

/* Every size, with and without the mean, descriptors, short lists of every length. */
static void choose_options(const subject *s, asj_match_options *options)
{
    asj_match_options_init(options);
    options->patch_size = 8 + 4 * (int32_t)(s->seed % 5);
    options->normalise = s->seed % 7 > 0;
    options->descriptor = s->seed % 9 == 8 ? ASJ_DESCRIPTOR_SIFT : ASJ_DESCRIPTOR_RAW;
    options->shortlist = 1 + (int32_t)(s->seed % 32);
}

/* Of all sizes; some reach out of the image, some far, some fold. */
static void choose_frames(synth_random *random, const subject *s, asj_l_junctions *c)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        c->first_frame[i] = next;
        for (uint32_t n = 1 + (uint32_t)synth_random_between(random, 0, i % 9 ? 5 : 15.99); n > 0; n--) {
            const double size = exp2(synth_random_between(random, 1, i % 13 ? 6 : 20));
            c->frames[next++] = (asj_affine_frame){
                synth_random_between(random, 0, s->frame.width), synth_random_between(random, 0, s->frame.height),
                synth_random_between(random, -size, size), synth_random_between(random, -size, size),
                synth_random_between(random, -size, size), synth_random_between(random, -size, size)};
        }
    }
    c->first_frame[c->count] = next;
    c->frame_count = next;
}

static asj_status make_pyramid(asj_context *context, const subject *s, asj_pyramid *pyramid)
{
    const int32_t width = s->picture->width, height = s->picture->height;
    uint8_t *pixels = malloc((size_t)width * (size_t)height);
    if (!pixels)
        return ASJ_ERROR_MEMORY;
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            pixels[y * width + x] = (uint8_t)(s->picture->gray[y * s->picture->stride + x] / ASJ_GRAY_ONE);
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    asj_status status = asj_pyramid_create(context, &image, s->seed % 2 ? 0.8 : 0, pyramid);
    free(pixels);
    return status;
}

static void described_free(asj_context *context, described *p)
{
    asj_pyramid_free(&context->memory, &p->features.pyramid);
    free(p->features.l_junctions.first_frame);
    free(p->features.l_junctions.frames);
    free(p->patches);
    free(p->usable);
}

static asj_status described_create(asj_context *context, const subject *s, int32_t which, described *p)
{
    synth_random random = s->random;
    asj_l_junctions *c = &p->features.l_junctions;
    memset(p, 0, sizeof *p);
    choose_options(s, &p->options);
    c->count = corner_count(s, which);
    c->first_frame = malloc((c->count + 1) * sizeof *c->first_frame);
    c->frames = malloc(16 * c->count * sizeof *c->frames);
    p->patches = malloc(16 * c->count * ASJ_PATCH_SAMPLES * sizeof *p->patches);
    p->usable = malloc(16 * c->count);
    for (int32_t i = 0; i < 100 * which; i++)
        synth_random_bits(&random);
    if (!c->first_frame || !c->frames || !p->patches || !p->usable)
        return ASJ_ERROR_MEMORY;
    choose_frames(&random, s, c);
    p->features.patches = p->patches;
    p->features.usable = p->usable;
    return make_pyramid(context, s, &p->features.pyramid);
}

size_t patches_size(const subject *s)
{
    return 16 * corner_count(s, 1) * (ASJ_PATCH_SAMPLES * sizeof(int16_t) + 1);
}

/* About 3.4 frames of an L-junction. */
double patches_bytes(const subject *s)
{
    const double side = 8 + 4 * (double)(s->seed % 5), frames = 3.4 * corner_count(s, 1);
    return frames * (side * side * 2 + 28);
}

asj_status run_patches(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    described p;
    (void)scratch;
    asj_status status = described_create(context, s, 1, &p);
    if (status == ASJ_OK) {
        p.features.patches = output;
        const size_t samples = p.features.l_junctions.frame_count * (size_t)asj_patch_length(&p.options);
        p.features.usable = (uint8_t *)output + samples * sizeof(int16_t);
        status = context->ops->describe->frames(context, &p.options, &p.features);
    }
    described_free(context, &p);
    return status;
}

size_t partners_size(const subject *s)
{
    asj_match_options options;
    choose_options(s, &options);
    return (corner_count(s, 1) + corner_count(s, 2)) * (size_t)options.shortlist * sizeof(asj_partner);
}

/* Boxes of two thirds of the image's sides anywhere in it, some of them empty, and points. */
static asj_status choose_expected(const subject *s, const described p[2], asj_expected *expected)
{
    synth_random random = s->random;
    memset(expected, 0, sizeof *expected);
    for (int32_t v = 0; v < 2; v++) {
        const uint32_t count = p[v].features.l_junctions.count;
        expected->points[v] = malloc(count * sizeof **expected->points);
        expected->boxes[v] = malloc(count * sizeof **expected->boxes);
        if (!expected->points[v] || !expected->boxes[v])
            return ASJ_ERROR_MEMORY;
        for (uint32_t i = 0; i < count; i++) {
            const float width = (float)s->frame.width, height = (float)s->frame.height;
            const asj_point at = {width * (float)synth_random_between(&random, 0, 1),
                                  height * (float)synth_random_between(&random, 0, 1)};
            const asj_point middle = {width * (float)synth_random_between(&random, 0, 1),
                                      height * (float)synth_random_between(&random, 0, 1)};
            expected->points[v][i] = at;
            expected->boxes[v][i] = i % 7 == 3 ? asj_box_empty()
                                               : (asj_box){middle.x - width / 3, middle.y - height / 3, middle.x + width / 3,
                                                           middle.y + height / 3};
        }
    }
    return ASJ_OK;
}

static void expected_free(asj_expected *expected)
{
    for (int32_t v = 0; v < 2; v++) {
        free(expected->points[v]);
        free(expected->boxes[v]);
    }
}

/* Patches that a device has made itself or, every third time, does not know. Several of them are the same, for ties. Every other
 * time it is known where partners lie. */
asj_status run_partners(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    described p[2];
    asj_partner *partners = output;
    asj_status status[2];
    (void)scratch;
    for (size_t i = 0; i < partners_size(s) / sizeof *partners; i++)
        partners[i] = (asj_partner){ASJ_NO_PARTNER, 0};
    for (int32_t v = 0; v < 2; v++) {
        status[v] = described_create(context, s, v + 1, &p[v]);
        for (uint32_t f = 3; f < p[v].features.l_junctions.frame_count && status[v] == ASJ_OK; f += 3)
            p[v].features.l_junctions.frames[f] = p[v].features.l_junctions.frames[f / 2];
        if (status[v] == ASJ_OK)
            status[v] = context->ops->describe->frames(context, &p[v].options, &p[v].features);
        if (s->seed % 3 == (uint64_t)v)
            p[v].features.device_copy = 0;
    }
    asj_status result = status[0] == ASJ_OK ? status[1] : status[0];
    asj_expected expected = {{NULL, NULL}, {NULL, NULL}};
    if (result == ASJ_OK && s->seed % 2)
        result = choose_expected(s, p, &expected);
    const asj_match_run run = {.context = context, .options = &p[0].options, .image = {&p[0].features, &p[1].features},
                               .expected = s->seed % 2 ? &expected : NULL};
    if (result == ASJ_OK)
        result = context->ops->rank->partners(&run, partners,
                                             partners + p[0].features.l_junctions.count * (size_t)p[0].options.shortlist);
    expected_free(&expected);
    described_free(context, &p[0]);
    described_free(context, &p[1]);
    return result;
}
