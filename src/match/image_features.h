/* SPDX-License-Identifier: BSD-2-Clause */
/* How the features of an image are made. */
#ifndef ASJ_SRC_IMAGE_FEATURES_H
#define ASJ_SRC_IMAGE_FEATURES_H

#include "features.h"

/* Makes everything: the L-junctions with their frames, the pyramid, the patches. `which` (1 or 2) is for messages.
 * `upsampled`: of the image upsampled by two; otherwise those of octave -1 are left out (upsampled.c).
 * ASJ_ERROR_IMAGE, ASJ_ERROR_ARGUMENT (see asj_match()), ASJ_ERROR_LIMIT, ASJ_ERROR_MEMORY, ASJ_ERROR_DEVICE. On failure nothing
 * is held. */
asj_status asj_image_features_create(asj_context *context, const asj_match_options *options, const asj_image *image,
                                     const asj_junction *junctions, size_t count, int32_t which, int32_t upsampled,
                                     asj_image_features *features);
/* The last part of it: the patches, when L-junctions and pyramid are there. */
asj_status asj_image_features_describe(asj_context *context, const asj_match_options *options, asj_image_features *features);
/* Colours too, which only a geometry asks for; nothing of a grey image. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED; the caller frees. */
asj_status asj_image_features_add_colours(asj_context *context, const asj_image *image, asj_image_features *features);
void asj_image_features_free(asj_memory *memory, asj_image_features *features);

#endif
