/* SPDX-License-Identifier: BSD-2-Clause */
/* Features that outlive the call that made them.
 *
 * They are made in the context's memory, as asj_match() makes them, and copied into one block of the right size: the context's
 * blocks are used again for the next image, and a copy takes a hundredth of the time that making them takes. */
#include "kept_features.h"
#include "core/backend.h"
#include "describe.h"
#include "match_options.h"

#include <string.h>

/* One of the arrays: the pointer to it, where it stands in an asj_features, and its size. */
typedef struct piece {
    size_t pointer; /* offset of the pointer in asj_features */
    size_t bytes;
} piece;

#define MOST_PIECES 32

#define PIECE(member, count) \
    list[n++] = (piece){offsetof(asj_features, member), (size_t)(count) * sizeof *features->member}

/* All arrays of features, whose counts and options are set. */
static size_t list_pieces(const asj_features *features, piece *list)
{
    const asj_l_junctions *l = &features->of_image.l_junctions;
    const asj_pyramid *pyramid = &features->of_image.pyramid;
    const size_t patches = features->options.patches == ASJ_PATCHES_CANONICAL ? l->frame_count : l->count;
    size_t n = 0;
    PIECE(junctions, features->junction_count);
    PIECE(l_junctions, l->enlarged ? l->count : 0);
    PIECE(of_image.l_junctions.l, l->count);
    PIECE(of_image.l_junctions.lengths, 2 * (size_t)l->count);
    PIECE(of_image.l_junctions.direction, 4 * (size_t)l->count);
    PIECE(of_image.l_junctions.first_frame, (size_t)l->count + 1);
    PIECE(of_image.l_junctions.frames, l->frame_count);
    PIECE(of_image.l_junctions.location, l->count);
    PIECE(of_image.l_junctions.first_of_location, (size_t)l->location_count + 1);
    PIECE(of_image.l_junctions.l_of_location, l->count);
    PIECE(of_image.l_junctions.location_x, l->location_count);
    PIECE(of_image.l_junctions.location_y, l->location_count);
    PIECE(of_image.l_junctions.octave, l->count);
    PIECE(of_image.l_junctions.t_junction, l->count);
    if (l->neighbour_limit > 0) {
        PIECE(of_image.l_junctions.neighbour, (size_t)l->location_count * l->neighbour_limit);
        PIECE(of_image.l_junctions.neighbour_count, l->location_count);
    }
    PIECE(of_image.patches, patches * (size_t)asj_patch_length(&features->options));
    PIECE(of_image.usable, patches);
    if (features->of_image.colours)
        PIECE(of_image.colours, l->count);
    for (int32_t level = 0; level < pyramid->levels; level++)
        list[n++] = (piece){offsetof(asj_features, of_image.pyramid.plane) + (size_t)level * sizeof(uint16_t *),
                            ((size_t)pyramid->width[level] + 1) * ((size_t)pyramid->height[level] + 1) * sizeof(uint16_t)};
    return n;
}

static size_t aligned(size_t bytes)
{
    return (bytes + ASJ_ALIGNMENT - 1) / ASJ_ALIGNMENT * ASJ_ALIGNMENT;
}

/* All of it in one block: `start` holds pointers to what is copied. */
static asj_status copy(asj_context *context, asj_features *start, asj_features **features)
{
    asj_memory memory = {.allocator = context->memory.allocator};
    piece list[MOST_PIECES];
    const size_t pieces = list_pieces(start, list);
    size_t total = aligned(sizeof *start);
    for (size_t n = 0; n < pieces; n++)
        total += aligned(list[n].bytes);
    char *block = asj_allocate(&memory, total, 1);
    if (!block)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu bytes of features", total);
    char *next = block + aligned(sizeof *start);
    for (size_t n = 0; n < pieces; n++) {
        const void *from;
        memcpy(&from, (const char *)start + list[n].pointer, sizeof from);
        if (list[n].bytes > 0)
            memcpy(next, from, list[n].bytes);
        memcpy((char *)start + list[n].pointer, &next, sizeof next);
        next += aligned(list[n].bytes);
    }
    start->memory = memory;
    *features = memcpy(block, start, sizeof *start);
    return ASJ_OK;
}

