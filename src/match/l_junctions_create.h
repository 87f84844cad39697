/* SPDX-License-Identifier: BSD-2-Clause */
/* From the junctions of an image to its L-junctions. */
#ifndef ASJ_SRC_L_JUNCTIONS_CREATE_H
#define ASJ_SRC_L_JUNCTIONS_CREATE_H

#include "l_junctions.h"

/* The junctions of one image, as the caller gives them: in its pixels. */
typedef struct asj_image_junctions {
    const asj_junction *list;
    size_t count;
    int32_t width, height;       /* px: of the image */
    int32_t which;               /* 1 or 2, for messages */
    int32_t upsampled;            /* 1: L-junctions in pixels of the image upsampled by two; 0: in its own, and none of octave
                                  * -1 */
} asj_image_junctions;

/* Makes everything from junctions. ASJ_ERROR_ARGUMENT (see asj_match()), ASJ_ERROR_LIMIT, ASJ_ERROR_MEMORY,
 * ASJ_ERROR_CANCELLED. On failure the caller still frees. */
asj_status asj_l_junctions_create(asj_context *context, const asj_match_options *options, const asj_image_junctions *input,
                                  asj_l_junctions *l_junctions);

#endif
