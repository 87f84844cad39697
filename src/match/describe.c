/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, canonical patches: every frame of an L-junction takes the unit square to its own neighbourhood, so patches of two
 * L-junctions are compared without warping either by the pair's map (patch.c, sift.c). The paper's patches, warped by each
 * pair's map, are in patch_induced.c. */
#include "describe.h"
#include "sift.h"
#include "core/watch.h"

int32_t asj_patch_length(const asj_match_options *options)
{
    return options->descriptor == ASJ_DESCRIPTOR_SIFT ? ASJ_SIFT_LENGTH : options->patch_size * options->patch_size;
}

int32_t asj_patch_units(const asj_match_options *options)
{
    return options->descriptor == ASJ_DESCRIPTOR_SIFT || options->normalise;
}

static void describe(const asj_match_options *options, const asj_pyramid *pyramid, const uint16_t *grey, int16_t *unit)
{
    if (options->descriptor == ASJ_DESCRIPTOR_SIFT)
        asj_sift_describe(grey, options->patch_size, unit);
    else if (options->normalise)
        pyramid->ops->patch->normalise(grey, options->patch_size, unit);
    else
        asj_patch_scale(grey, options->patch_size, unit);
}

typedef struct job {
    const asj_match_options *options;
    asj_image_features *features;
    asj_watch *watch;
} job;

static void describe_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_match_options *options = j->options;
    asj_image_features *features = j->features;
    const size_t length = (size_t)asj_patch_length(options);
    for (int64_t f = part->first; f < part->end && !asj_watch_stops(j->watch, part); f++) {
        uint16_t grey[ASJ_PATCH_SAMPLES];
        features->usable[f] = (uint8_t)asj_patch_sample(&features->pyramid, &features->l_junctions.frames[f], options->patch_size,
                                                        options->window_start, options->window_end, grey);
        describe(options, &features->pyramid, grey, features->patches + (size_t)f * length);
    }
}

asj_status asj_describe_frames(asj_context *context, const asj_match_options *options, asj_image_features *features)
{
    asj_watch watch;
    const job j = {options, features, &watch};
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    asj_parallel(context, context->threads, features->l_junctions.frame_count, 0, describe_some, &j);
    return asj_watch_end(&watch);
}

asj_status asj_describe(asj_context *context, const asj_match_options *options, asj_image_features *features)
{
    const size_t length = (size_t)asj_patch_length(options), count = features->l_junctions.frame_count;
    features->device_copy = 0;
    features->patches = asj_allocate(&context->memory, count, length * sizeof *features->patches);
    features->usable = asj_allocate(&context->memory, count, sizeof *features->usable);
    if (!features->patches || !features->usable)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu patches", count);
    return context->ops->describe->frames(context, options, features);
}

const asj_describe_ops asj_describe_reference = {.frames = asj_describe_frames};
