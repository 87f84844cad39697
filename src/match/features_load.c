/* SPDX-License-Identifier: BSD-2-Clause */
/* Features from bytes: features_bytes.h. What a file says is checked as asj_match() checks what a caller says; what is not there is
 * made again. */
#include "core/backend.h"
#include "core/bytes.h"
#include "core/image.h"
#include "features_bytes.h"
#include "upsampled.h"
#include "kept_features.h"
#include "l_junctions_create.h"
#include "match_options.h"

#include <stdio.h>
#include <string.h>

#define MOST_TEXT 65536 /* bytes of options */
#define SHARING_FROM 1000000 /* bytes of features that share large pages while they are made (core/memory.h) */
#define LATEST_VERSION                                                                                                       \
    (ASJ_FEATURES_VERSION + ASJ_FEATURES_COLOURS + ASJ_FEATURES_UPSAMPLED + ASJ_FEATURES_UPSAMPLED_COLOURS + ASJ_FEATURES_PICTURE)

/* Bytes that are read one after the other. */
typedef struct reader {
    asj_context *context;
    const uint8_t *next;
    size_t left;
    int32_t width, height;
    uint32_t text, count;
    int32_t colours, has_upsampled, upsampled_colours, picture;
} reader;

static asj_status damaged(const reader *r, const char *what)
{
    return asj_fail(r->context, ASJ_ERROR_FORMAT, "the features are damaged: %s", what);
}

static asj_status read_header(reader *r)
{
    const uint8_t *start = r->next;
    const size_t size = r->left;
    if (size < ASJ_FEATURES_MAGIC_SIZE || memcmp(start, ASJ_FEATURES_MAGIC, ASJ_FEATURES_MAGIC_SIZE) != 0)
        return asj_fail(r->context, ASJ_ERROR_FORMAT, "these are no features (.asjf)");
    if (size < ASJ_FEATURES_HEADER)
        return damaged(r, "the header is truncated");
    const uint32_t version = asj_get_u32(start + 8);
    const uint32_t parts = version - ASJ_FEATURES_VERSION;
    if (version < ASJ_FEATURES_VERSION || version > LATEST_VERSION)
        return asj_fail(r->context, ASJ_ERROR_UNSUPPORTED, "the features are of version %lu, and this library reads %d to %d",
                        (unsigned long)version, ASJ_FEATURES_VERSION, LATEST_VERSION);
    if ((parts & (ASJ_FEATURES_UPSAMPLED | ASJ_FEATURES_UPSAMPLED_COLOURS)) == ASJ_FEATURES_UPSAMPLED_COLOURS)
        return damaged(r, "colours of an upsampled image that there is not");
    r->colours = (parts & ASJ_FEATURES_COLOURS) != 0;
    r->has_upsampled = (parts & ASJ_FEATURES_UPSAMPLED) != 0;
    r->upsampled_colours = (parts & ASJ_FEATURES_UPSAMPLED_COLOURS) != 0;
    r->picture = (parts & ASJ_FEATURES_PICTURE) != 0;
    if (asj_get_u64(start + 16) != size)
        return asj_fail(r->context, ASJ_ERROR_FORMAT, "the features are damaged: %zu bytes where there should be %llu", size,
                        (unsigned long long)asj_get_u64(start + 16));
    if (asj_get_u32(start + 12) != asj_crc32(start + ASJ_FEATURES_CHECKED, size - ASJ_FEATURES_CHECKED))
        return damaged(r, "the checksum is wrong");
    const uint32_t width = asj_get_u32(start + 24), height = asj_get_u32(start + 28);
    if (width < 1 || height < 1)
        return damaged(r, "an image without pixels");
    if (width > ASJ_MAX_SIDE || height > ASJ_MAX_SIDE || (uint64_t)width * height > ASJ_MAX_PIXELS)
        return asj_fail(r->context, ASJ_ERROR_LIMIT, "features of an image of %lu x %lu pixels", (unsigned long)width,
                        (unsigned long)height);
    r->width = (int32_t)width;
    r->height = (int32_t)height;
    r->text = asj_get_u32(start + 32);
    r->count = asj_get_u32(start + 36);
    r->next += ASJ_FEATURES_HEADER;
    r->left -= ASJ_FEATURES_HEADER;
    const size_t pixels = (size_t)width * height * 2;
    if (r->text > MOST_TEXT || pixels > r->left || r->text > r->left - pixels ||
        r->count > (r->left - pixels - r->text) / ASJ_FEATURES_JUNCTION_BYTES)
        return damaged(r, "the counts are wrong");
    return ASJ_OK;
}

