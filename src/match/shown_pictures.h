/* SPDX-License-Identifier: BSD-2-Clause */
/* What a pair's geometry sees of the images. */
#ifndef ASJ_SRC_MATCH_SHOWN_PICTURES_H
#define ASJ_SRC_MATCH_SHOWN_PICTURES_H

#include "geometry/picture.h"
#include "match_run.h"

/* Of either image, empty where there is nothing. */
typedef struct asj_shown_pictures {
    asj_pyramid colours[2][ASJ_MOST_CHANNELS];
} asj_shown_pictures;

/* Fills in what has been zero, and pictures that last as long as that and the features. ASJ_ERROR_MEMORY; the caller frees. */
asj_status asj_show_pictures(const asj_match_run *run, asj_shown_pictures *shown, asj_picture pictures[2]);
void asj_shown_pictures_free(asj_memory *memory, asj_shown_pictures *shown);

#endif
