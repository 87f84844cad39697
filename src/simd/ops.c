/* SPDX-License-Identifier: BSD-2-Clause */
#include "ops.h"
#include "detect/field.h"
#include "detect/gradient.h"
#include "match/sketch.h"
#include "variants.h"

/* The build says which variants it holds: ASJ_HAVE_SSE2, ASJ_HAVE_AVX2, ASJ_HAVE_AVX512, ASJ_HAVE_NEON. */

static void fill_reference(asj_ops *ops)
{
    ops->gradient = asj_gradient;
    ops->field_rows = asj_field_rows;
    ops->isotropic_rows = asj_isotropic_rows;
    ops->scan_rays = asj_scan_rays;
    ops->describe_frames = asj_describe_frames;
    ops->rank_partners = asj_rank_partners;
    ops->image_luma = asj_image_luma;
    ops->gradient_slide = asj_gradient_slide;
    ops->gradient_normalise = asj_gradient_normalise;
    ops->field_tile = asj_field_tile;
    ops->field_pixels = asj_field_pixels;
    ops->isotropic_band = asj_isotropic_band;
    ops->line_sums = asj_line_sums_of;
    ops->line_profile = asj_line_profile_of;
    ops->strip_sums = asj_strip_sums_of;
    ops->blur_row = asj_blur_row;
    ops->patch_levels = asj_patch_levels;
    ops->patch_normalise = asj_patch_normalise;
    ops->patch_products = asj_patch_products;
    ops->sketch_above = asj_sketch_above;
    ops->pyramid_sample = asj_pyramid_sample_reference;
    ops->disc_compare = asj_disc_compare;
    ops->look_at = asj_look_at;
}

const char *asj_ops_name(int32_t variant)
{
    static const char *const names[] = {"reference", "sse2", "avx2", "avx512", "neon"};
    return variant >= 0 && variant < ASJ_VARIANT_COUNT ? names[variant] : "unknown";
}

/* Overwrites what the variant has; 0 when it cannot run here. */
static int override(int32_t variant, asj_ops *ops)
{
    (void)ops;
    switch (variant) {
    case ASJ_VARIANT_REFERENCE:
        return 1;
#ifdef ASJ_HAVE_SSE2
    case ASJ_VARIANT_SSE2:
        asj_ops_sse2(ops);
        return 1;
#endif
#ifdef ASJ_HAVE_AVX2
    case ASJ_VARIANT_AVX2:
        if (!__builtin_cpu_supports("avx2"))
            return 0;
        asj_ops_avx2(ops);
        return 1;
#endif
#ifdef ASJ_HAVE_AVX512
    case ASJ_VARIANT_AVX512:
        if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("avx512f") ||
            !__builtin_cpu_supports("avx512bw") || !__builtin_cpu_supports("avx512vl"))
            return 0;
        override(ASJ_VARIANT_AVX2, ops); /* what 16 lanes do better */
        asj_ops_avx512(ops);
        return 1;
#endif
#ifdef ASJ_HAVE_NEON
    case ASJ_VARIANT_NEON:
        asj_ops_neon(ops);
        return 1;
#endif
    default:
        return 0;
    }
}

int asj_ops_fill(int32_t variant, asj_ops *ops)
{
    asj_ops filled = {0};
    fill_reference(&filled);
    if (!override(variant, &filled))
        return 0;
    filled.name = asj_ops_name(variant);
    *ops = filled;
    return 1;
}

void asj_ops_best(asj_ops *ops)
{
    for (int32_t variant = 0; variant < ASJ_VARIANT_COUNT; variant++)
        asj_ops_fill(variant, ops);
}
