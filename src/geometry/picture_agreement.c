/* SPDX-License-Identifier: BSD-2-Clause */
/* Do the pictures agree at all with a geometry? No other one is needed to ask.
 *
 * Rooms that have nothing in common have the same doors, shelves and tiles, whose corners are matched as exactly as any. What is
 * painted, stands or lies between them is something else, though. With r the difference of brightness of a cell (picture_look.c)
 * and s the mean of those that its picture in image 1 has with the pictures in image 2 of other cells of its plane, RING_START to
 * RING_END cells away, which is what chance would bring there,
 *
 *     d = log (s + F)/(r + F),   k = log (s + F)/((1 + NOISE) F),   F = ASJ_LEAST_DIFFERENCE:
 *
 * what the cell says for the geometry, and what it could say at most: nothing on a bare wall. Of blocks of cells near matches,
 * whose plane is known best, the agreement is the share (sum of d)/(sum of k), drawn to ASJ_USUAL_AGREEMENT where that is
 * little. */
#include "picture_agreement.h"

#include <math.h>

#define BLOCK 2        /* cells along a block: they share what they show */
#define RING_START 2.2 /* cells */
#define RING_END 8.9
#define RING 8         /* whole ones */
#define LEAST_RING 6   /* cells to compare with */
#define NOISE 0.3
#define LITTLE 8.0     /* nats */

/* What a cell says, and what it could. */
typedef struct gain {
    double said, known;
    int32_t cells;
} gain;

/* Mean difference between cell n in image 1 and another one in image 2. */
static double difference(const asj_picture_look *look, int32_t n, int32_t other)
{
    double sum = 0;
    for (int32_t c = 0; c < look->channel_count; c++)
        sum += fabs(look->brightness[c][other][1] - look->offset[c] - look->slope[c] * look->brightness[c][n][0]);
    return sum / look->channel_count;
}

/* s; negative where there is little to compare with. */
static double by_chance(const asj_picture_look *look, int32_t n)
{
    const int32_t column = n % ASJ_CELLS_ALONG, row = n / ASJ_CELLS_ALONG;
    double sum = 0;
    int32_t count = 0;
    for (int32_t y = row > RING ? row - RING : 0; y <= row + RING && y < ASJ_CELLS_ALONG; y++)
        for (int32_t x = column > RING ? column - RING : 0; x <= column + RING && x < ASJ_CELLS_ALONG; x++) {
            const int32_t other = y * ASJ_CELLS_ALONG + x, far2 = (x - column) * (x - column) + (y - row) * (y - row);
            if (look->cells[other].plane != look->cells[n].plane || far2 < RING_START * RING_START || far2 > RING_END * RING_END)
                continue;
            sum += difference(look, n, other);
            count++;
        }
    return count < LEAST_RING ? -1 : sum / count;
}

static void add_cell(const asj_picture_look *look, int32_t n, gain *block)
{
    const double least = ASJ_LEAST_DIFFERENCE;
    if (look->cells[n].plane < 0 || !look->cells[n].is_near)
        return;
    const double chance = by_chance(look, n);
    if (chance < 0)
        return;
    block->said += log((chance + least) / (look->cells[n].difference + least));
    block->known += log((chance + least) / ((1 + NOISE) * least));
    block->cells++;
}

double asj_agreement_said(asj_agreement agreement)
{
    return agreement.share * (agreement.known + LITTLE) - ASJ_USUAL_AGREEMENT * LITTLE;
}

asj_agreement asj_pictures_agreement(const asj_picture_look *look)
{
    gain all = {0, 0, 0};
    for (int32_t row = 0; row < ASJ_CELLS_ALONG; row += BLOCK)
        for (int32_t column = 0; column < ASJ_CELLS_ALONG; column += BLOCK) {
            gain block = {0, 0, 0};
            for (int32_t k = 0; k < BLOCK * BLOCK; k++)
                add_cell(look, (row + k / BLOCK) * ASJ_CELLS_ALONG + column + k % BLOCK, &block);
            if (block.cells > 0) {
                all.said += block.said / block.cells;
                all.known += block.known / block.cells;
            }
        }
    const double known = fmax(0, all.known);
    return (asj_agreement){(all.said + ASJ_USUAL_AGREEMENT * LITTLE) / (known + LITTLE), known};
}
