/* SPDX-License-Identifier: BSD-2-Clause */
/* Features as the caller holds them (asj/features.h): complete, in one block of memory, independent of any context. */
#ifndef ASJ_SRC_KEPT_FEATURES_H
#define ASJ_SRC_KEPT_FEATURES_H

#include "image_features.h"

#include <asj/features.h>

struct asj_features {
    asj_memory memory;            /* what the block is counted in: the allocator outlives the context */
    asj_match_options options;
    asj_junction *junctions;      /* as they were given */
    uint32_t junction_count;
    int32_t has_upsampled;                /* are there junctions of octave -1? The three below are empty if not */
    asj_l_junction *l_junctions;  /* all, in pixels of the image */
    uint16_t *gray;               /* the image, 1/128 of a grey level: what both pyramids are made from */
    asj_image_features upsampled;  /* of the image upsampled by two, with these junctions */
    asj_image_features of_image;  /* without them. All pointers lead into the block that this struct begins */
};

/* What a context made of an image. */
typedef struct asj_made_features {
    asj_image_features own, upsampled; /* as below; all zero where there is nothing upsampled */
    uint16_t *gray;                   /* NULL likewise */
} asj_made_features;

void asj_made_features_free(asj_memory *memory, asj_made_features *made);

/* A copy of it in a block of its own. ASJ_ERROR_MEMORY. */
asj_status asj_features_keep(asj_context *context, const asj_match_options *options, const asj_junction *junctions, size_t count,
                             const asj_made_features *made, asj_features **features);

/* The same features as a context works with them, those of the upsampled image if asked for and there: its own
 * operations, nothing on its device yet. Arrays are shared, so there is nothing to free. */
asj_image_features asj_features_view(const asj_context *context, const asj_features *features, int32_t upsampled);

#endif
