/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_disc_compare() of disc.c in vectors of 128 bits: the same sums in the same order, those that do not wait for each other in
 * one pass. */
#ifndef ASJ_SRC_SIMD_DISC_KERNELS_H
#define ASJ_SRC_SIMD_DISC_KERNELS_H

#include "match/disc.h"
#include "sample_kernels.h"

#include <math.h>

/* The lanes of the reference. */
typedef struct disc_lanes {
    floats low, high;
} disc_lanes;

static inline floats floats_at(const float *p)
{
    floats v;
    memcpy(&v, p, sizeof v);
    return v;
}

static inline disc_lanes lanes_at(const float *p)
{
    return (disc_lanes){floats_at(p), floats_at(p + 4)};
}

static inline float fold_lanes(disc_lanes sum)
{
    const floats four = sum.low + sum.high;
    return (four[0] + four[2]) + (four[1] + four[3]);
}

/* Grey levels of four samples, 0 in the filling. */
static inline floats disc_four(const asj_disc *disc, const level_sampler *sampler, const asj_disc_map *map, int32_t i,
                                 ints *inside)
{
    const floats x = floats_at(disc->x + i), y = floats_at(disc->y + i), mask = floats_at(disc->mask + i), zero = floats_of(0);
    const float *l = map->linear;
    const floats at_x = map->x + l[0] * x + l[1] * y, at_y = map->y + l[2] * x + l[3] * y;
    *inside -= (at_x >= zero) & (at_y >= zero) & (at_x <= sampler->last_x) & (at_y <= sampler->last_y) & (mask > zero);
    return as_floats(sample_positions(sampler, at_x, at_y)) * mask;
}

/* Returns their sum. */
static inline float sample_disc(const asj_disc *disc, const asj_pyramid *pyramid, const asj_disc_map *map, float *value,
                                int32_t *count)
{
    const level_sampler sampler = sampler_of(pyramid, map->level);
    disc_lanes sum = {floats_of(0), floats_of(0)};
    ints inside = {0, 0, 0, 0};
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        const disc_lanes v = {disc_four(disc, &sampler, map, i, &inside), disc_four(disc, &sampler, map, i + 4, &inside)};
        sum.low += v.low;
        sum.high += v.high;
        memcpy(value + i, &v, sizeof v);
    }
    *count = (inside[0] + inside[1]) + (inside[2] + inside[3]);
    return fold_lanes(sum);
}

/* Zero mean; what has to be multiplied for unit norm, with the floor, is returned. */
static inline float centre_disc(const asj_disc *disc, float total, float *value)
{
    const floats mean = floats_of(total / (float)disc->count);
    disc_lanes squares = {floats_of(0), floats_of(0)};
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        disc_lanes v = lanes_at(value + i);
        v.low = (v.low - mean) * floats_at(disc->mask + i);
        v.high = (v.high - mean) * floats_at(disc->mask + i + 4);
        squares.low += v.low * v.low;
        squares.high += v.high * v.high;
        memcpy(value + i, &v, sizeof v);
    }
    return 1 / (sqrtf(fold_lanes(squares)) + ASJ_GRAY_ONE * sqrtf((float)disc->count));
}

static void disc_compare(const asj_disc *disc, const asj_template *t, const asj_pyramid *pyramid, const asj_disc_map *map,
                         asj_disc_sums *sums)
{
    float value[ASJ_DISC_SAMPLES];
    const float total = sample_disc(disc, pyramid, map, value, &sums->inside), scale = centre_disc(disc, total, value);
    disc_lanes similarity = {floats_of(0), floats_of(0)}, descent[6];
    for (int32_t k = 0; k < 6; k++)
        descent[k] = similarity;
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE) {
        const disc_lanes expected = lanes_at(t->value + i);
        disc_lanes v = lanes_at(value + i);
        v.low *= scale;
        v.high *= scale;
        similarity.low += v.low * expected.low;
        similarity.high += v.high * expected.high;
        v.low -= expected.low;
        v.high -= expected.high;
        for (int32_t k = 0; k < 6; k++) {
            const disc_lanes change = lanes_at(t->descent[k] + i);
            descent[k].low += change.low * v.low;
            descent[k].high += change.high * v.high;
        }
    }
    sums->similarity = fold_lanes(similarity);
    for (int32_t k = 0; k < 6; k++)
        sums->descent[k] = fold_lanes(descent[k]);
}

static void fill_discs(const asj_ops *ops)
{
    ops->disc->compare = disc_compare;
}

#endif
