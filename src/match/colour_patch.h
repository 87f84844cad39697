/* SPDX-License-Identifier: BSD-2-Clause */
/* Patches of an image's colours: what grey levels do not tell apart, for the geometry. */
#ifndef ASJ_SRC_MATCH_COLOUR_PATCH_H
#define ASJ_SRC_MATCH_COLOUR_PATCH_H

#include "affine.h"
#include "core/context.h"
#include "small_picture.h"

#include <asj/match.h>

#define ASJ_COLOUR_PATCH_SIDE 8
#define ASJ_COLOUR_PATCH_LENGTH (3 * ASJ_COLOUR_PATCH_SIDE * ASJ_COLOUR_PATCH_SIDE)

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
