/* SPDX-License-Identifier: BSD-2-Clause */
/* The vector form of the hot operations, written once for any instruction set. A file for one includes its vectors first, which
 * define vec, V_LANES (16-bit lanes) and the v_ functions (see x86/avx2_vectors.h), then this. Names as in the reference: sector.c,
 * field.c. */
#ifndef ASJ_SRC_SIMD_KERNELS_H
#define ASJ_SRC_SIMD_KERNELS_H

#ifndef V_LANES
#error "include the vectors of an instruction set first"
#endif

#include "core/ops.h"
#include "field_kernels.h"
#include "gradient_kernels.h"
#include "isotropic_kernels.h"
#include "product_bound_kernels.h"
#include "product_kernels.h"

static void fill_kernels(const asj_ops *ops)
{
    ops->gradient->slide = gradient_slide;
    ops->gradient->normalise = gradient_normalise;
    ops->field->tile = field_tile;
    ops->field->pixels = field_pixels;
    ops->isotropic->band = isotropic_band;
    ops->bound->above = bound_above;
    ops->patch->products = patch_products;
}

#endif
