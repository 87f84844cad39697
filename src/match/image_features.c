/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, one image: its L-junctions with their frames (l_junctions_create.c), its pyramid (core/pyramid.c), and what the
 * neighbourhoods of the L-junctions look like (describe.c; patch_induced.c for the paper's). */
#include "image_features.h"
#include "core/image.h"
#include "describe.h"
#include "l_junctions_create.h"
#include "patch_induced.h"

#include <string.h>

asj_status asj_image_features_describe(asj_context *context, const asj_match_options *options, asj_image_features *features)
{
    return options->patches == ASJ_PATCHES_CANONICAL ? asj_describe(context, options, features)
                                                     : asj_patch_induced_describe(context, options, features);
}

static asj_status create(asj_context *context, const asj_match_options *options, const asj_image *image,
                         const asj_image_junctions *junctions, asj_image_features *features)
{
    asj_status status = asj_l_junctions_create(context, options, junctions, &features->l_junctions);
    if (status == ASJ_OK)
        status = (junctions->upsampled ? asj_pyramid_create_upsampled : asj_pyramid_create)(context, image, options->smoothing,
                                                                                            &features->pyramid);
    if (status == ASJ_OK)
        status = asj_image_features_describe(context, options, features);
    return status;
}

asj_status asj_image_features_create(asj_context *context, const asj_match_options *options, const asj_image *image,
                                     const asj_junction *junctions, size_t count, int32_t which, int32_t upsampled,
                                     asj_image_features *features)
{
    memset(features, 0, sizeof *features);
    asj_status status = asj_image_check(context, image);
    if (status == ASJ_OK && upsampled)
        status = asj_upsample_check(context, image);
    if (status != ASJ_OK)
        return status;
    const asj_image_junctions list = {junctions, count, image->width, image->height, which, upsampled};
    status = create(context, options, image, &list, features);
    if (status != ASJ_OK)
        asj_image_features_free(&context->memory, features);
    return status;
}

asj_status asj_image_features_add_colours(asj_context *context, const asj_image *image, asj_image_features *features)
{
    const asj_status status = asj_colours_create(context, image, &features->l_junctions, &features->colours);
    return status == ASJ_OK ? asj_small_picture_create(context, image, &features->picture) : status;
}

void asj_image_features_free(asj_memory *memory, asj_image_features *features)
{
    asj_l_junctions_free(memory, &features->l_junctions);
    asj_pyramid_free(memory, &features->pyramid);
    asj_release_much(memory, features->colours);
    asj_release_much(memory, features->picture.level);
    asj_release_much(memory, features->patches);
    asj_release_much(memory, features->usable);
    memset(features, 0, sizeof *features);
}
