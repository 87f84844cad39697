/* SPDX-License-Identifier: BSD-2-Clause */
/* What all decoders share. */
#include "image_buffer.h"

#include <stdlib.h>

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

asj_status asj_image_allocate(asj_image_buffer *buffer, uint64_t width, uint64_t height, int32_t format, uint64_t max_pixels,
                              const asj_message *message)
{
    asj_status status = asj_check_declared_size(width, height, max_pixels, message);

    if (status != ASJ_OK)
        return status;
    buffer->width = (int32_t)width;
    buffer->height = (int32_t)height;
    buffer->format = format;
    const size_t pixel = (size_t)asj_pixel_size(format);
    buffer->pixels = height > SIZE_MAX / (width * pixel) ? NULL : malloc((size_t)height * ((size_t)width * pixel));
    return buffer->pixels ? ASJ_OK : asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for the pixels");
}
