/* SPDX-License-Identifier: BSD-2-Clause */
/* Patches of an image's colours, for the geometry (two_view.c).
 *
 * Red, green and blue of a frame's neighbourhood (patch.c), ASJ_COLOUR_PATCH_SIDE samples along a side, each normalised by itself:
 * then neither exposure nor white balance counts, which differ from photograph to photograph as a factor and an offset of each
 * channel. Two frames are as alike as the mean of the three channels' correlations says. Where nothing has a colour that is the
 * correlation of grey levels; doors, tiles and spines of books that grey levels take for each other it tells apart.
 *
 * How much that is worth depends on the place. Where all channels look the same they are grey levels once more, with fewer samples,
 * and frames of videos lose by them. So with r the correlation between two channels of a patch, in the mean, over that of each with
 * itself, its hue is HUE (1 - r), 1 at most, and two frames are as alike as (g + w c) / (1 + w): g by grey levels, c by colours, w
 * the larger hue of the two (compare.c). With w = 1 for all frames lose (tests/accuracy/tried/geometry.md, "Candidates by
 * colours").
 *
 * Of the image at half its size (small_picture.c). Whole numbers: the same on every machine. */
#include "colour_patch.h"
#include "core/pyramid.h"
#include "core/watch.h"
#include "patch.h"

#include <string.h>

#define SIDE ASJ_COLOUR_PATCH_SIDE
#define THIRD_BITS 14
#define ROOT_OF_THIRD 9459 /* sqrt(1/3) in 2^-THIRD_BITS */
#define HUE 4

typedef struct sample_job {
    const asj_pyramid *pyramid; /* of one channel */
    const asj_match_options *options;
    const asj_affine_frame *frames;
    double scale;
    int16_t *first; /* of that channel, of the first frame */
    asj_watch *watch;
} sample_job;

static void sample_some(const void *data, const asj_part *part)
{
    const sample_job *j = data;
    const double start = j->options->window_start, end = j->options->window_end, by = 1 / j->scale;
    for (int64_t f = part->first; f < part->end && !asj_watch_stops(j->watch, part); f++) {
        const asj_affine_frame *in = &j->frames[f];
        const asj_affine_frame frame = {(in->x + 0.5) * by - 0.5, (in->y + 0.5) * by - 0.5, in->ax * by, in->ay * by,
                                        in->bx * by, in->by * by};
        uint16_t levels[SIDE * SIDE];
        int16_t *unit = j->first + f * ASJ_COLOUR_PATCH_LENGTH;
        asj_patch_sample(j->pyramid, &frame, SIDE, start, end, levels);
        j->pyramid->ops->patch->normalise(levels, SIDE, unit);
        for (int32_t k = 0; k < SIDE * SIDE; k++)
            unit[k] = (int16_t)((unit[k] * ROOT_OF_THIRD + (1 << (THIRD_BITS - 1))) >> THIRD_BITS);
    }
}

typedef struct hue_job {
    const int16_t *patch;
    uint16_t *hue;
} hue_job;

static void find_hues(const void *data, const asj_part *part)
{
    const hue_job *j = data;
    for (int64_t f = part->first; f < part->end; f++) {
        const int16_t *red = j->patch + f * ASJ_COLOUR_PATCH_LENGTH, *green = red + SIDE * SIDE, *blue = green + SIDE * SIDE;
        const int64_t own = asj_patch_product(red, red, ASJ_COLOUR_PATCH_LENGTH);
        const int64_t between = (int64_t)asj_patch_product(red, green, SIDE * SIDE) + asj_patch_product(green, blue, SIDE * SIDE) +
                                asj_patch_product(red, blue, SIDE * SIDE);
        const int64_t hue = own > 0 ? ASJ_HUE_ONE * HUE * (own - between) / own : 0;
        j->hue[f] = (uint16_t)(hue < 0 ? 0 : hue > ASJ_HUE_ONE ? ASJ_HUE_ONE : hue);
    }
}

static asj_status sample_channels(asj_context *context, const sample_job *from, const asj_small_picture *picture, uint32_t count,
                                  asj_pyramid *pyramid, int16_t *patch)
{
    asj_status status = ASJ_OK;
    for (int32_t channel = 0; channel < 3 && status == ASJ_OK; channel++) {
        asj_watch watch;
        sample_job j = *from;
        asj_small_picture_fill(context, picture, channel, 1, pyramid);
        asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
        j.first = patch + channel * SIDE * SIDE;
        j.watch = &watch;
        asj_parallel(context, context->threads, count, 0, sample_some, &j);
        status = asj_watch_end(&watch);
    }
    return status;
}

asj_status asj_colour_patches_create(asj_context *context, const asj_match_options *options, const asj_small_picture *picture,
                                     double scale, const asj_affine_frame *frames, uint32_t count, asj_colour_patches *patches)
{
    asj_pyramid pyramid;
    const sample_job job = {&pyramid, options, frames, scale, NULL, NULL};
    asj_status status = asj_pyramid_allocate(context, picture->width, picture->height, &pyramid);
    patches->patch = asj_allocate(&context->memory, count, ASJ_COLOUR_PATCH_LENGTH * sizeof *patches->patch);
    patches->hue = asj_allocate(&context->memory, count, sizeof *patches->hue);
    if (status == ASJ_OK && (!patches->patch || !patches->hue))
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the colours of %lu patches", (unsigned long)count);
    if (status == ASJ_OK)
        status = sample_channels(context, &job, picture, count, &pyramid, patches->patch);
    if (status == ASJ_OK) {
        const hue_job hues = {patches->patch, patches->hue};
        asj_parallel(context, context->threads, count, 0, find_hues, &hues);
    }
    asj_pyramid_free(&context->memory, &pyramid);
    return status;
}

void asj_colour_patches_free(asj_memory *memory, asj_colour_patches *patches)
{
    asj_release_much(memory, patches->patch);
    asj_release_much(memory, patches->hue);
    *patches = (asj_colour_patches){NULL, NULL};
}
