/* SPDX-License-Identifier: BSD-2-Clause */
/* Patches sampled in affine frames. All integer once a frame is rounded, so that any device gives the same bits. */
#ifndef ASJ_SRC_PATCH_H
#define ASJ_SRC_PATCH_H

#include "affine.h"
#include "core/pyramid.h"

#define ASJ_PATCH_SIDE 24                                  /* largest */
#define ASJ_PATCH_SAMPLES (ASJ_PATCH_SIDE * ASJ_PATCH_SIDE)

/* Where the samples of a patch lie: sample (i, j) at (x + i ax + j bx, y + i ay + j by), in 2^-ASJ_GRID_BITS px of level 0. All
 * of them are within ASJ_GRID_LIMIT px of the origin, so that 32 bits hold every sum and product here. */
#define ASJ_GRID_BITS 13
#define ASJ_GRID_LIMIT 131072.0
typedef struct asj_patch_grid {
    int32_t level;           /* of the pyramid; -1 = the patch cannot be used: nothing is sampled */
    int32_t x, y;
    int32_t ax, ay, bx, by;
} asj_patch_grid;

/* The grid of size x size samples p + u a + v b, u (along the rows) and v equally spaced in [start, end]. One that leaves the
 * limits lies outside of any image by more than a quarter: level -1. */
void asj_patch_grid_set(const asj_pyramid *pyramid, const asj_affine_frame *frame, int32_t size, double start, double end,
                        asj_patch_grid *grid);

/* The patch's grey levels (1/128), bilinear in 1/256 px, outside the image its border continues; size is a multiple of 4.
 * Returns how many samples lie inside the image. */
int32_t asj_patch_levels(const asj_pyramid *pyramid, const asj_patch_grid *grid, int32_t size, uint16_t *grey);

/* Both, with the context's form of asj_patch_levels(). Returns 0, and zeros for a grid beyond the limits, when more than a
 * quarter of the samples lie outside the image. */
int32_t asj_patch_sample(const asj_pyramid *pyramid, const asj_affine_frame *frame, int32_t size, double start, double end,
                         uint16_t *grey);

/* Zero mean and unit norm, in units of 1/ASJ_UNIT_ONE: the product of two such patches over ASJ_UNIT_ONE^2 is their
 * correlation. A floor of one grey level is added to the standard deviation, so that flat patches correlate with nothing. */
#define ASJ_UNIT_ONE 16384
void asj_patch_normalise(const uint16_t *grey, int32_t size, int16_t *unit);

/* What it multiplies N g - sum with, N = size^2, in 2^-32; from the sums of the levels g and of their squares. */
int32_t asj_patch_unit_scale(int32_t sum, int64_t squares, int32_t size);

/* With the mean in: white everywhere has unit norm. What levels are multiplied with is in 2^-32. */
void asj_patch_scale(const uint16_t *grey, int32_t size, int16_t *unit);
int32_t asj_patch_plain_scale(int32_t size);

/* Exact in 32 bits for unit vectors. */
int32_t asj_patch_product(const int16_t *left, const int16_t *right, int32_t samples);

/* Products of one vector with those of `rights` that `which` numbers; length is a multiple of 16. */
void asj_patch_products(const int16_t *left, const int16_t *rights, int32_t length, const int32_t *which, int32_t count,
                        int32_t *products);

/* Operations (core/ops.h). */
typedef struct asj_patch_ops {
    /* asj_patch_levels() */
    int32_t (*levels)(const asj_pyramid *pyramid, const asj_patch_grid *grid, int32_t size, uint16_t *grey);
    /* asj_patch_normalise() */
    void (*normalise)(const uint16_t *grey, int32_t size, int16_t *unit);
    /* asj_patch_products() */
    void (*products)(const int16_t *left, const int16_t *rights, int32_t length, const int32_t *which, int32_t count,
                     int32_t *products);
} asj_patch_ops;
extern const asj_patch_ops asj_patch_reference;

#endif
