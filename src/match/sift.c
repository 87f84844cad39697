/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, a SIFT-like descriptor: 4 x 4 cells of 8 orientations (Lowe 2004), each entry the square root of its share (RootSIFT,
 * Arandjelovic and Zisserman 2012), so that the product of two is their Hellinger affinity, at most 1.
 *
 * No angle is computed: a gradient g between two neighbouring of the eight directions d_k, d_k+1 (45 degrees apart) is written as
 * g = alpha d_k + beta d_k+1 with alpha, beta >= 0, which are its votes: an axis gets what is left of its component after the
 * other one, a diagonal sqrt(2) times the smaller of its two. That is smooth across directions and needs no branch. Samples vote
 * into the four nearest cells, bilinearly: first rows into rows of cells, then columns. */
#include "sift.h"

#include <math.h>
#include <string.h>

#define CELLS 4
#define DIRECTIONS 8

/* Weight of the samples of a side for each cell; a sample counts in the two cells nearest to it. */
static void find_weights(int32_t size, float weights[CELLS][ASJ_PATCH_SIDE])
{
    for (int32_t c = 0; c < CELLS; c++)
        for (int32_t i = 0; i < size; i++) {
            const float away = fabsf(((float)i + 0.5f) * CELLS / (float)size - 0.5f - (float)c);
            weights[c][i] = away < 1 ? 1 - away : 0;
        }
}

static inline float positive(float value)
{
    return value > 0 ? value : 0;
}

static inline float smaller(float a, float b)
{
    return a < b ? a : b;
}

/* Votes of one row of samples, direction by direction from +x towards +y. */
static void vote(const float *gx, const float *gy, int32_t size, float votes[DIRECTIONS][ASJ_PATCH_SIDE])
{
    const float root2 = 1.41421356f;
    for (int32_t i = 0; i < size; i++) {
        const float right = positive(gx[i]), left = positive(-gx[i]), down = positive(gy[i]), up = positive(-gy[i]);
        const float across = right + left, along = down + up;
        votes[0][i] = positive(right - along);
        votes[1][i] = root2 * smaller(right, down);
        votes[2][i] = positive(down - across);
        votes[3][i] = root2 * smaller(left, down);
        votes[4][i] = positive(left - along);
        votes[5][i] = root2 * smaller(left, up);
        votes[6][i] = positive(up - across);
        votes[7][i] = root2 * smaller(right, up);
    }
}

/* Differences of neighbours; at the border of the patch the sample itself is the neighbour. */
static void differentiate(const uint16_t *grey, int32_t size, int32_t y, float *gx, float *gy)
{
    const uint16_t *row = grey + y * size, *above = y > 0 ? row - size : row, *below = y + 1 < size ? row + size : row;
    for (int32_t x = 0; x < size; x++)
        gy[x] = (float)((int32_t)below[x] - (int32_t)above[x]);
    gx[0] = (float)((int32_t)row[1] - (int32_t)row[0]);
    for (int32_t x = 1; x + 1 < size; x++)
        gx[x] = (float)((int32_t)row[x + 1] - (int32_t)row[x - 1]);
    gx[size - 1] = (float)((int32_t)row[size - 1] - (int32_t)row[size - 2]);
}

void asj_sift_describe(const uint16_t *grey, int32_t size, int16_t *unit)
{
    float weights[CELLS][ASJ_PATCH_SIDE], rows[CELLS][DIRECTIONS][ASJ_PATCH_SIDE], entry[ASJ_SIFT_LENGTH], sum = 0;
    memset(rows, 0, sizeof rows);
    find_weights(size, weights);
    for (int32_t y = 0; y < size; y++) {
        float gx[ASJ_PATCH_SIDE], gy[ASJ_PATCH_SIDE], votes[DIRECTIONS][ASJ_PATCH_SIDE];
        differentiate(grey, size, y, gx, gy);
        vote(gx, gy, size, votes);
        for (int32_t c = 0; c < CELLS; c++) {
            const float weight = weights[c][y];
            for (int32_t d = 0; d < DIRECTIONS && weight > 0; d++)
                for (int32_t x = 0; x < size; x++)
                    rows[c][d][x] += weight * votes[d][x];
        }
    }
    const int32_t half = size / CELLS; /* columns that can reach a cell: from half a cell before it to half a cell after it */
    for (int32_t c = 0; c < CELLS; c++)
        for (int32_t k = 0; k < CELLS; k++)
            for (int32_t d = 0; d < DIRECTIONS; d++) {
                const int32_t first = (2 * k - 1) * half / 2, end = first + 2 * half;
                float votes = 0;
                for (int32_t x = first < 0 ? 0 : first; x < end && x < size; x++)
                    votes += weights[k][x] * rows[c][d][x];
                entry[(c * CELLS + k) * DIRECTIONS + d] = votes;
                sum += votes;
            }
    for (int32_t i = 0; i < ASJ_SIFT_LENGTH; i++)
        unit[i] = sum > 0 ? (int16_t)(sqrtf(entry[i] / sum) * ASJ_UNIT_ONE + 0.5f) : 0;
}
