/* SPDX-License-Identifier: BSD-2-Clause */
/* All that the matcher needs of one image. Nothing in it depends on the other image: once created it is complete and only read,
 * so that one image can be matched with many. */
#ifndef ASJ_SRC_IMAGE_FEATURES_H
#define ASJ_SRC_IMAGE_FEATURES_H

#include "core/pyramid.h"
#include "l_junctions.h"

typedef struct asj_image_features {
    asj_pyramid pyramid;
    asj_l_junctions l_junctions;
    int16_t *patches;        /* canonical: `length` numbers for each frame, unit vectors unless option normalise is no;
                              * induced: for each L-junction */
    uint8_t *usable;         /* of each of them: its patch lies in the image */
    uint64_t device_copy;    /* names what the device of the context that described them keeps of them; 0 = nothing. Means
                              * nothing to another context. */
} asj_image_features;

/* Makes everything: the L-junctions with their frames, the pyramid, the patches. `which` (1 or 2) is for messages.
 * ASJ_ERROR_IMAGE, ASJ_ERROR_ARGUMENT (see asj_match()), ASJ_ERROR_LIMIT, ASJ_ERROR_MEMORY, ASJ_ERROR_DEVICE. On failure nothing
 * is held. */
asj_status asj_image_features_create(asj_context *context, const asj_match_options *options, const asj_image *image,
                                     const asj_junction *junctions, size_t count, int32_t which, asj_image_features *features);
void asj_image_features_free(asj_memory *memory, asj_image_features *features);

#endif