static asj_status read_options(reader *r, asj_match_options *options)
{
    char line[ASJ_FEATURES_LONGEST_LINE], message[256];
    size_t length = 0;
    asj_match_options_init(options);
    for (uint32_t n = 0; n < r->text; n++) {
        const char c = (char)r->next[n];
        if (c != '\n') {
            if (c < ' ' || c > '~' || length + 1 >= sizeof line)
                return damaged(r, "the options are no text");
            line[length++] = c;
            continue;
        }
        line[length] = 0;
        length = 0;
        char *equals = strchr(line, '=');
        if (!equals)
            return damaged(r, "an option without a value");
        *equals = 0;
        if (asj_match_options_set(options, line, equals + 1, message, sizeof message) != ASJ_OK)
            return asj_fail(r->context, ASJ_ERROR_FORMAT, "the features were made with an option that cannot be: %s", message);
    }
    if (length > 0 || asj_match_options_check(options, message, sizeof message) != ASJ_OK)
        return damaged(r, "the options are not complete");
    r->next += r->text;
    r->left -= r->text;
    return ASJ_OK;
}

static void get_floats(const uint8_t *from, float *const *to, size_t count)
{
    for (size_t n = 0; n < count; n++)
        *to[n] = asj_get_float(from + 4 * n);
}

/* In two's complement, as it was put there. */
static int32_t get_i32(const uint8_t *from)
{
    const uint32_t bits = asj_get_u32(from);
    return bits <= INT32_MAX ? (int32_t)bits : -(int32_t)(UINT32_MAX - bits) - 1;
}

static asj_status read_junction(reader *r, asj_junction *j)
{
    char fault[128];
    float *const head[] = {&j->x, &j->y, &j->scale, &j->log10_nfa, &j->location_sd};
    if (r->left < ASJ_FEATURES_JUNCTION_BYTES)
        return damaged(r, "the junctions are truncated");
    get_floats(r->next, head, 5);
    const uint32_t branches = asj_get_u32(r->next + 20);
    j->octave = get_i32(r->next + 24);
    if (j->octave < 0 && !r->has_upsampled)
        return damaged(r, "a junction of an octave that there is not");
    r->next += ASJ_FEATURES_JUNCTION_BYTES;
    r->left -= ASJ_FEATURES_JUNCTION_BYTES;
    if (branches > ASJ_MAX_BRANCHES || r->left < branches * (size_t)ASJ_FEATURES_BRANCH_BYTES)
        return damaged(r, "a junction has too many branches");
    j->branch_count = (int32_t)branches;
    for (uint32_t b = 0; b < branches; b++, r->next += ASJ_FEATURES_BRANCH_BYTES, r->left -= ASJ_FEATURES_BRANCH_BYTES) {
        asj_branch *branch = &j->branches[b];
        float *const values[] = {&branch->angle, &branch->length, &branch->strength, &branch->log10_nfa, &branch->angle_sd,
                                 &branch->width, &branch->length_sd};
        get_floats(r->next, values, 7);
        branch->end = get_i32(r->next + 28);
    }
    if (asj_junction_check(j, fault, sizeof fault) != ASJ_OK)
        return asj_fail(r->context, ASJ_ERROR_FORMAT, "the features are damaged: a junction that cannot be, with %s", fault);
    return ASJ_OK;
}

/* Rows of `stride` levels. */
static asj_status read_pixels(reader *r, size_t stride, uint16_t *plane)
{
    uint32_t most = 0;
    for (size_t y = 0; y < (size_t)r->height; y++)
        for (size_t x = 0; x < (size_t)r->width; x++, r->next += 2) {
            const uint32_t grey = asj_get_u16(r->next);
            most = grey > most ? grey : most;
            plane[y * stride + x] = (uint16_t)grey;
        }
    r->left -= 2 * (size_t)r->width * (size_t)r->height;
    return most > ASJ_GRAY_MAX ? damaged(r, "a pixel is whiter than white") : ASJ_OK;
}

static asj_status check_pixels(const reader *r)
{
    const size_t bytes = 2 * (size_t)r->width * (size_t)r->height;
    return r->left < bytes || (!r->colours && !r->upsampled_colours && !r->picture && r->left > bytes)
               ? damaged(r, "the pixels are not all there, or there are more")
               : ASJ_OK;
}

/* Level 0 of the pyramid, and the others from it. */
static asj_status read_plane(reader *r, asj_pyramid *pyramid)
{
    asj_status status = check_pixels(r);
    if (status == ASJ_OK)
        status = asj_pyramid_allocate(r->context, r->width, r->height, pyramid);
    if (status == ASJ_OK)
        status = read_pixels(r, (size_t)r->width + 1, pyramid->plane[0]);
    if (status == ASJ_OK)
        asj_pyramid_complete(r->context, pyramid);
    return status;
}

static asj_status read_colours(reader *r, int32_t last, asj_image_features *made)
{
    const uint32_t count = made->l_junctions.count;
    const size_t bytes = ASJ_FEATURES_COLOUR_BYTES * (size_t)count;
    uint32_t most = 0;
    if (r->left < bytes || (last && r->left > bytes))
        return damaged(r, "the colours are not all there, or there are more");
    made->colours = asj_allocate(&r->context->memory, count, sizeof *made->colours);
    if (!made->colours)
        return asj_fail(r->context, ASJ_ERROR_MEMORY, "no memory for the colours of %lu L-junctions", (unsigned long)count);
    for (uint32_t n = 0; n < count; n++)
        for (int32_t k = 0; k < 3 * ASJ_COLOUR_REGIONS; k++, r->next += 2) {
            const uint32_t level = asj_get_u16(r->next);
            most = level > most ? level : most;
            made->colours[n].level[k / 3][k % 3] = (uint16_t)level;
        }
    r->left -= bytes;
    return most > ASJ_GRAY_MAX ? damaged(r, "a colour is brighter than white") : ASJ_OK;
}

