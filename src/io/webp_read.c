/* SPDX-License-Identifier: BSD-2-Clause */
/* WebP through libwebp: RGB8. Transparency is ignored, and so every stored colour counts. */
#include "image_buffer.h"

#include <webp/decode.h>

asj_status asj_webp_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                           const asj_message *message)
{
    WebPDecoderConfig config;
    VP8StatusCode state;
    asj_status status;

    (void)probe;
    if (!WebPInitDecoderConfig(&config))
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "libwebp is of another version than its header");
    state = WebPGetFeatures(input->bytes, input->size, &config.input);
    if (state == VP8_STATUS_NOT_ENOUGH_DATA)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "truncated WebP: the file ends before the image does");
    if (state != VP8_STATUS_OK)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged WebP");
    if (config.input.has_animation)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "a moving WebP is not read");
    status = asj_image_allocate(buffer, (uint64_t)config.input.width, (uint64_t)config.input.height, ASJ_FORMAT_RGB8, max_pixels,
                                message);
    if (status != ASJ_OK)
        return status;
    config.output.colorspace = MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = buffer->pixels;
    config.output.u.RGBA.stride = 3 * buffer->width;
    config.output.u.RGBA.size = (size_t)config.output.u.RGBA.stride * (size_t)buffer->height;
    state = WebPDecode(input->bytes, input->size, &config);
    if (state == VP8_STATUS_OUT_OF_MEMORY || state == VP8_STATUS_USER_ABORT) /* nobody aborts: no memory for rows */
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for WebP");
    if (state != VP8_STATUS_OK)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged or truncated WebP");
    return ASJ_OK;
}
