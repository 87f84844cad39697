/* SPDX-License-Identifier: BSD-2-Clause */
/* Patches of an image's colours: what grey levels do not tell apart, for the geometry. */
#ifndef ASJ_SRC_MATCH_COLOUR_PATCH_H
#define ASJ_SRC_MATCH_COLOUR_PATCH_H

#include "affine.h"
#include "core/context.h"

#include <asj/image.h>
#include <asj/match.h>

#define ASJ_COLOUR_PATCH_SIDE 8
#define ASJ_COLOUR_PATCH_LENGTH (3 * ASJ_COLOUR_PATCH_SIDE * ASJ_COLOUR_PATCH_SIDE)

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

/* Of each frame: */
#define ASJ_HUE_ONE 256
typedef struct asj_colour_patches {
    int16_t *patch; /* ASJ_COLOUR_PATCH_LENGTH numbers, such that the product of two patches (asj_patch_product()) is the mean
                     * correlation of their channels, in 1/ASJ_UNIT_ONE^2 */
    uint16_t *hue;  /* how much its colours say beside grey levels, 0 .. ASJ_HUE_ONE */
} asj_colour_patches;

/* Of `count` frames, in px of an image that has `scale` px for one of the picture's. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED; free
 * them either way. */
asj_status asj_colour_patches_create(asj_context *context, const asj_match_options *options, const asj_small_picture *picture,
                                     double scale, const asj_affine_frame *frames, uint32_t count, asj_colour_patches *patches);
void asj_colour_patches_free(asj_memory *memory, asj_colour_patches *patches);

#endif
