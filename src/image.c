/* SPDX-License-Identifier: BSD-2-Clause */
#include "image.h"

#include <math.h>
#include <string.h>

typedef struct format_info {
    int32_t bytes_per_pixel;
    float white;
    const char *name;
} format_info;

static const format_info *find_format(int32_t format)
{
    static const format_info table[] = {
        [ASJ_FORMAT_GRAY8] = {1, 255, "gray8"},   [ASJ_FORMAT_GRAY16] = {2, 65535, "gray16"},
        [ASJ_FORMAT_RGB8] = {3, 255, "rgb8"},     [ASJ_FORMAT_BGR8] = {3, 255, "bgr8"},
        [ASJ_FORMAT_RGBA8] = {4, 255, "rgba8"},   [ASJ_FORMAT_BGRA8] = {4, 255, "bgra8"},
        [ASJ_FORMAT_GRAY_FLOAT] = {4, 1, "gray float"},
    };
    return format >= ASJ_FORMAT_GRAY8 && format <= ASJ_FORMAT_GRAY_FLOAT ? &table[format] : NULL;
}

asj_status asj_image_check(asj_context *context, const asj_image *image)
{
    const format_info *format = find_format(image->format);
    if (!image->data)
        return asj_fail(context, ASJ_ERROR_IMAGE, "the image has no data");
    if (!format)
        return asj_fail(context, ASJ_ERROR_IMAGE, "image format %d is unknown", (int)image->format);
    if (image->width < 1 || image->height < 1)
        return asj_fail(context, ASJ_ERROR_IMAGE, "an image of %d x %d pixels is empty", (int)image->width, (int)image->height);
    if (image->width > ASJ_MAX_SIDE || image->height > ASJ_MAX_SIDE ||
        (int64_t)image->width * image->height > ASJ_MAX_PIXELS)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%d x %d pixels are more than the library takes (side %d, %d pixels in all)",
                        (int)image->width, (int)image->height, ASJ_MAX_SIDE, ASJ_MAX_PIXELS);
    ptrdiff_t row = (ptrdiff_t)image->width * format->bytes_per_pixel;
    if (image->stride != 0 && image->stride < row)
        return asj_fail(context, ASJ_ERROR_IMAGE, "stride %lld is shorter than a row of %d %s pixels (%lld bytes)",
                        (long long)image->stride, (int)image->width, format->name, (long long)row);
    if (!(image->white >= 0) || isinf(image->white))
        return asj_fail(context, ASJ_ERROR_IMAGE, "white level %g is not a level", (double)image->white);
    return ASJ_OK;
}

static asj_status prepare_plane(asj_context *context, asj_frame *frame, int plane, size_t count)
{
    void *block = frame->memory[plane];
    if (frame->capacity[plane] >= count)
        return ASJ_OK;
    asj_release(&context->memory, block);
    frame->memory[plane] = NULL;
    frame->capacity[plane] = 0;
    block = asj_allocate(&context->memory, count, sizeof(int16_t));
    if (!block)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a plane of %zu samples", count);
    frame->memory[plane] = block;
    frame->capacity[plane] = count;
    return ASJ_OK;
}

asj_status asj_frame_prepare(asj_context *context, asj_frame *frame, int32_t width, int32_t height)
{
    frame->width = width;
    frame->height = height;
    frame->blocks = (width + ASJ_LANES - 1) / ASJ_LANES;
    frame->stride = (ptrdiff_t)frame->blocks * ASJ_LANES + 2 * ASJ_MARGIN;
    size_t stride = (size_t)frame->stride, padded = stride * ((size_t)height + 2 * ASJ_MARGIN);
    asj_status status = prepare_plane(context, frame, 0, stride * (size_t)height);
    if (status == ASJ_OK)
        status = prepare_plane(context, frame, 1, padded);
    if (status == ASJ_OK)
        status = prepare_plane(context, frame, 2, padded);
    if (status != ASJ_OK)
        return status;
    size_t origin = ASJ_MARGIN * stride + ASJ_MARGIN;
    frame->gray = frame->memory[0];
    frame->gradient_x = (int16_t *)frame->memory[1] + origin;
    frame->gradient_y = (int16_t *)frame->memory[2] + origin;
    for (int plane = 1; plane <= 2; plane++) {
        int16_t *rows = frame->memory[plane];
        memset(rows, 0, ASJ_MARGIN * stride * sizeof *rows);
        memset(rows + padded - ASJ_MARGIN * stride, 0, ASJ_MARGIN * stride * sizeof *rows);
        for (int32_t y = 0; y < height; y++) {
            int16_t *row = rows + (size_t)(y + ASJ_MARGIN) * stride;
            memset(row, 0, ASJ_MARGIN * sizeof *row);
            memset(row + ASJ_MARGIN + width, 0, (stride - ASJ_MARGIN - (size_t)width) * sizeof *row);
        }
    }
    return ASJ_OK;
}

