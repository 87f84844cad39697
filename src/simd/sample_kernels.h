/* SPDX-License-Identifier: BSD-2-Clause */
/* Bilinear samples of a pyramid in vectors of 128 bits: asj_pyramid_sample_reference() of pyramid.c, four at once. Two neighbouring
 * levels of grey are read at once, weighted and added by one multiplication; they stay below 2^15. */
#ifndef ASJ_SRC_SIMD_SAMPLE_KERNELS_H
#define ASJ_SRC_SIMD_SAMPLE_KERNELS_H

#include "core/pyramid.h"
#include "line_kernels.h"

/* What a level needs: 1/256 px of it = position * scale + shift, within its limits. */
typedef struct level_sampler {
    const uint16_t *plane;
    ptrdiff_t stride;
    ints strides;
    float scale, shift;
    floats right, bottom, last_x, last_y;
} level_sampler;

static inline level_sampler sampler_of(const asj_pyramid *pyramid, int32_t level)
{
    const float scale = 256.0f / (float)(1 << level);
    const int32_t stride = pyramid->width[level] + 1;
    return (level_sampler){pyramid->plane[level], stride, (ints){stride, stride, stride, stride}, scale, 0.5f * scale - 128.0f,
                           floats_of((float)(pyramid->width[level] - 1) * 256.0f),
                           floats_of((float)(pyramid->height[level] - 1) * 256.0f),
                           floats_of((float)(pyramid->width[0] - 1)), floats_of((float)(pyramid->height[0] - 1))};
}

/* Where positions lie in their level, in whole 1/256 px. */
static inline ints place_of(const level_sampler *s, floats at, floats end)
{
    const floats place = smaller_of(larger_of(at * s->scale + s->shift, floats_of(0)), end);
    return __builtin_convertvector(place, ints);
}

static inline ints times(ints a, ints b)
{
    return (ints)((unsigned_ints)a * (unsigned_ints)b);
}

/* At whole numbers of 1/256 px within the limits. */
static inline ints sample_places(const level_sampler *s, ints ix, ints iy)
{
    const ints wx = ix & 255, wy = iy & 255;
    const ints at = times(iy >> 8, s->strides) + (ix >> 8);
    const shorts weights = pairs_of(256 - wx, wx);
    const uint16_t *p[4];
    for (int lane = 0; lane < 4; lane++)
        p[lane] = s->plane + at[lane];
    const ints upper = weighted(pairs_at(p, 0), weights), lower = weighted(pairs_at(p, s->stride), weights);
    return (times(upper >> 1, 256 - wy) + times(lower >> 1, wy) + (1 << 14)) >> 15;
}

static inline ints sample_positions(const level_sampler *s, floats x, floats y)
{
    return sample_places(s, place_of(s, x, s->right), place_of(s, y, s->bottom));
}

static int32_t pyramid_sample(const asj_pyramid *pyramid, int32_t level, const float *x, const float *y, int32_t count,
                              uint16_t *grey)
{
    const level_sampler sampler = sampler_of(pyramid, level);
    const floats zero = floats_of(0);
    const int32_t whole = count & ~3;
    ints inside = {0, 0, 0, 0};
    for (int32_t i = 0; i < whole; i += 4) {
        floats at_x, at_y;
        memcpy(&at_x, x + i, sizeof at_x);
        memcpy(&at_y, y + i, sizeof at_y);
        inside -= (at_x >= zero) & (at_y >= zero) & (at_x <= sampler.last_x) & (at_y <= sampler.last_y);
        const ints levels = sample_positions(&sampler, at_x, at_y);
        const vec lower = v_pack_low((vec)levels, (vec)levels);
        memcpy(grey + i, &lower, 4 * sizeof *grey);
    }
    return (inside[0] + inside[1]) + (inside[2] + inside[3]) +
           asj_pyramid_sample_reference(pyramid, level, x + whole, y + whole, count - whole, grey + whole);
}

static void fill_samples(const asj_ops *ops)
{
    ops->pyramid->sample = pyramid_sample;
}

#endif
