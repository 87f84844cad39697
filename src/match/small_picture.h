/* SPDX-License-Identifier: BSD-2-Clause */
/* The colours of an image at half its size. */
#ifndef ASJ_SRC_MATCH_SMALL_PICTURE_H
#define ASJ_SRC_MATCH_SMALL_PICTURE_H

#include "core/context.h"
#include "core/pyramid.h"

#include <asj/image.h>

/* An image at half its size, in colours. */
typedef struct asj_small_picture {
    uint8_t *level; /* all of red, then green, then blue, each row by row: means of 2 x 2 pixels; NULL: there is none */
    int32_t width, height;
} asj_small_picture;

/* Bytes of the levels. */
size_t asj_small_picture_bytes(const asj_small_picture *picture);

/* Room for that of an image of so many pixels; none of one that is a pixel wide or high. ASJ_ERROR_MEMORY. */
asj_status asj_small_picture_allocate(asj_context *context, int32_t width, int32_t height, asj_small_picture *picture);

/* Of an image that asj_image_check() has passed; none of one without colours. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_small_picture_create(asj_context *context, const asj_image *image, asj_small_picture *picture);

/* A channel (0 red, 1 green, 2 blue) as the levels of a pyramid whose level 0 is the picture's size divided by `reduction`: means
 * of so many pixels a side; what is left at the right and at the bottom falls away. */
void asj_small_picture_fill(asj_context *context, const asj_small_picture *picture, int32_t channel, int32_t reduction,
                            asj_pyramid *pyramid);

#endif
