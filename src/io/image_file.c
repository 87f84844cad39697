/* SPDX-License-Identifier: BSD-2-Clause */
/* Image files: reads the bytes, chooses the decoder by content, turns the pixels upright. */
#include <asj/io.h>

#include "exif.h"
#include "image_buffer.h"

#include <stdlib.h>

/* What asj_image_file points to: the public part first. */
typedef struct owned_image {
    asj_image_file file;
    unsigned char *pixels;
} owned_image;

size_t asj_pixel_size(int32_t format)
{
    switch (format) {
    case ASJ_FORMAT_GRAY8: return 1;
    case ASJ_FORMAT_GRAY16: return 2;
    case ASJ_FORMAT_RGB8:
    case ASJ_FORMAT_BGR8: return 3;
    case ASJ_FORMAT_RGBA8:
    case ASJ_FORMAT_BGRA8:
    case ASJ_FORMAT_GRAY_FLOAT: return 4;
    default: return 0;
    }
}

uint16_t asj_luma16(uint32_t red, uint32_t green, uint32_t blue)
{
    return (uint16_t)((77 * red + 150 * green + 29 * blue + 128) >> 8);
}

asj_status asj_check_declared_size(uint64_t width, uint64_t height, uint64_t max_pixels, const asj_message *message)
{
    unsigned long long w = width, h = height, limit = max_pixels;
    if (!width || !height)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "the image has no pixels (%llu x %llu)", w, h);
    if (width > ASJ_MAX_SIDE || height > ASJ_MAX_SIDE)
        return asj_message_fail(message, ASJ_ERROR_LIMIT, "%llu x %llu pixels: a side is longer than %d", w, h, ASJ_MAX_SIDE);
    if (width * height > max_pixels)
        return asj_message_fail(message, ASJ_ERROR_LIMIT, "%llu x %llu pixels are more than the limit of %llu", w, h, limit);
    return ASJ_OK;
}

/* Exchanges the pixels for an upright copy. */
static asj_status turn_upright(asj_image_buffer *buffer, const asj_message *message)
{
    size_t size = asj_pixel_size(buffer->format);
    int32_t width = buffer->width;
    unsigned char *copy;

    if (buffer->orientation == 1)
        return ASJ_OK;
    copy = malloc((size_t)buffer->width * (size_t)buffer->height * size);
    if (!copy)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for the pixels");
    asj_turn_upright(copy, buffer->pixels, (ptrdiff_t)((size_t)width * size), width, buffer->height, size, buffer->orientation);
    free(buffer->pixels);
    buffer->pixels = copy;
    if (buffer->orientation >= 5) {
        buffer->width = buffer->height;
        buffer->height = width;
    }
    return ASJ_OK;
}

static asj_status wrap(const asj_image_buffer *buffer, asj_image_file **file, const asj_message *message)
{
    owned_image *owned = calloc(1, sizeof *owned);
    if (!owned)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory");
    owned->pixels = buffer->pixels;
    owned->file.image.data = buffer->pixels;
    owned->file.image.format = buffer->format;
    owned->file.image.width = buffer->width;
    owned->file.image.height = buffer->height;
    owned->file.orientation = buffer->orientation;
    *file = &owned->file;
    return ASJ_OK;
}

asj_status asj_image_file_read(const char *path, uint64_t max_pixels, asj_image_file **file, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    asj_image_buffer buffer = {0};
    asj_input input;
    asj_status status;

    if (!path || !file)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no place for the image");
    *file = NULL;
    if (!max_pixels)
        max_pixels = ASJ_IO_DEFAULT_MAX_PIXELS;
    status = asj_input_read(&input, &message);
    if (status != ASJ_OK)
        return status;
    if (asj_png_recognise(&input))
        status = asj_png_decode(&input, max_pixels, &buffer, &message);
    else
        status = asj_other_decode(&input, max_pixels, &buffer, &message);
    free(input.bytes);
    if (status == ASJ_OK)
        status = turn_upright(&buffer, &message);
    if (status == ASJ_OK)
        status = wrap(&buffer, file, &message);
    if (status != ASJ_OK)
        free(buffer.pixels);
    return status;
}

void asj_image_file_free(asj_image_file **file)
{
    owned_image *owned;
    if (!file || !*file)
        return;
    owned = (owned_image *)(void *)*file;
    free(owned->pixels);
    free(owned);
    *file = NULL;
}
