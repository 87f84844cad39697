/* SPDX-License-Identifier: BSD-2-Clause */
/* Octaves over an image: what one leaves behind, the next one's grey plane, and at the end one list. */
#include "octaves.h"
#include "octave_confirm.h"
#include "ends.h"
#include "steps.h"

#include <string.h>

#define LEAST_CONFIRMED (4 * ASJ_LEAST_JUNCTIONS) /* for a thread */

static void confirm(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    asj_octave_confirm(run->frame, run->options->minimum_opening, hypothesis);
}

/* The hypotheses of this octave go to the list of all. Those of the image itself have to show in it first: what does not must not
 * keep coarser octaves from theirs (asj_octave_is_known()). */
static asj_status collect(asj_detection_run *run)
{
    const size_t total = run->all_count + run->hypothesis_count;
    const int32_t width = run->image->width, height = run->image->height;
    void *list = run->all;
    asj_status status = ASJ_OK;
    if (run->octave == 0 && run->one_list)
        status = asj_detection_run_each(run, ASJ_STAGE_REFINE, LEAST_CONFIRMED, confirm);
    if (status != ASJ_OK)
        return status;
    status = asj_grow(&run->context->memory, &list, &run->all_capacity, asj_detection_run_room(total), sizeof *run->all,
                      run->all_count);
    run->all = list;
    if (status != ASJ_OK)
        return asj_fail(run->context, status, "no memory for %zu junctions", total);
    for (size_t i = 0; i < run->hypothesis_count; i++) {
        run->all[run->all_count] = run->hypotheses[i];
        asj_octaves_map(&run->all[run->all_count], run->octave);
        run->all_count += (size_t)asj_hypothesis_is_inside(&run->all[run->all_count], width, height);
    }
    run->candidate_total += run->candidate_count;
    run->isotropic_total += run->isotropic_count;
    asj_detection_run_clear(run);
    return ASJ_OK;
}

asj_status asj_step_next_octave(asj_detection_run *run)
{
    asj_status status = collect(run);
    if (status != ASJ_OK)
        return status;
    return run->options->half_octaves ? asj_step_half_octave(run) : asj_step_halve(run);
}

static void confirm_other(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    if (hypothesis->octave != 0)
        confirm(run, hypothesis);
}

/* The image's own grey plane, which is there yet or is made again. */
static asj_status go_back(asj_detection_run *run)
{
    const int32_t width = run->image->width, height = run->image->height;
    run->octave = 0;
    if (run->size == 0 && asj_frame_recall(run->frame, width, height, run->plane))
        return ASJ_OK;
    const asj_status status = asj_frame_prepare_gray(run->context, run->frame, width, height);
    return status == ASJ_OK ? asj_step_load(run) : status;
}

static asj_status confirm_others(asj_detection_run *run)
{
    const asj_status status = go_back(run);
    return status == ASJ_OK ? asj_detection_run_each(run, ASJ_STAGE_REFINE, LEAST_CONFIRMED, confirm_other) : status;
}

static asj_status merge(asj_detection_run *run)
{
    const int32_t width = run->image->width, height = run->image->height;
    const size_t count = asj_octave_grid_cells(run->hypothesis_count, width, height);
    int32_t *cells = asj_allocate_list(&run->context->memory, count, sizeof *cells);
    if (!cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    run->hypothesis_count = asj_octaves_merge(run->hypotheses, run->hypothesis_count, run->options, width, height, cells);
    asj_release(&run->context->memory, cells);
    return ASJ_OK;
}

asj_status asj_step_merge_octaves(asj_detection_run *run)
{
    asj_status status = collect(run);
    if (status != ASJ_OK)
        return status;
    run->hypotheses = run->all;
    run->hypothesis_count = run->all_count;
    run->hypothesis_capacity = run->all_capacity;
    run->all = NULL;
    run->all_count = run->all_capacity = 0;
    if (run->one_list && run->size + 1 < ASJ_SIZES) /* votes alone need not show in the image */
        status = confirm_others(run);
    return status == ASJ_OK && run->one_list ? merge(run) : status;
}
