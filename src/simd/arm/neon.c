/* SPDX-License-Identifier: BSD-2-Clause */
/* Part of every 64-bit ARM processor. */
#include "neon_vectors.h" /* before kernels.h */
#include "simd/kernels.h"
#include "simd/disc_kernels.h"
#include "simd/gate_kernels.h"
#include "simd/line_kernels.h"
#include "simd/normal_kernels.h"
#include "simd/patch_kernels.h"
#include "simd/sample_kernels.h"
#include "core/image.h"
#include "shared/pixels.h"
#include "simd/variants.h"

/* Colour to luma: 8 pixels at once. Sums stay below 2^16. Name as in the reference, image.c. */
static inline uint16x8_t luma(uint8x8_t red, uint8x8_t green, uint8x8_t blue)
{
    const uint16x8_t red_green = vmlal_u8(vmull_u8(red, vdup_n_u8(ASJ_LUMA_RED)), green, vdup_n_u8(ASJ_LUMA_GREEN));
    return vshll_n_u8(vrshrn_n_u16(vmlal_u8(red_green, blue, vdup_n_u8(ASJ_LUMA_BLUE)), ASJ_LUMA_BITS), 7);
}

static void image_luma_neon(const uint8_t *pixels, int32_t width, int32_t step, int32_t red, uint16_t *gray)
{
    const int32_t whole = width & ~7;
    for (int32_t x = 0; x < whole; x += 8) {
        const uint8_t *p = pixels + (ptrdiff_t)x * step;
        uint8x8x3_t c;
        if (step == 3) {
            c = vld3_u8(p);
        } else {
            const uint8x8x4_t all = vld4_u8(p);
            c = (uint8x8x3_t){{all.val[0], all.val[1], all.val[2]}};
        }
        vst1q_u16(gray + x, red == 0 ? luma(c.val[0], c.val[1], c.val[2]) : luma(c.val[2], c.val[1], c.val[0]));
    }
    asj_image_luma(pixels + (ptrdiff_t)whole * step, width - whole, step, red, gray + whole);
}

void asj_fill_neon(const asj_ops *ops)
{
    fill_kernels(ops);
    fill_lines(ops);
    fill_samples(ops);
    fill_discs(ops);
    fill_gate(ops);
    fill_patches(ops);
    fill_normal(ops);
    ops->image->luma = image_luma_neon;
}
