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
    asj_l_junction *l_junctions;  /* where those of of_image are of the enlarged image: in pixels of the image itself */
    asj_image_features of_image;  /* its pointers lead into the block that this struct begins */
};

/* A copy of what a context made, in a block of its own. ASJ_ERROR_MEMORY. */
asj_status asj_features_keep(asj_context *context, const asj_match_options *options, const asj_junction *junctions, size_t count,
                             const asj_image_features *made, asj_features **features);

/* The same features as a context works with them: its own operations, nothing on its device yet. Arrays are shared, so there is
 * nothing to free. */
asj_image_features asj_features_view(const asj_context *context, const asj_features *features);

#endif
