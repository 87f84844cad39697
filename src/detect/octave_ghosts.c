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

#define BEGINS 6.0        /* px of the coarser octave. Less leaves ghosts; more begins to tell corners that are there from others */
#define OFF_LINE 1.5      /* px of the coarser octave */
#define SAME_WAY 0.2      /* rad: to which directions of both octaves agree */
#define OTHER_WAY 0.3     /* rad: to which a branch goes on */

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
