/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_IMAGE_H
#define ASJ_IMAGE_H

#include <asj/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Pixel formats. Channels are interleaved; 16-bit samples and floats are in the machine's byte order.
 * Colour is reduced to luma as (77 R + 150 G + 29 B + 128) >> 8 (BT.601 weights in 8 bits); alpha is ignored. The
 * colours themselves are looked at by the detector with asj_detect_options.colours (which asj_match_images() sets now and then,
 * look_at_colours), by a match with a geometry (match.h) and by features. */
enum {
    ASJ_FORMAT_GRAY8 = 1,
    ASJ_FORMAT_GRAY16 = 2,
    ASJ_FORMAT_RGB8 = 3,
    ASJ_FORMAT_BGR8 = 4,
    ASJ_FORMAT_RGBA8 = 5,
    ASJ_FORMAT_BGRA8 = 6,
    ASJ_FORMAT_GRAY_FLOAT = 7 /* 32-bit; NaN and infinity are refused with ASJ_ERROR_IMAGE */
};

/* Longest side and largest number of pixels that the library takes. */
#define ASJ_MAX_SIDE 65535
#define ASJ_MAX_PIXELS 0x20000000 /* 536 870 912 */

/* A view of pixels that the caller owns. The library only reads it, and only during the call.
 *
 * Coordinates everywhere in this library: the centre of the first pixel is (0, 0), x points right, y points down, and the
 * centres of all pixels lie at integers. Angles are in radians in [0, 2 pi), from +x towards +y: clockwise on the screen. */
typedef struct asj_image {
    const void *data;   /* first sample of the top row, wherever that stands */
    int32_t format;     /* ASJ_FORMAT_... */
    int32_t width;      /* pixels, 1 .. ASJ_MAX_SIDE */
    int32_t height;     /* pixels, 1 .. ASJ_MAX_SIDE */
    float white;        /* sample value that means white: finite, not negative; 0 = the format's: 255, 65535, or 1.0 for floats. A
                         * 10-bit camera in 16-bit samples has 1023. Values above it are cut, and so are those below 0. */
    ptrdiff_t stride;   /* bytes from one row to the one below it, at least a row long; 0 = rows without gaps. Negative where images
                         * are stored bottom-up: `data` then points into the last row of the memory */
} asj_image;

#ifdef __cplusplus
}
#endif
#endif
