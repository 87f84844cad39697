/* SPDX-License-Identifier: BSD-2-Clause */
/* What the neighbourhoods of L-junctions look like: canonical patches. */
#ifndef ASJ_SRC_DESCRIBE_H
#define ASJ_SRC_DESCRIBE_H

#include "features.h"
#include "patch.h"

/* Numbers in a described patch; whether they are unit vectors. */
int32_t asj_patch_length(const asj_match_options *options);
int32_t asj_patch_units(const asj_match_options *options);

/* Fills features->patches and usable, one for each frame. */
asj_status asj_describe(asj_context *context, const asj_match_options *options, asj_image_features *features);
/* The part of it that back ends replace: patches and usable are allocated. */
asj_status asj_describe_frames(asj_context *context, const asj_match_options *options, asj_image_features *features);

/* Operations (core/ops.h); a device replaces it. */
typedef struct asj_describe_ops {
    /* asj_describe_frames() */
    asj_status (*frames)(asj_context *context, const asj_match_options *options, asj_image_features *features);
} asj_describe_ops;
extern const asj_describe_ops asj_describe_reference;

#endif
