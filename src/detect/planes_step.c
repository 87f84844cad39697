/* SPDX-License-Identifier: BSD-2-Clause */
/* Planes over an image: the luma, and with `colours` two of opponent colours (core/colour_plane.c), each with its octaves. What
 * they find becomes one list.
 *
 * Corners of the luma are corners of colour, too, mostly, and known better there. So a junction of a colour plane that is as close
 * as CLOSE to one of an earlier plane is left out; what is left are corners between surfaces that differ in colour and hardly in
 * luma. With independent_octaves it stays where the earlier plane has that corner in coarser octaves only: the matcher takes the
 * finest octave of each corner.
 *
 * Each plane counts its tests as octaves do (octaves.c): with independent_octaves by itself, so that colours leave every junction
 * of the luma where it is; else all planes have the false alarms of one together. Branches end at junctions of all planes. */
#include "octaves.h"
#include "region.h"
#include "steps.h"
#include "suppress.h"

#include <math.h>
#include <string.h>

/* Logarithms of the NFA that junctions of colour planes may have: preset match takes what is weaker for luma, whose patches tell
 * what is false; and of smooth noise (core/colour_plane.c) more goes for a junction than the null model has. */
#define SURE 0.0
#define SURE_SMOOTH (-3 * ASJ_LN_10)

#define CLOSE 4.0 /* px of the image */

static int is_known(const asj_detection_run *run, const asj_octave_grid *grid, const asj_hypothesis *hypothesis)
{
    const double coarsest = run->options->independent_octaves ? hypothesis->octave : HUGE_VAL;
    const asj_hypothesis *found = run->found;
    const asj_octave_cells w = asj_octave_grid_around(grid, hypothesis, CLOSE);
    for (int32_t row = w.top; row <= w.bottom; row++)
        for (int32_t column = w.left; column <= w.right; column++)
            for (int32_t i = grid->heads[row * grid->columns + column]; i >= 0; i = grid->next[i])
                if (found[i].octave <= coarsest && hypot(found[i].x - hypothesis->x, found[i].y - hypothesis->y) < CLOSE)
                    return 1;
    return 0;
}

/* The plane's hypotheses that are new go to the end of the list. */
static void add(asj_detection_run *run, int32_t *cells)
{
    asj_octave_grid grid = asj_octave_grid_start(run->image->width, run->image->height, cells);
    for (size_t i = 0; i < run->found_count; i++)
        asj_octave_grid_add(&grid, run->found, i);
    const double most = run->planes.smooth[run->plane] ? SURE_SMOOTH : SURE;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        if (run->hypotheses[i].log_nfa <= most && !is_known(run, &grid, &run->hypotheses[i]))
            run->found[run->found_count++] = run->hypotheses[i];
}

static asj_status merge(asj_detection_run *run)
{
    const size_t total = run->found_count + run->hypothesis_count;
    const size_t count = asj_octave_grid_cells(total, run->image->width, run->image->height);
    void *list = run->found;
    asj_status status = asj_grow(&run->context->memory, &list, &run->found_capacity, asj_detection_run_room(total),
                                 sizeof *run->found, run->found_count);
    run->found = list;
    int32_t *cells = status == ASJ_OK ? asj_allocate_list(&run->context->memory, count, sizeof *cells) : NULL;
    if (!cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", total);
    add(run, cells);
    asj_release(&run->context->memory, cells);
    return ASJ_OK;
}

asj_status asj_step_merge_planes(asj_detection_run *run)
{
    if (run->plane > ASJ_PLANE_LUMA) {
        const asj_status status = merge(run);
        asj_detection_run_clear(run);
        return status;
    }
    run->found = run->hypotheses;
    run->found_count = run->hypothesis_count;
    run->found_capacity = run->hypothesis_capacity;
    run->hypotheses = NULL;
    asj_detection_run_clear(run);
    return ASJ_OK;
}

asj_status asj_step_list(asj_detection_run *run)
{
    run->hypotheses = run->found;
    run->hypothesis_count = run->found_count;
    run->candidate_count = run->candidate_total;
    run->isotropic_count = run->isotropic_total;
    run->found = NULL;
    run->found_count = run->found_capacity = 0;
    if (run->region)
        run->hypothesis_count = asj_region_keep(run->image, run->region, run->hypotheses, run->hypothesis_count);
    asj_suppress_sort(run->hypotheses, run->hypothesis_count);
    return asj_step_snap(run);
}
