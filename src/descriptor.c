/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, a SIFT-like descriptor: 4 x 4 cells of 8 orientations (Lowe 2004), each entry the square root of its share (RootSIFT,
 * Arandjelovic and Zisserman 2012), so that the product of two is their Hellinger affinity, at most 1.
 *
 * No angle is computed: a gradient g between two neighbouring of the eight directions d_k, d_k+1 (45 degrees apart) is written as
 * g = alpha d_k + beta d_k+1 with alpha, beta >= 0, which are its votes. That is exact where + - * / are, and smooth across
 * directions. Samples vote into the four nearest cells, bilinearly. */
#include "descriptor.h"

#include <math.h>
#include <string.h>

#define CELLS 4
#define DIRECTIONS 8

/* Votes of a gradient: direction numbers k, k + 1 counted from +x towards +y. */
static int32_t vote(float gx, float gy, float *alpha, float *beta)
{
    static const float root2 = 1.41421356f;
    float ax = fabsf(gx), ay = fabsf(gy);
    int32_t steep = ay > ax, flip = (gx < 0) != (gy < 0);
    float major = steep ? ay : ax, minor = steep ? ax : ay;
    float axis = major - minor, diagonal = minor * root2;
    /* octants counter as the quadrant and the steeper axis say; in every second one the diagonal comes first */
    int32_t quadrant = gx >= 0 ? (gy >= 0 ? 0 : 3) : (gy >= 0 ? 1 : 2);
    int32_t second = flip ? !steep : steep; /* second octant of the quadrant: the diagonal first, then the next axis */
    *alpha = second ? diagonal : axis;
    *beta = second ? axis : diagonal;
    return 2 * quadrant + second;
}

/* Index of the lower of the two cells that a sample at `i` of `size` votes into (-1 .. 3) and the weight of the upper one. */
static int32_t cell(int32_t i, int32_t size, float *upper)
{
    float position = ((float)i + 0.5f) * CELLS / (float)size - 0.5f;
    int32_t lower = position < 0 ? -1 : (int32_t)position;
    *upper = position - (float)lower;
    return lower;
}

static void accumulate(float histogram[CELLS][CELLS][DIRECTIONS], int32_t x, int32_t y, int32_t size, float gx, float gy)
{
    float alpha, beta, wx, wy;
    int32_t direction = vote(gx, gy, &alpha, &beta), next = (direction + 1) & (DIRECTIONS - 1);
    int32_t cx = cell(x, size, &wx), cy = cell(y, size, &wy);
    for (int32_t j = 0; j < 2; j++)
        for (int32_t i = 0; i < 2; i++) {
            if (cx + i < 0 || cx + i >= CELLS || cy + j < 0 || cy + j >= CELLS)
                continue;
            float weight = (i ? wx : 1 - wx) * (j ? wy : 1 - wy);
            histogram[cy + j][cx + i][direction] += weight * alpha;
            histogram[cy + j][cx + i][next] += weight * beta;
        }
}

void asj_descriptor_sift(const uint16_t *grey, int32_t size, int16_t *unit)
{
    float histogram[CELLS][CELLS][DIRECTIONS];
    memset(histogram, 0, sizeof histogram);
    for (int32_t y = 0; y < size; y++)
        for (int32_t x = 0; x < size; x++) {
            int32_t left = x > 0 ? x - 1 : x, right = x + 1 < size ? x + 1 : x;
            int32_t above = y > 0 ? y - 1 : y, below = y + 1 < size ? y + 1 : y;
            float gx = (float)(grey[y * size + right] - grey[y * size + left]);
            float gy = (float)(grey[below * size + x] - grey[above * size + x]);
            accumulate(histogram, x, y, size, gx, gy);
        }
    const float *entry = &histogram[0][0][0];
    float sum = 0;
    for (int32_t i = 0; i < ASJ_SIFT_LENGTH; i++)
        sum += entry[i];
    for (int32_t i = 0; i < ASJ_SIFT_LENGTH; i++)
        unit[i] = sum > 0 ? (int16_t)(sqrtf(entry[i] / sum) * ASJ_UNIT_ONE + 0.5f) : 0;
}
