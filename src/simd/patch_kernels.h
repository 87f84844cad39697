/* SPDX-License-Identifier: BSD-2-Clause */
/* The matcher's blur and grey levels of patches in vectors of 128 bits: names as in the files that define them, pyramid.c and
 * patch.c. */
#ifndef ASJ_SRC_SIMD_PATCH_KERNELS_H
#define ASJ_SRC_SIMD_PATCH_KERNELS_H

#include "match/patch.h"
#include "sample_kernels.h"

/* Pairs of levels that share a tap are interleaved: one multiplication weights and adds both. Levels stay below 2^15. */
static void blur_row(const uint16_t *const *rows, const int32_t *taps, int32_t radius, int32_t width, uint16_t *to)
{
    const uint16_t *rest[ASJ_BLUR_ROWS];
    const int32_t whole = width & ~7;
    for (int32_t x = 0; x < whole; x += 8) {
        const vec middle = v_load(rows[0] + x), half = v_set1_32(1 << 13), tap0 = v_set1((int16_t)taps[0]);
        vec low = v_add32(half, v_pairs(v_interleave_low(middle, v_zero()), tap0));
        vec high = v_add32(half, v_pairs(v_interleave_high(middle, v_zero()), tap0));
        for (int32_t i = 1; i <= radius; i++) {
            const vec before = v_load(rows[2 * i - 1] + x), after = v_load(rows[2 * i] + x), tap = v_set1((int16_t)taps[i]);
            low = v_add32(low, v_pairs(v_interleave_low(before, after), tap));
            high = v_add32(high, v_pairs(v_interleave_high(before, after), tap));
        }
        v_store(to + x, v_pack_low((vec)((ints)low >> 14), (vec)((ints)high >> 14)));
    }
    for (int32_t i = 0; i <= 2 * radius; i++)
        rest[i] = rows[i] + whole;
    asj_blur_row(rest, taps, radius, width - whole, to + whole);
}

/* From 2^-ASJ_GRID_BITS px of level 0 to 1/256 px of the level, within the limits. */
static inline ints to_level(ints x, int32_t level, int32_t last)
{
    const int32_t half = 1 << (ASJ_GRID_BITS - 1);
    const ints there = (((x + half) >> level) - half) >> (ASJ_GRID_BITS - 8), end = {last, last, last, last};
    const ints within = there & (there > 0), beyond = within > end;
    return (beyond & end) | (~beyond & within);
}

/* Four columns of a row at once. */
static int32_t patch_levels(const asj_pyramid *pyramid, const asj_patch_grid *grid, int32_t size, uint16_t *grey)
{
    const int32_t l = grid->level, right = (pyramid->width[l] - 1) << 8, bottom = (pyramid->height[l] - 1) << 8;
    const int32_t last_x = (pyramid->width[0] - 1) << ASJ_GRID_BITS, last_y = (pyramid->height[0] - 1) << ASJ_GRID_BITS;
    const level_sampler sampler = sampler_of(pyramid, l);
    const ints column = {0, 1, 2, 3}, offset_x = column * grid->ax, offset_y = column * grid->ay;
    ints inside = {0, 0, 0, 0};
    for (int32_t j = 0; j < size; j++)
        for (int32_t i = 0; i < size; i += 4) {
            const ints x = offset_x + (grid->x + i * grid->ax + j * grid->bx);
            const ints y = offset_y + (grid->y + i * grid->ay + j * grid->by);
            inside -= (x >= 0) & (y >= 0) & (x <= last_x) & (y <= last_y);
            const ints levels = sample_places(&sampler, to_level(x, l, right), to_level(y, l, bottom));
            const vec lower = v_pack_low((vec)levels, (vec)levels);
            memcpy(grey + (ptrdiff_t)j * size + i, &lower, 4 * sizeof *grey);
        }
    return (inside[0] + inside[1]) + (inside[2] + inside[3]);
}

static void fill_patches(const asj_ops *ops)
{
    ops->pyramid->blur_row = blur_row;
    ops->patch->levels = patch_levels;
}

#endif
