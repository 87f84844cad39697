/* SPDX-License-Identifier: BSD-2-Clause */
/* Guesses, and which of them are of one corner: the isotropic test finds a clear corner at several pixels and radii. */
#include "guess.h"
#include "close_grid.h"
#include "core/angle.h"
#include "core/sort.h"

#include <math.h>
#include <string.h>

/* Guesses are one, and only one is worth a fit, when they lie this close, with the same branches to within this angle. Chosen: less
 * sends more guesses of one corner to the fits, which costs time; more drops corners that the fits would tell from their
 * neighbours. */
#define TWIN_DISTANCE 1.5             /* px */
#define TWIN_TURN (10 * ASJ_DEGREE)

/* A guess that has moved no farther than this is not likely to be rejected because it moves too far (max_move, 2.5 px). */
#define SURELY_NEAR 1.5 /* px */

asj_guess asj_guess_of(const asj_hypothesis *hypothesis)
{
    asj_guess guess = {.x = hypothesis->x, .y = hypothesis->y, .log_nfa = hypothesis->log_nfa, .first = hypothesis->first};
    guess.x0 = (uint16_t)hypothesis->x0;
    guess.y0 = (uint16_t)hypothesis->y0;
    guess.radius = (uint16_t)hypothesis->radius;
    guess.branch_count = (uint16_t)hypothesis->branch_count;
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        guess.angle[i] = hypothesis->branches[i].angle;
        guess.offset[i] = hypothesis->branches[i].offset;
        guess.apart[i] = hypothesis->branches[i].apart;
        guess.strength[i] = (uint16_t)(hypothesis->branches[i].strength * ASJ_STRENGTH_ONE);
    }
    return guess;
}

void asj_guess_restore(const asj_guess *guess, asj_hypothesis *hypothesis)
{
    memset(hypothesis, 0, sizeof *hypothesis);
    hypothesis->x = guess->x;
    hypothesis->y = guess->y;
    hypothesis->x0 = guess->x0;
    hypothesis->y0 = guess->y0;
    hypothesis->radius = guess->radius;
    hypothesis->log_nfa = guess->log_nfa;
    hypothesis->first = guess->first;
    hypothesis->branch_count = guess->branch_count;
    for (int32_t i = 0; i < guess->branch_count; i++) {
        hypothesis->branches[i].angle = guess->angle[i];
        hypothesis->branches[i].offset = guess->offset[i];
        hypothesis->branches[i].apart = guess->apart[i];
        hypothesis->branches[i].strength = (double)guess->strength[i] / ASJ_STRENGTH_ONE;
    }
}

static int by_meaning(const void *a, const void *b)
{
    const asj_guess *p = a, *q = b;
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return p->y0 != q->y0 ? p->y0 - q->y0 : p->x0 - q->x0;
}

void asj_guess_sort(asj_guess *guesses, size_t count)
{
    if (count > 1)
        asj_sort(guesses, count, sizeof *guesses, by_meaning);
}

/* Whether each branch of a guess is one of the other's too, and the other one is not likely to be rejected yet. */
static int same_junction(const asj_guess *guess, const asj_guess *other)
{
    if (guess->branch_count != other->branch_count || hypot(other->x - other->x0, other->y - other->y0) > SURELY_NEAR)
        return 0;
    for (int32_t i = 0; i < guess->branch_count; i++) {
        int found = 0;
        for (int32_t j = 0; j < other->branch_count; j++)
            found |= asj_angle_distance(guess->angle[i], other->angle[j]) < TWIN_TURN;
        if (!found)
            return 0;
    }
    return 1;
}

static int has_twin(const asj_guess *guesses, const asj_guess *guess, const asj_close_grid *grid, int64_t cell)
{
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            for (int32_t i = grid->heads[cell + dy * grid->columns + dx]; i >= 0; i = grid->next[i]) {
                const double x = guesses[i].x - guess->x, y = guesses[i].y - guess->y;
                if (x * x + y * y < TWIN_DISTANCE * TWIN_DISTANCE && same_junction(guess, &guesses[i]))
                    return 1;
            }
    return 0;
}

size_t asj_guess_drop_twins(asj_guess *guesses, size_t count, int32_t width, int32_t height, int32_t *cells)
{
    asj_close_grid grid = asj_close_grid_start(width, height, cells);
    size_t valid = 0, kept = 0;
    for (size_t i = 0; i < count; i++)
        if (guesses[i].branch_count >= 2)
            guesses[valid++] = guesses[i];
    asj_guess_sort(guesses, valid);
    for (size_t i = 0; i < valid; i++) {
        const asj_guess guess = guesses[i];
        const int64_t cell = asj_close_grid_cell(&grid, guess.x, guess.y);
        if (has_twin(guesses, &guess, &grid, cell))
            continue;
        guesses[kept] = guess;
        asj_close_grid_add(&grid, cell, kept++);
    }
    return kept;
}
