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
    uint8_t *usable;         /* of each of them: its patch lies in the image */
    asj_colour *colours;     /* of each L-junction; NULL: the image has none, or nobody will ask */
    asj_small_picture picture; /* what colour_patch.c samples; empty likewise */
    uint64_t device_copy;    /* names what the device of the context that described them keeps of them; 0 = nothing. It lasts for
                              * the call: features that are kept have none (kept_features.c), as they may be matched anywhere */
} asj_image_features;

#endif
