/* SPDX-License-Identifier: BSD-2-Clause */
/* The colours around L-junctions, and what they say of candidates. */
#ifndef ASJ_SRC_MATCH_COLOUR_H
#define ASJ_SRC_MATCH_COLOUR_H

#include "l_junctions.h"

#include <asj/image.h>

/* Beside branch a on the side of b, beside a on the other side, the same of b, between the branches, opposite. */
#define ASJ_COLOUR_REGIONS 6

/* Mean levels, 1/128 of a grey level, of red, green and blue in each region; all zero where the image does not show it. */
typedef struct asj_colour {
    uint16_t level[ASJ_COLOUR_REGIONS][3];
} asj_colour;

/* One for each L-junction; *colours stays NULL when the image has no colour: a format without, or grey wherever it is looked at.
 * ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_colours_create(asj_context *context, const asj_image *image, const asj_l_junctions *l_junctions,
                              asj_colour **colours);

#endif