static asj_status read_picture(reader *r, asj_small_picture *picture)
{
    asj_status status = asj_small_picture_allocate(r->context, r->width, r->height, picture);
    if (status != ASJ_OK)
        return status;
    const size_t bytes = asj_small_picture_bytes(picture);
    if (r->left != bytes)
        return damaged(r, "the image at half its size is not all there, or there is more");
    if (bytes > 0)
        memcpy(picture->level, r->next, bytes);
    return ASJ_OK;
}

static asj_status make_plain(reader *r, const asj_match_options *options, const asj_junction *junctions, asj_image_features *made)
{
    const asj_image_junctions list = {junctions, r->count, r->width, r->height, 1, 0};
    asj_status status = asj_l_junctions_create(r->context, options, &list, &made->l_junctions);
    if (status == ASJ_OK)
        status = read_plane(r, &made->pyramid);
    return status == ASJ_OK ? asj_image_features_describe(r->context, options, made) : status;
}

/* From the image as it was: both as they were made. */
static asj_status make_upsampled(reader *r, const asj_match_options *options, const asj_junction *junctions,
                                 asj_made_features *made)
{
    asj_status status = check_pixels(r);
    if (status != ASJ_OK)
        return status;
    made->gray = asj_allocate(&r->context->memory, (size_t)r->width * (size_t)r->height, sizeof *made->gray);
    if (!made->gray)
        return asj_fail(r->context, ASJ_ERROR_MEMORY, "no memory for the image of features");
    status = read_pixels(r, (size_t)r->width, made->gray);
    const asj_image image = {made->gray, ASJ_FORMAT_GRAY16, r->width, r->height, ASJ_GRAY_MAX, 0}; /* the same levels again */
    if (status == ASJ_OK)
        status = asj_image_features_create(r->context, options, &image, junctions, r->count, 1, 0, &made->own);
    if (status == ASJ_OK)
        status = asj_image_features_create(r->context, options, &image, junctions, r->count, 1, 1, &made->upsampled);
    return status;
}

static asj_status make(reader *r, const asj_match_options *options, const asj_junction *junctions, asj_made_features *made)
{
    if (r->has_upsampled != asj_has_upsampled(junctions, r->count))
        return damaged(r, "no junction of octave -1");
    asj_status status = r->has_upsampled ? make_upsampled(r, options, junctions, made)
                                         : make_plain(r, options, junctions, &made->own);
    if (status == ASJ_ERROR_ARGUMENT)
        status = damaged(r, "a junction that cannot be");
    if (status == ASJ_OK && r->colours)
        status = read_colours(r, !r->upsampled_colours && !r->picture, &made->own);
    if (status == ASJ_OK && r->upsampled_colours)
        status = read_colours(r, !r->picture, &made->upsampled);
    return status == ASJ_OK && r->picture ? read_picture(r, &made->own.picture) : status;
}

static asj_status load(asj_context *context, const uint8_t *bytes, size_t size, asj_features **features)
{
    reader r = {.context = context, .next = bytes, .left = size};
    asj_match_options options;
    asj_made_features made;
    memset(&made, 0, sizeof made);
    asj_status status = read_header(&r);
    if (status == ASJ_OK && size >= SHARING_FROM && context->memory.sharing == 0) /* else an image has said how */
        asj_memory_share(&context->memory, 1);
    if (status == ASJ_OK)
        status = read_options(&r, &options);
    if (status != ASJ_OK)
        return status;
    asj_junction *junctions = asj_allocate_zero(&context->memory, r.count, sizeof *junctions);
    if (!junctions)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %lu junctions", (unsigned long)r.count);
    for (uint32_t n = 0; n < r.count && status == ASJ_OK; n++)
        status = read_junction(&r, &junctions[n]);
    if (status == ASJ_OK)
        status = make(&r, &options, junctions, &made);
    if (status == ASJ_OK)
        status = asj_features_keep(context, &options, junctions, r.count, &made, features);
    asj_made_features_free(&context->memory, &made);
    asj_release(&context->memory, junctions);
    if (status == ASJ_OK && (status = asj_progress(context, ASJ_STAGE_PATCHES, 1)) != ASJ_OK)
        asj_features_free(features);
    return status;
}

asj_status asj_features_load(asj_context *context, const void *bytes, size_t size, asj_features **features)
{
    if (features)
        *features = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!bytes || !features)
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the bytes or the result is NULL");
    asj_status status;
    asj_backend_begin(context);
    do
        status = load(context, bytes, size, features);
    while (asj_backend_retry(context, status));
    return status;
}
