/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, patches: grey levels around an L-junction, brought into a form that does not depend on the viewpoint.
 *
 * In its own frame (location p, branch vectors a and b) an L-junction looks the same from everywhere, as far as the surface is
 * flat: x(u, v) = p + u a + v b. Sampling that once for each L-junction makes all pairs comparable by a product, where the
 * paper warps a neighbourhood for each pair. The pyramid level follows from the area of a sample's cell, so that a patch that
 * shrinks the image is not aliased.
 *
 * Why integers: positions (2^-13 px: the 23 steps of a patch are off by less than 0.003 px at its far corner), interpolation
 * weights (8 bits), unit vectors (14 bits) and products are whole numbers, so every back end can give the same bits. */
#include "patch.h"

#include <math.h>
#include <string.h>

/* --- sampling --------------------------------------------------------------------------------------------------------------- */

/* Whether a corner of the patch is within the limits; false for NaN too. */
static int32_t near(double x, double y)
{
    return fabs(x) < ASJ_GRID_LIMIT && fabs(y) < ASJ_GRID_LIMIT;
}

static int32_t round_position(double x)
{
    return (int32_t)lrint(x * (1 << ASJ_GRID_BITS));
}

void asj_patch_grid_set(const asj_pyramid *pyramid, const asj_affine_frame *frame, int32_t size, double start, double end,
                        asj_patch_grid *grid)
{
    const double step = (end - start) / (size - 1), ax = step * frame->ax, ay = step * frame->ay, bx = step * frame->bx;
    const double by = step * frame->by, side = size; /* one step more than there is: room for rounding */
    const double x = frame->x + start * (frame->ax + frame->bx), y = frame->y + start * (frame->ay + frame->by);
    *grid = (asj_patch_grid){-1, 0, 0, 0, 0, 0, 0};
    if (!near(x, y) || !near(x + side * ax, y + side * ay) || !near(x + side * bx, y + side * by) ||
        !near(x + side * (ax + bx), y + side * (ay + by)))
        return;
    grid->level = asj_pyramid_level(pyramid, fabs(asj_affine_area(frame)) * step * step);
    grid->x = round_position(x);
    grid->y = round_position(y);
    grid->ax = round_position(ax);
    grid->ay = round_position(ay);
    grid->bx = round_position(bx);
    grid->by = round_position(by);
}

static int32_t limit(int32_t x, int32_t largest)
{
    return x < 0 ? 0 : x > largest ? largest : x;
}

/* Pixel i of level l is centred at (i + 1/2) 2^l - 1/2: a position becomes (x + 1/2) / 2^l - 1/2. */
int32_t asj_patch_levels(const asj_pyramid *pyramid, const asj_patch_grid *grid, int32_t size, uint16_t *grey)
{
    const int32_t l = grid->level, half = 1 << (ASJ_GRID_BITS - 1), fraction_bits = ASJ_GRID_BITS - 8;
    const int32_t last_x = (pyramid->width[0] - 1) << ASJ_GRID_BITS, last_y = (pyramid->height[0] - 1) << ASJ_GRID_BITS;
    const int32_t right = (pyramid->width[l] - 1) << 8, bottom = (pyramid->height[l] - 1) << 8;
    const ptrdiff_t stride = pyramid->width[l] + 1;
    int32_t inside = 0;
    for (int32_t j = 0; j < size; j++)
        for (int32_t i = 0; i < size; i++) {
            const int32_t x = grid->x + i * grid->ax + j * grid->bx, y = grid->y + i * grid->ay + j * grid->by;
            inside += (x >= 0) & (y >= 0) & (x <= last_x) & (y <= last_y);
            const int32_t ix = limit((((x + half) >> l) - half) >> fraction_bits, right);
            const int32_t iy = limit((((y + half) >> l) - half) >> fraction_bits, bottom);
            const int32_t wx = ix & 255, wy = iy & 255;
            const uint16_t *p = pyramid->plane[l] + (iy >> 8) * stride + (ix >> 8);
            const int32_t upper = (256 - wx) * p[0] + wx * p[1];
            const int32_t lower = (256 - wx) * p[stride] + wx * p[stride + 1];
            grey[j * size + i] = (uint16_t)(((256 - wy) * (upper >> 1) + wy * (lower >> 1) + (1 << 14)) >> 15);
        }
    return inside;
}

int32_t asj_patch_sample(const asj_pyramid *pyramid, const asj_affine_frame *frame, int32_t size, double start, double end,
                         uint16_t *grey)
{
    asj_patch_grid grid;
    asj_patch_grid_set(pyramid, frame, size, start, end, &grid);
    if (grid.level >= 0)
        return 4 * pyramid->ops->patch->levels(pyramid, &grid, size, grey) >= 3 * size * size;
    memset(grey, 0, (size_t)(size * size) * sizeof *grey);
    return 0;
}

/* --- comparison ------------------------------------------------------------------------------------------------------------- */

/* With N = size^2 samples g of sum s and sum of squares q: N (g - mean) = N g - s = d, N sd = sqrt(N q - s^2) = r, and the unit
 * vector is d / ((r + N floor) sqrt(N)). All of it in whole numbers, r rounded down, the division done once for the patch:
 * floor = ASJ_GRAY_ONE, |d| < 2^25, r < 2^24, the divisor is 2^16 .. 2^29. */
int32_t asj_patch_unit_scale(int32_t sum, int64_t squares, int32_t size)
{
    const int32_t samples = size * size;
    /* exact: the square root of a number below 2^50, correctly rounded, is never rounded up to the next whole one */
    const int64_t root = (int64_t)sqrt((double)(squares * samples - (int64_t)sum * sum));
    return (int32_t)(((int64_t)ASJ_UNIT_ONE << 32) / ((root + samples * ASJ_GRAY_ONE) * size));
}

void asj_patch_normalise(const uint16_t *grey, int32_t size, int16_t *unit)
{
    const int32_t samples = size * size;
    int32_t sum = 0;
    int64_t squares = 0;
    for (int32_t i = 0; i < samples; i++) {
        sum += grey[i];
        squares += (int32_t)grey[i] * grey[i];
    }
    const int64_t scale = asj_patch_unit_scale(sum, squares, size);
    for (int32_t i = 0; i < samples; i++)
        unit[i] = (int16_t)((scale * (samples * grey[i] - sum) + ((int64_t)1 << 31)) >> 32);
}

int32_t asj_patch_plain_scale(int32_t size)
{
    return (int32_t)(((int64_t)ASJ_UNIT_ONE << 32) / (ASJ_GRAY_MAX * size));
}

void asj_patch_scale(const uint16_t *grey, int32_t size, int16_t *unit)
{
    const int64_t scale = asj_patch_plain_scale(size);
    for (int32_t i = 0; i < size * size; i++)
        unit[i] = (int16_t)((scale * grey[i] + ((int64_t)1 << 31)) >> 32);
}

int32_t asj_patch_product(const int16_t *left, const int16_t *right, int32_t samples)
{
    int32_t sum = 0;
    for (int32_t i = 0; i < samples; i++)
        sum += (int32_t)left[i] * right[i];
    return sum;
}

void asj_patch_products(const int16_t *left, const int16_t *rights, int32_t length, const int32_t *which, int32_t count,
                        int32_t *products)
{
    for (int32_t k = 0; k < count; k++)
        products[k] = asj_patch_product(left, rights + (ptrdiff_t)which[k] * length, length);
}

const asj_patch_ops asj_patch_reference = {
    .levels = asj_patch_levels, .normalise = asj_patch_normalise, .products = asj_patch_products};