asj_status asj_features_keep(asj_context *context, const asj_match_options *options, const asj_junction *junctions, size_t count,
                             const asj_image_features *made, asj_features **features)
{
    asj_features start = {.options = *options, .junction_count = (uint32_t)count, .of_image = *made};
    const size_t l_count = made->l_junctions.enlarged ? made->l_junctions.count : 0;
    if (count > UINT32_MAX)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%zu junctions are more than features take", count);
    start.of_image.device_copy = 0;
    start.of_image.pyramid.ops = NULL;
    memcpy(&start.junctions, &junctions, sizeof junctions);
    start.l_junctions = asj_allocate(&context->memory, l_count, sizeof *start.l_junctions);
    if (!start.l_junctions)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu L-junctions", l_count);
    if (l_count > 0)
        asj_decompose(junctions, count, options->minimum_opening, start.l_junctions, l_count);
    asj_l_junction *own = start.l_junctions;
    const asj_status status = copy(context, &start, features);
    asj_release(&context->memory, own);
    return status;
}

asj_image_features asj_features_view(const asj_context *context, const asj_features *features)
{
    asj_image_features view = features->of_image;
    view.pyramid.ops = context->ops;
    return view;
}

static asj_status create(asj_context *context, const asj_image *image, const asj_junction *junctions, size_t count,
                         const asj_match_options *options, asj_features **features)
{
    asj_image_features made;
    asj_status status = asj_progress(context, ASJ_STAGE_PATCHES, 0);
    if (status == ASJ_OK)
        status = asj_image_features_create(context, options, image, junctions, count, 1, &made);
    if (status != ASJ_OK)
        return status;
    status = asj_colours_create(context, image, &made.l_junctions, &made.colours);
    if (status == ASJ_OK)
        status = asj_features_keep(context, options, junctions, count, &made, features);
    asj_image_features_free(&context->memory, &made);
    if (status == ASJ_OK && (status = asj_progress(context, ASJ_STAGE_PATCHES, 1)) != ASJ_OK)
        asj_features_free(features);
    return status;
}

asj_status asj_features_create(asj_context *context, const asj_image *image, const asj_junction *junctions, size_t count,
                               const asj_match_options *options, asj_features **features)
{
    asj_match_options defaults;
    char message[256];
    if (features)
        *features = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!image || !features || (!junctions && count > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the image, the junctions or the result is NULL");
    if (!options) {
        asj_match_options_init(&defaults);
        options = &defaults;
    }
    if (asj_match_options_check(options, message, sizeof message) != ASJ_OK)
        return asj_fail(context, ASJ_ERROR_OPTION, "%s", message);
    asj_status status;
    asj_backend_begin(context);
    do
        status = create(context, image, junctions, count, options, features);
    while (asj_backend_retry(context, status));
    return status;
}

void asj_features_free(asj_features **pointer)
{
    if (!pointer || !*pointer)
        return;
    asj_memory memory = (*pointer)->memory;
    asj_release(&memory, *pointer);
    *pointer = NULL;
}

void asj_features_get_info(const asj_features *features, asj_features_info *info)
{
    if (!info)
        return;
    memset(info, 0, sizeof *info);
    if (!features)
        return;
    const asj_image_features *of_image = &features->of_image;
    const int32_t times = of_image->l_junctions.enlarged ? 2 : 1;
    info->width = of_image->pyramid.width[0] / times;
    info->height = of_image->pyramid.height[0] / times;
    info->junction_count = features->junction_count;
    info->junctions = features->junction_count ? features->junctions : NULL;
    info->l_junction_count = of_image->l_junctions.count;
    info->l_junctions = of_image->l_junctions.count ? (times > 1 ? features->l_junctions : of_image->l_junctions.l) : NULL;
    info->options = &features->options;
    info->bytes = features->memory.now;
}
