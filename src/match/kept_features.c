/* SPDX-License-Identifier: BSD-2-Clause */
/* Features that outlive the call that made them.
 *
 * They are made in the context's memory, as asj_match() makes them, and copied into one block of the right size: the context's
 * blocks are used again for the next image, and a copy takes a hundredth of the time that making them takes. */
#include "kept_features.h"
#include "core/backend.h"
#include "core/image.h"
#include "core/most_junctions.h"
#include "core/watch.h"
#include "describe.h"
#include "upsampled.h"
#include "match_options.h"

#include <string.h>

/* One of the arrays: the pointer to it, where it stands in an asj_features, and its size. */
typedef struct piece {
    size_t pointer; /* offset of the pointer in asj_features */
    size_t bytes;
} piece;

#define MOST_PIECES 64
#define PART ((size_t)8 << 20) /* bytes: a few ms */

/* Of the features of an image that stand `offset` bytes inside of an asj_features. */
#define PIECE(member, count) \
    list[n++] = (piece){offset + offsetof(asj_image_features, member), (size_t)(count) * sizeof *f->member}

static size_t list_of_image(const asj_image_features *f, size_t offset, const asj_match_options *options, piece *list)
{
    const asj_l_junctions *l = &f->l_junctions;
    const asj_pyramid *pyramid = &f->pyramid;
    const size_t patches = options->patches == ASJ_PATCHES_CANONICAL ? l->frame_count : l->count;
    size_t n = 0;
    PIECE(l_junctions.l, l->count);
    PIECE(l_junctions.lengths, 2 * (size_t)l->count);
    PIECE(l_junctions.direction, 4 * (size_t)l->count);
    PIECE(l_junctions.direction_sd, 2 * (size_t)l->count);
    PIECE(l_junctions.first_frame, (size_t)l->count + 1);
    PIECE(l_junctions.frames, l->frame_count);
    PIECE(l_junctions.location, l->count);
    PIECE(l_junctions.first_of_location, (size_t)l->location_count + 1);
    PIECE(l_junctions.l_of_location, l->count);
    PIECE(l_junctions.location_x, l->location_count);
    PIECE(l_junctions.location_y, l->location_count);
    PIECE(l_junctions.octave, l->count);
    PIECE(l_junctions.log10_nfa, l->count);
    PIECE(l_junctions.t_junction, l->count);
    if (l->neighbour_limit > 0) {
        PIECE(l_junctions.neighbour, (size_t)l->location_count * l->neighbour_limit);
        PIECE(l_junctions.neighbour_count, l->location_count);
    }
    PIECE(patches, patches * (size_t)asj_patch_length(options));
    PIECE(usable, patches);
    if (f->colours)
        PIECE(colours, l->count);
    if (f->picture.level)
        PIECE(picture.level, asj_small_picture_bytes(&f->picture));
    for (int32_t level = 0; level < pyramid->levels; level++)
        list[n++] = (piece){offset + offsetof(asj_image_features, pyramid.plane) + (size_t)level * sizeof(uint16_t *),
                            ((size_t)pyramid->width[level] + 1) * ((size_t)pyramid->height[level] + 1) * sizeof(uint16_t)};
    return n;
}

/* All arrays of features, whose counts and options are set. */
static size_t list_pieces(const asj_features *features, piece *list)
{
    const asj_pyramid *pyramid = &features->of_image.pyramid;
    const size_t pixels = (size_t)pyramid->width[0] * (size_t)pyramid->height[0];
    size_t n = 0;
    list[n++] = (piece){offsetof(asj_features, junctions), features->junction_count * sizeof(asj_junction)};
    n += list_of_image(&features->of_image, offsetof(asj_features, of_image), &features->options, list + n);
    if (!features->has_upsampled)
        return n;
    list[n++] = (piece){offsetof(asj_features, l_junctions), features->upsampled.l_junctions.count * sizeof(asj_l_junction)};
    list[n++] = (piece){offsetof(asj_features, gray), pixels * sizeof(uint16_t)};
    return n + list_of_image(&features->upsampled, offsetof(asj_features, upsampled), &features->options, list + n);
}

static size_t aligned(size_t bytes)
{
    return (bytes + ASJ_ALIGNMENT - 1) / ASJ_ALIGNMENT * ASJ_ALIGNMENT;
}

/* In parts, between which the caller is asked. */
static void copy_bytes(char *to, const char *from, size_t bytes, asj_watch *watch)
{
    for (size_t done = 0; done < bytes && !asj_watch_stops(watch, NULL); done += PART) {
        const size_t left = bytes - done;
        memcpy(to + done, from + done, left < PART ? left : PART);
    }
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
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    for (size_t n = 0; n < pieces; n++) {
        const char *from;
        memcpy(&from, (const char *)start + list[n].pointer, sizeof from);
        copy_bytes(next, from, list[n].bytes, &watch);
        memcpy((char *)start + list[n].pointer, &next, sizeof next);
        next += aligned(list[n].bytes);
    }
    start->memory = memory;
    const asj_status status = asj_watch_end(&watch);
    if (status == ASJ_OK)
        *features = memcpy(block, start, sizeof *start);
    else
        asj_release(&memory, block);
    return status;
}