void asj_frame_free(asj_memory *memory, asj_frame *frame)
{
    for (int plane = 0; plane < 3; plane++)
        asj_release(memory, frame->memory[plane]);
    memset(frame, 0, sizeof *frame);
}

/* 8-bit colour to luma, BT.601 weights in 8 bits: (77 R + 150 G + 29 B + 128) >> 8. */
static void load_colour(uint16_t *gray, const uint8_t *pixel, int32_t width, int step, int red, int blue, const uint16_t *levels)
{
    for (int32_t x = 0; x < width; x++, pixel += step)
        gray[x] = levels[(77 * pixel[red] + 150 * pixel[1] + 29 * pixel[blue] + 128) >> 8];
}

/* A level rounded and cut. With a white level next to zero the scale is infinite, and black times that is NaN: black. */
static inline uint16_t cut(float level)
{
    return !(level > 0) ? 0 : level >= ASJ_GRAY_MAX ? ASJ_GRAY_MAX : (uint16_t)(level + 0.5f);
}

/* Rows may stand at any byte (stride), so samples are copied, not read in place. */
static void load_words(uint16_t *gray, const uint8_t *bytes, int32_t width, float scale)
{
    for (int32_t x = 0; x < width; x++) {
        uint16_t sample;
        memcpy(&sample, bytes + (size_t)x * sizeof sample, sizeof sample);
        gray[x] = cut((float)sample * scale);
    }
}

/* Returns 0 when a sample is NaN or infinite. */
static int load_float(uint16_t *gray, const uint8_t *bytes, int32_t width, float scale)
{
    for (int32_t x = 0; x < width; x++) {
        float sample;
        memcpy(&sample, bytes + (size_t)x * sizeof sample, sizeof sample);
        if (!isfinite(sample))
            return 0;
        gray[x] = cut(sample * scale);
    }
    return 1;
}

static int load_row(uint16_t *gray, const void *row, const asj_image *image, float scale, const uint16_t *levels)
{
    const uint8_t *bytes = row;
    int32_t width = image->width;
    switch (image->format) {
    case ASJ_FORMAT_GRAY8:
        for (int32_t x = 0; x < width; x++)
            gray[x] = levels[bytes[x]];
        return 1;
    case ASJ_FORMAT_GRAY16:
        load_words(gray, bytes, width, scale);
        return 1;
    case ASJ_FORMAT_RGB8: load_colour(gray, bytes, width, 3, 0, 2, levels); return 1;
    case ASJ_FORMAT_BGR8: load_colour(gray, bytes, width, 3, 2, 0, levels); return 1;
    case ASJ_FORMAT_RGBA8: load_colour(gray, bytes, width, 4, 0, 2, levels); return 1;
    case ASJ_FORMAT_BGRA8: load_colour(gray, bytes, width, 4, 2, 0, levels); return 1;
    default: return load_float(gray, bytes, width, scale);
    }
}

asj_status asj_frame_load(asj_context *context, asj_frame *frame, const asj_image *image)
{
    const format_info *format = find_format(image->format);
    float white = image->white > 0 ? image->white : format->white;
    float scale = (float)ASJ_GRAY_MAX / white;
    ptrdiff_t stride = image->stride ? image->stride : (ptrdiff_t)image->width * format->bytes_per_pixel;
    uint16_t levels[256]; /* 8-bit samples */
    for (int i = 0; i < 256; i++)
        levels[i] = cut((float)i * scale);
    for (int32_t y = 0; y < image->height; y++) {
        const char *row = (const char *)image->data + (ptrdiff_t)y * stride;
        if (!load_row(frame->gray + (ptrdiff_t)y * frame->stride, row, image, scale, levels))
            return asj_fail(context, ASJ_ERROR_IMAGE, "row %d of the image holds NaN or infinity", (int)y);
    }
    return ASJ_OK;
}
