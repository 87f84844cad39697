/* SPDX-License-Identifier: BSD-2-Clause */
/* What the core and libasj-io, with its programs, have to agree about in pixels. In C and C++. */
#ifndef ASJ_SRC_SHARED_PIXELS_H
#define ASJ_SRC_SHARED_PIXELS_H

#include <asj/image.h>

/* Luma of colour: weights of BT.601 in 8 bits. They add up to 256. */
#define ASJ_LUMA_RED 77
#define ASJ_LUMA_GREEN 150
#define ASJ_LUMA_BLUE 29
#define ASJ_LUMA_BITS 8
#define ASJ_LUMA_HALF 128

/* Of whole numbers of up to 16 bits, rounded. */
static inline uint16_t asj_luma16(uint32_t red, uint32_t green, uint32_t blue)
{
    return (uint16_t)((ASJ_LUMA_RED * red + ASJ_LUMA_GREEN * green + ASJ_LUMA_BLUE * blue + ASJ_LUMA_HALF) >> ASJ_LUMA_BITS);
}

static inline float asj_luma_float(float red, float green, float blue)
{
    return (ASJ_LUMA_RED * red + ASJ_LUMA_GREEN * green + ASJ_LUMA_BLUE * blue) / (1 << ASJ_LUMA_BITS);
}

/* Bytes of one pixel, or 0 for an unknown format. */
static inline int32_t asj_pixel_size(int32_t format)
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

/* Byte of a pixel of 8-bit colour at which red stands; blue is at 2 minus that, green between them. -1 = no such format. */
static inline int32_t asj_red_of(int32_t format)
{
    switch (format) {
    case ASJ_FORMAT_RGB8:
    case ASJ_FORMAT_RGBA8: return 0;
    case ASJ_FORMAT_BGR8:
    case ASJ_FORMAT_BGRA8: return 2;
    default: return -1;
    }
}

/* Of a view of a known format with sides from 1 on: does the stride hold a row, and do all rows fit into memory? */
static inline int asj_stride_holds_row(const asj_image *image)
{
    const ptrdiff_t row = (ptrdiff_t)image->width * asj_pixel_size(image->format);
    return image->stride == 0 || image->stride >= row || image->stride <= -row;
}

static inline int asj_stride_fits_memory(const asj_image *image)
{
    const ptrdiff_t longest = PTRDIFF_MAX / image->height;
    return image->stride <= longest && image->stride >= -longest;
}

#endif
