/* SPDX-License-Identifier: BSD-2-Clause */
/* Soft corners that are found twice (not in the paper).
 *
 * Where a soft edge is a narrow frame, as that of a board on a wall, or bends, the isotropic test also sees a corner some px beside
 * the true one, the fits bring it to no other place, and its branches diverge from the edges: weak, since their strips leave the
 * edge. Suppression (suppress.c) is for places within 3 px, and an edge is wider than that. So a junction is a twin when another
 * one is no farther than REACH widths of its own edges, goes the same way with every branch, and is surer by far: its best branch
 * by SURER decades of NFA, where the twin's own is above WEAK. Sharp corners, whose edges tell no width, have no twins, nor have
 * those of preset match, whose octaves are detectors of their own.
 *
 * Sixteen photographs, upsampled 2.5 times and blurred by 4 px: of four that go two are ghosts beside a board's corners, one lies
 * on a bent edge, one may be a corner; with REACH 5 the inner corner of a letter goes, too. As they are the photographs have none.
 * Without WEAK true corners go: of the junctions of eighteen photographs .3 % less repeat at zoom .9. */
#include "soft_twins.h"
#include "octave_grid.h"

#include <math.h>

#define REACH 4.0     /* widths */
#define SAME_WAY 0.35 /* rad: what a twin's branches diverge by is about half of it */
#define WEAK (-8 * ASJ_LN_10)
#define SURER (10 * ASJ_LN_10)

static double best_log_nfa(const asj_hypothesis *hypothesis)
{
    double best = HUGE_VAL;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        best = fmin(best, hypothesis->branches[i].log_nfa);
    return best;
}

/* px; 0 = sharp, or surer than twins are. */
static double reach_of(const asj_hypothesis *hypothesis)
{
    double width = 0;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        width = fmax(width, hypothesis->branches[i].width);
    return best_log_nfa(hypothesis) > WEAK ? REACH * width : 0;
}

static int is_twin_of(const asj_hypothesis *twin, double reach, const asj_hypothesis *other)
{
    if (!(hypot(other->x - twin->x, other->y - twin->y) <= reach && best_log_nfa(other) <= best_log_nfa(twin) - SURER))
        return 0;
    for (int32_t i = 0; i < twin->branch_count; i++)
        if (asj_hypothesis_is_free(other, twin->branches[i].angle, SAME_WAY))
            return 0;
    return 1;
}

static int has_twin(const asj_octave_grid *grid, const asj_hypothesis *all, const asj_hypothesis *hypothesis)
{
    const double reach = reach_of(hypothesis);
    const asj_octave_cells near = asj_octave_grid_around(grid, hypothesis, reach);
    for (int32_t row = near.top; row <= near.bottom && reach > 0; row++)
        for (int32_t column = near.left; column <= near.right; column++)
            for (int32_t i = grid->heads[row * grid->columns + column]; i >= 0; i = grid->next[i])
                if (is_twin_of(hypothesis, reach, &all[i]))
                    return 1;
    return 0;
}

/* cells: for the grid; twins: one for each hypothesis. All are asked before any is dropped. */
static void drop(asj_detection_run *run, int32_t *cells, int32_t *twins)
{
    asj_octave_grid grid = asj_octave_grid_start(run->frame->width, run->frame->height, cells);
    size_t kept = 0;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        asj_octave_grid_add(&grid, run->hypotheses, i);
    for (size_t i = 0; i < run->hypothesis_count; i++)
        twins[i] = has_twin(&grid, run->hypotheses, &run->hypotheses[i]);
    for (size_t i = 0; i < run->hypothesis_count; i++)
        if (!twins[i])
            run->hypotheses[kept++] = run->hypotheses[i];
    run->hypothesis_count = kept;
}

asj_status asj_drop_soft_twins(asj_detection_run *run)
{
    size_t soft = 0;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        soft += reach_of(&run->hypotheses[i]) > 0;
    if (soft == 0 || run->options->independent_octaves)
        return ASJ_OK;
    const size_t count = asj_octave_grid_cells(run->hypothesis_count, run->frame->width, run->frame->height);
    int32_t *cells = asj_allocate_list(&run->context->memory, count + run->hypothesis_count, sizeof *cells);
    if (!cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    drop(run, cells, cells + count);
    asj_release(&run->context->memory, cells);
    return ASJ_OK;
}
