/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5 over an image: orientations to scan along again, and at the end orientations, locations and validation. */
#include "refine.h"
#include "blurred_corner.h"
#include "edge_width.h"
#include "end_kind.h"
#include "slip.h"
#include "steps.h"
#include "suppress.h"
#include "validate.h"

static void orient(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    asj_orient(run->context, run->frame, run->options, hypothesis);
    if (asj_detection_run_is_coarse(run)) {
        asj_edge_widths(run->frame, hypothesis);
        asj_blurred_corner(run->context, run->frame, hypothesis);
    }
    asj_reject_oriented(run->context, run->frame, run->options, hypothesis);
}

asj_status asj_step_orient(asj_detection_run *run)
{
    if (run->options->refinement == ASJ_REFINE_SEARCH)
        return asj_step_search(run);
    const asj_status status = asj_detection_run_each(run, ASJ_STAGE_REFINE, ASJ_LEAST_JUNCTIONS, orient);
    asj_detection_run_drop_rejected(run);
    return status;
}

static void fit_lines(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    if (run->one_list || asj_detection_run_is_coarse(run)) /* soft edges are looked for: how soft? */
        asj_edge_widths(run->frame, hypothesis);
    asj_refine(run->context, run->frame, run->options, hypothesis);
}

/* Branches that slip become shorter, and all lines are fitted once more from where they were: the lines say where the junction is,
 * too. Not where max_tilt is 0. */
void asj_step_fit_lines(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    asj_hypothesis shortened = *hypothesis;
    int slips = 0;
    fit_lines(run, hypothesis);
    for (int32_t i = 0; i < hypothesis->branch_count && run->options->max_tilt > 0; i++) {
        const double length = asj_slip_length(run->context->ops->edge, run->frame, hypothesis, &hypothesis->branches[i]);
        slips |= length < shortened.branches[i].length;
        shortened.branches[i].length = length;
    }
    if (!slips)
        return;
    *hypothesis = shortened;
    fit_lines(run, hypothesis);
}

static void refine(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    asj_step_fit_lines(run, hypothesis);
    if (asj_blurred_corner_is_sure(hypothesis))
        asj_ends_of_short(run->context->ops->edge, run->frame, run->options, hypothesis);
    asj_validate(run->context, run->frame, run->options, hypothesis);
}

asj_status asj_step_refine(asj_detection_run *run)
{
    asj_status status = asj_detection_run_each(run, ASJ_STAGE_REFINE, ASJ_LEAST_JUNCTIONS, refine);
    if (status == ASJ_OK)
        status = asj_sizes_put_rejected(run);
    return status == ASJ_OK ? asj_suppress_all(run) : status;
}
