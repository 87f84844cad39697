/* SPDX-License-Identifier: BSD-2-Clause */
/* What an image looks like. */
#ifndef ASJ_SRC_GEOMETRY_PICTURE_H
#define ASJ_SRC_GEOMETRY_PICTURE_H

#include "core/pyramid.h"

#define ASJ_MOST_CHANNELS 3

typedef struct asj_picture {
    const asj_pyramid *channels[ASJ_MOST_CHANNELS];
    int32_t channel_count; /* 3: red, green and blue; 1: grey levels; 0: not known */
    double scale;          /* px of the image for one of theirs */
    int32_t width, height; /* px of the image */
} asj_picture;

#endif
