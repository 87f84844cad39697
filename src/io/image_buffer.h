/* SPDX-License-Identifier: BSD-2-Clause */
/* Pixels on their way from a decoder to the caller. */
#ifndef ASJ_IO_IMAGE_BUFFER_H
#define ASJ_IO_IMAGE_BUFFER_H

#include <asj/image.h>

#include "input.h"

typedef struct asj_image_buffer {
    unsigned char *pixels; /* malloc; rows without gaps */
    int32_t width, height;
    int32_t format;        /* ASJ_FORMAT_... */
    int32_t orientation;   /* EXIF: how `pixels` are stored */
} asj_image_buffer;

/* Bytes of one pixel, or 0 for an unknown format. */
size_t asj_pixel_size(int32_t format);

/* ASJ_OK, or ASJ_ERROR_FORMAT for a side of 0, or ASJ_ERROR_LIMIT, for the size that a file declares. */
asj_status asj_check_declared_size(uint64_t width, uint64_t height, uint64_t max_pixels, const asj_message *message);

/* Luma of 16-bit colour, with the weights that the core uses for 8 bits (image.h), so that depth is not thrown away. */
uint16_t asj_luma16(uint32_t red, uint32_t green, uint32_t blue);

/* 1 when the bytes begin like a PNG file. */
int asj_png_recognise(const asj_input *input);

/* Decode a file's bytes. On success the caller frees buffer->pixels. asj_other_decode() may change the bytes.
 * ASJ_ERROR_FORMAT, ASJ_ERROR_LIMIT, ASJ_ERROR_UNSUPPORTED, ASJ_ERROR_MEMORY */
asj_status asj_png_decode(const asj_input *input, uint64_t max_pixels, asj_image_buffer *buffer, const asj_message *message);
asj_status asj_other_decode(const asj_input *input, uint64_t max_pixels, asj_image_buffer *buffer, const asj_message *message);

#endif
