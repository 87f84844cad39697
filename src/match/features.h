/* SPDX-License-Identifier: BSD-2-Clause */
/* All that the matcher needs of one image. Nothing in it depends on the other image: once created it is complete and only read,
 * so that one image can be matched with many. */
#ifndef ASJ_SRC_MATCH_FEATURES_H
#define ASJ_SRC_MATCH_FEATURES_H

#include "colour.h"
#include "colour_patch.h"
#include "core/pyramid.h"
#include "l_junctions.h"

typedef struct asj_image_features {
    asj_pyramid pyramid;
    asj_l_junctions l_junctions;
    int16_t *patches;        /* canonical: `length` numbers for each frame, unit vectors unless option normalise is no;
                              * induced: for each L-junction */
    const uint32_t *patch_of; /* of each frame: which of them is its patch; NULL = those of the frames, in order */
    uint8_t *usable;         /* of each of them: its patch lies in the image */
    asj_colour *colours;     /* of each L-junction; NULL: the image has none, or nobody will ask */
    asj_small_picture picture; /* what colour_patch.c samples; empty likewise */
    uint64_t device_copy;    /* names what the device of the context that described them keeps of them; 0 = nothing. It lasts for
                              * the call: features that are kept have none (kept_features.c), as they may be matched anywhere */
} asj_image_features;

/* The canonical patch of a frame, `length` numbers long. */
static inline uint32_t asj_patch_number(const asj_image_features *features, uint32_t frame)
{
    return features->patch_of ? features->patch_of[frame] : frame;
}

static inline const int16_t *asj_patch_at(const asj_image_features *features, uint32_t frame, int32_t length)
{
    return features->patches + (size_t)asj_patch_number(features, frame) * (size_t)length;
}

#endif
