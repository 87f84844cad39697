/* SPDX-License-Identifier: BSD-2-Clause */
/* The luma of an image that is looked at with colours after it has been without (match_images.c): with independent_octaves colours
 * leave all that is found in it as it is (planes_step.c), so it need not be found again. (Unrelated photographs, with a geometry
 * asked: .85 .93 .92 .87 of the time.) Not with three_sizes, whose copies are looked at where others have disagreed, nor where the
 * caller sees every stage. */
#include "luma_step.h"
#include "steps.h"

#include <string.h>

int asj_luma_may_be_kept(const asj_detection_run *run)
{
    return run->luma && run->options->independent_octaves && !run->options->three_sizes && !run->context->options.dump;
}

/* A copy of `count` elements; NULL without memory, never for an empty list. */
static void *copy_of(asj_memory *memory, const void *list, size_t count, size_t size)
{
    void *copy = asj_allocate(memory, asj_detection_run_room(count), size);
    if (copy && count > 0)
        memcpy(copy, list, count * size);
    return copy;
}

asj_status asj_step_keep_luma(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    asj_luma_found *luma = run->luma;
    *luma = (asj_luma_found){.found = copy_of(memory, run->found, run->found_count, sizeof *run->found),
                             .evidence = copy_of(memory, run->evidence, run->evidence_count, sizeof *run->evidence),
                             .found_count = run->found_count, .evidence_count = run->evidence_count,
                             .candidates = run->candidate_total, .isotropic = run->isotropic_total};
    luma->is_known = luma->found && luma->evidence;
    return luma->is_known ? ASJ_OK
                          : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to keep %zu junctions", run->found_count);
}

asj_status asj_step_recall_luma(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    const asj_luma_found *luma = run->luma;
    run->found = copy_of(memory, luma->found, luma->found_count, sizeof *run->found);
    run->evidence = copy_of(memory, luma->evidence, luma->evidence_count, sizeof *run->evidence);
    if (!run->found || !run->evidence)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", luma->found_count);
    run->found_count = luma->found_count;
    run->found_capacity = asj_detection_run_room(luma->found_count);
    run->evidence_count = luma->evidence_count;
    run->evidence_capacity = asj_detection_run_room(luma->evidence_count);
    run->candidate_total = luma->candidates;
    run->isotropic_total = luma->isotropic;
    run->share = 1.0 / run->planes.count; /* of the progress, as if it had been looked at */
    return ASJ_OK;
}

void asj_luma_found_free(asj_memory *memory, asj_luma_found *luma)
{
    asj_release_much(memory, luma->found);
    asj_release_much(memory, luma->evidence);
    *luma = (asj_luma_found){.is_known = 0};
}
