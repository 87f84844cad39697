/* SPDX-License-Identifier: BSD-2-Clause */
/* Where the pixels of an image stand (asj/image.h). */
#ifndef ASJ_CLI_PIXELS_H
#define ASJ_CLI_PIXELS_H

#include <asj/image.h>

#include <stddef.h>

/* Bytes of a pixel. */
static inline size_t cli_pixel_size(int32_t format)
{
    switch (format) {
    case ASJ_FORMAT_GRAY8: return 1;
    case ASJ_FORMAT_GRAY16: return 2;
    case ASJ_FORMAT_RGB8:
    case ASJ_FORMAT_BGR8: return 3;
    default: return 4;
    }
}

static inline const unsigned char *cli_pixel_at(const asj_image *image, int32_t x, int32_t y)
{
    const size_t size = cli_pixel_size(image->format);
    const ptrdiff_t stride = image->stride ? image->stride : (ptrdiff_t)((size_t)image->width * size);
    return (const unsigned char *)image->data + y * stride + (ptrdiff_t)((size_t)x * size);
}

#endif
