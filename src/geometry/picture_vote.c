/* SPDX-License-Identifier: BSD-2-Clause */
/* Pictures decide between geometries that contradict each other.
 *
 * Where two geometries take a cell (picture_look.c) to different places one of the two is wrong there, and, with r the differences
 * of brightness under either,
 *
 *     d = log (r of the second + ASJ_LEAST_DIFFERENCE)/(r of the first + ASJ_LEAST_DIFFERENCE)
 *
 * says which, whatever the pictures are: both are compared with the same cell. Means of d over blocks of cells, which share what
 * they show, are the voters: with S their sum and t = S / sqrt(sum of squares) (self-normalised, about normal when the pictures
 * know nothing), the pictures contradict the second geometry when t, S and the mean are all large. (Rendered rooms 0 to 49 with
 * three draws of their noise, 50 to 99 with one, by grey levels: of 359 motions that are out by more than 15 degrees with .6 and
 * more of the log evidence of the right one 91 are contradicted in its favour, most others having the same planes in the same
 * places; of 1567 of any evidence one is preferred to the right motion.)
 */
#include "picture_vote.h"

#include <math.h>

#define ELSEWHERE 0.6    /* cells: nearer places are the same */
#define BLOCK 2          /* cells along a block */
#define LEAST_T 1.9
#define LEAST_SUM 3.0
#define LEAST_MEAN 0.15

/* The mean of d over the cells of a block; 0 and *voters as it was when there are none. */
static double ask_block(const asj_picture_look *first, const asj_picture_look *second, int32_t column, int32_t row, double *voters)
{
    const double apart = ELSEWHERE * first->cell;
    double sum = 0;
    int32_t count = 0;
    for (int32_t k = 0; k < BLOCK * BLOCK; k++) {
        const int32_t n = (row + k / BLOCK) * ASJ_CELLS_ALONG + column + k % BLOCK;
        const asj_seen_cell *f = &first->cells[n], *s = &second->cells[n];
        const double dx = f->x2 - s->x2, dy = f->y2 - s->y2;
        if (f->plane < 0 || s->plane < 0 || !(dx * dx + dy * dy > apart * apart))
            continue;
        sum += log((s->difference + ASJ_LEAST_DIFFERENCE) / (f->difference + ASJ_LEAST_DIFFERENCE));
        count++;
    }
    *voters += count > 0;
    return count > 0 ? sum / count : 0;
}

double asj_pictures_against(const asj_picture_look *first, const asj_picture_look *second)
{
    double sum = 0, square = 0, voters = 0;
    for (int32_t row = 0; row < ASJ_CELLS_ALONG; row += BLOCK)
        for (int32_t column = 0; column < ASJ_CELLS_ALONG; column += BLOCK) {
            const double d = ask_block(first, second, column, row, &voters);
            sum += d;
            square += d * d;
        }
    return fmax(0, sum / fmax(LEAST_SUM, fmax(LEAST_MEAN * voters, LEAST_T * sqrt(square))));
}
