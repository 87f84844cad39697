/* SPDX-License-Identifier: BSD-2-Clause */
/* WebP through libwebp: RGB8. Transparency is ignored, and so every stored colour counts. */
#include "image_buffer.h"

#include <webp/decode.h>

asj_status asj_webp_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                           const asj_message *message)
{
    WebPBitstreamFeatures features;
    VP8StatusCode state = WebPGetFeatures(input->bytes, input->size, &features);
    asj_status status;
    int row;

    (void)probe;
    if (state == VP8_STATUS_NOT_ENOUGH_DATA)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "truncated WebP: the file ends before the image does");
    if (state != VP8_STATUS_OK)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged WebP");
    if (features.has_animation)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "a moving WebP is not read");
    status = asj_image_allocate(buffer, (uint64_t)features.width, (uint64_t)features.height, ASJ_FORMAT_RGB8, max_pixels, message);
    if (status != ASJ_OK)
        return status;
    row = 3 * buffer->width;
    if (!WebPDecodeRGBInto(input->bytes, input->size, buffer->pixels, (size_t)row * (size_t)buffer->height, row))
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged or truncated WebP");
    return ASJ_OK;
}