asj_status asj_features_keep(asj_context *context, const asj_match_options *options, const asj_junction *junctions, size_t count,
                             const asj_made_features *made, asj_features **features)
{
    asj_features start = {.options = *options, .junction_count = (uint32_t)count, .has_upsampled = made->gray != NULL,
                          .gray = made->gray, .upsampled = made->upsampled, .of_image = made->own};
    const size_t l_count = start.has_upsampled ? made->upsampled.l_junctions.count : 0;
    start.of_image.device_copy = start.upsampled.device_copy = 0;
    start.of_image.pyramid.ops = start.upsampled.pyramid.ops = NULL;
    memcpy(&start.junctions, &junctions, sizeof junctions);
    asj_l_junction *l_junctions = asj_allocate(&context->memory, l_count, sizeof *l_junctions);
    if (!l_junctions)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu L-junctions", l_count);
    if (l_count > 0)
        asj_decompose(junctions, count, options->minimum_opening, l_junctions, l_count);
    start.l_junctions = start.has_upsampled ? l_junctions : NULL;
    const asj_status status = copy(context, &start, features);
    asj_release(&context->memory, l_junctions);
    return status;
}

asj_image_features asj_features_view(const asj_context *context, const asj_features *features, int32_t upsampled)
{
    asj_image_features view = upsampled && features->has_upsampled ? features->upsampled : features->of_image;
    view.pyramid.ops = context->ops;
    view.picture = features->of_image.picture;
    return view;
}

void asj_made_features_free(asj_memory *memory, asj_made_features *made)
{
    asj_image_features_free(memory, &made->own);
    asj_image_features_free(memory, &made->upsampled);
    asj_release(memory, made->gray);
}

/* The grey levels of the image. */
static asj_status copy_gray(asj_context *context, const asj_image *image, uint16_t **gray)
{
    const size_t width = (size_t)image->width, height = (size_t)image->height;
    asj_frame frame;
    memset(&frame, 0, sizeof frame);
    *gray = asj_allocate(&context->memory, width * height, sizeof **gray);
    asj_status status = *gray ? asj_frame_prepare_gray(context, &frame, image->width, image->height)
                              : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the image of features");
    if (status == ASJ_OK)
        status = asj_frame_load(context, &frame, image, ASJ_PLANE_LUMA);
    for (size_t y = 0; y < height && status == ASJ_OK; y++)
        memcpy(*gray + y * width, frame.gray + (ptrdiff_t)y * frame.stride, width * sizeof **gray);
    asj_frame_free(&context->memory, &frame);
    return status;
}

static asj_status make(asj_context *context, const asj_image *image, const asj_junction *junctions, size_t count, int32_t upsampled,
                       const asj_match_options *options, asj_image_features *made)
{
    const asj_status status = asj_image_features_create(context, options, image, junctions, count, 1, upsampled, made);
    if (status != ASJ_OK)
        return status;
    return upsampled ? asj_colours_create(context, image, &made->l_junctions, &made->colours) /* one picture for both */
                     : asj_image_features_add_colours(context, image, made);
}

static asj_status create(asj_context *context, const asj_image *image, const asj_junction *junctions, size_t count,
                         const asj_match_options *options, asj_features **features)
{
    const int32_t has_upsampled = asj_has_upsampled(junctions, count);
    asj_made_features made;
    memset(&made, 0, sizeof made);
    asj_status status = asj_progress(context, ASJ_STAGE_PATCHES, 0);
    if (status == ASJ_OK)
        status = make(context, image, junctions, count, 0, options, &made.own);
    if (status == ASJ_OK && has_upsampled)
        status = make(context, image, junctions, count, 1, options, &made.upsampled);
    if (status == ASJ_OK && has_upsampled)
        status = copy_gray(context, image, &made.gray);
    if (status == ASJ_OK)
        status = asj_features_keep(context, options, junctions, count, &made, features);
    asj_made_features_free(&context->memory, &made);
    if (status == ASJ_OK && (status = asj_progress(context, ASJ_STAGE_PATCHES, 1)) != ASJ_OK)
        asj_features_free(features);
    return status;
}

asj_status asj_features_create(asj_context *context, const asj_image *image, const asj_junction *junctions, size_t count,
                               const asj_match_options *options, asj_features **features)
{
    asj_match_options defaults;
    if (features)
        *features = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!image || !features || (!junctions && count > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the image, the junctions or the result is NULL");
    if (count > ASJ_MOST_JUNCTIONS)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%zu junctions are too many", count);
    if (!options) {
        asj_match_options_init(&defaults);
        options = &defaults;
    }
    asj_status status = asj_match_request_check(context, options);
    if (status != ASJ_OK)
        return status;
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
    const asj_l_junctions *l = features->has_upsampled ? &features->upsampled.l_junctions : &of_image->l_junctions;
    info->width = of_image->pyramid.width[0];
    info->height = of_image->pyramid.height[0];
    info->junction_count = features->junction_count;
    info->junctions = features->junction_count ? features->junctions : NULL;
    info->l_junction_count = l->count;
    info->l_junctions = l->count == 0 ? NULL : features->has_upsampled ? features->l_junctions : l->l;
    info->options = &features->options;
    info->bytes = features->memory.now;
}
