/* SPDX-License-Identifier: BSD-2-Clause */
/* Ghosts. What an octave sees is blurred: an edge that begins six of its pixels from a junction, at a corner of its own, seems to
 * begin there. Coarse octaves so make junctions of edges that do not meet, where their lines would, beside the fine corners at
 * which they end.
 *
 * A branch of a coarse junction belongs to a finer junction when that lies on it, no more than BEGINS px of the coarse octave from
 * its beginning, has a branch the same way and none the other way: the edge begins there. When what is left has no opening, the
 * junction is a ghost. */
#include "octave_ghosts.h"
#include "core/angle.h"

#include <math.h>
#include <string.h>

#define CELL 16 /* px */

#define BEGINS 6.0        /* px of the coarser octave. Less leaves ghosts; more begins to tell corners that are there from others */
#define OFF_LINE 1.5      /* px of the coarser octave */
#define SAME_WAY 0.2      /* rad: to which directions of both octaves agree */
#define OTHER_WAY 0.3     /* rad: to which a branch goes on */

static int32_t cells_of(int32_t size)
{
    return size / CELL + 1;
}

size_t asj_octave_grid_cells(size_t count, int32_t width, int32_t height)
{
    return (size_t)cells_of(width) * (size_t)cells_of(height) + count;
}

static int32_t inside(double cell, int32_t cells)
{
    return cell <= 0 ? 0 : cell >= cells - 1 ? cells - 1 : (int32_t)cell;
}

asj_octave_cells asj_octave_grid_around(const asj_octave_grid *grid, const asj_hypothesis *hypothesis, double reach)
{
    const double x = hypothesis->x, y = hypothesis->y;
    return (asj_octave_cells){inside((x - reach) / CELL, grid->columns), inside((x + reach) / CELL, grid->columns),
                              inside((y - reach) / CELL, grid->rows), inside((y + reach) / CELL, grid->rows)};
}

asj_octave_grid asj_octave_grid_start(int32_t width, int32_t height, int32_t *cells)
{
    asj_octave_grid grid = {cells, NULL, cells_of(width), cells_of(height), 0};
    const size_t count = (size_t)grid.columns * (size_t)grid.rows;
    grid.next = cells + count;
    memset(grid.heads, 0xff, count * sizeof *grid.heads);
    return grid;
}

void asj_octave_grid_add(asj_octave_grid *grid, const asj_hypothesis *hypotheses, size_t index)
{
    const asj_octave_cells at = asj_octave_grid_around(grid, &hypotheses[index], 0);
    int32_t *head = &grid->heads[at.top * grid->columns + at.left];
    grid->next[index] = *head;
    *head = (int32_t)index;
    grid->coarsest = grid->coarsest > hypotheses[index].octave ? grid->coarsest : hypotheses[index].octave;
}

/* Whether the branch begins at `finer` and not at the junction that it is said to be of. */
static int begins_at(const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch, const asj_hypothesis *finer)
{
    const double scale = asj_octave_scale(hypothesis->octave), ux = cos(branch->angle), uy = sin(branch->angle);
    const double dx = finer->x - hypothesis->x, dy = finer->y - hypothesis->y;
    const double t = dx * ux + dy * uy, s = dy * ux - dx * uy - branch->offset;
    return t > 0 && t <= BEGINS * scale && fabs(s) <= OFF_LINE * scale + 0.5 * branch->apart &&
           !asj_hypothesis_is_free(finer, branch->angle, SAME_WAY) &&
           asj_hypothesis_is_free(finer, branch->angle + ASJ_PI, OTHER_WAY);
}

/* keep[b] = 0 for the branches that begin at one of the hypotheses from `first` on. */
static void drop_begun(const asj_octave_grid *grid, const asj_hypothesis *hypotheses, int32_t first,
                       const asj_hypothesis *hypothesis, int *keep)
{
    for (int32_t i = first; i >= 0; i = grid->next[i])
        for (int32_t b = 0; b < hypothesis->branch_count && hypotheses[i].octave < hypothesis->octave; b++)
            keep[b] &= !begins_at(hypothesis, &hypothesis->branches[b], &hypotheses[i]);
}

int asj_octave_ghost(const asj_octave_grid *grid, const asj_hypothesis *hypotheses, const asj_hypothesis *hypothesis,
                     double minimum_opening)
{
    const double reach = (BEGINS + OFF_LINE) * asj_octave_scale(hypothesis->octave);
    const asj_octave_cells near = asj_octave_grid_around(grid, hypothesis, reach);
    asj_hypothesis rest = *hypothesis;
    int keep[ASJ_MAX_BRANCHES];
    for (int32_t b = 0; b < hypothesis->branch_count; b++)
        keep[b] = 1;
    for (int32_t row = near.top; row <= near.bottom; row++)
        for (int32_t column = near.left; column <= near.right; column++)
            drop_begun(grid, hypotheses, grid->heads[row * grid->columns + column], hypothesis, keep);
    asj_hypothesis_select(&rest, keep);
    return !asj_hypothesis_has_opening(&rest, minimum_opening * ASJ_DEGREE);
}
