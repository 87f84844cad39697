/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_detect(): the paper's steps in order. */
#include "core/backend.h"
#include "octaves.h"
#include "region.h"
#include "result.h"
#include "steps.h"

#include <string.h>

/* Lengths and orientations depend on each other: a ray along a branch that is a degree off leaves the edge early. So the branches
 * are scanned, oriented over their length, and scanned again where that moved them. */
static asj_status run_octave(asj_detection_run *run)
{
    static const struct {
        asj_status (*step)(asj_detection_run *run);
        int32_t stage;
        double done; /* of the whole, when the step ends */
    } steps[] = {
        {asj_step_gradient, ASJ_STAGE_GRADIENT, 0.05},     /* step 1 */
        {asj_step_candidates, ASJ_STAGE_CANDIDATES, 0.50}, /* step 2 */
        {asj_step_isotropic, ASJ_STAGE_ISOTROPIC, 0.70},   /* step 3 */
        {asj_step_guess, ASJ_STAGE_LOCATE, 0.75},
        {asj_step_locate, ASJ_STAGE_LOCATE, 0.80},
        {asj_step_scan, ASJ_STAGE_SCAN, 0.90},             /* step 4 */
        {asj_step_orient, ASJ_STAGE_REFINE, 0.92},         /* step 5 */
        {asj_step_scan, ASJ_STAGE_SCAN, 0.95},             /* step 4 */
        {asj_step_refine, ASJ_STAGE_REFINE, 0.98},         /* step 5 */
        {asj_step_ends, ASJ_STAGE_REFINE, 0.99},
    };
    asj_status status = ASJ_OK;
    for (size_t i = 0; i < sizeof steps / sizeof steps[0] && status == ASJ_OK; i++) {
        status = steps[i].step(run);
        asj_detection_run_time(run, steps[i].stage);
        if (status == ASJ_OK)
            status = asj_detection_run_progress(run, steps[i].stage, steps[i].done);
    }
    return status;
}

/* From the finest to the coarsest; each takes as long as its share of all pixels. */
static asj_status run_octaves(asj_detection_run *run)
{
    const asj_octave_range range = asj_octaves_of(run->options, run->image->width, run->image->height);
    asj_status status = asj_step_load(run);
    while (run->octave < range.first && status == ASJ_OK)
        status = asj_step_halve(run);
    for (;;) {
        run->done += run->octave > range.first ? run->share : 0;
        run->share = (double)run->frame->width * run->frame->height / range.pixels;
        status = status == ASJ_OK ? run_octave(run) : status;
        if (status != ASJ_OK || run->octave + 1 == range.end)
            break;
        status = asj_step_next_octave(run);
    }
    if (status == ASJ_OK)
        status = asj_step_merge_octaves(run);
    if (status == ASJ_OK)
        status = asj_step_join(run);
    asj_detection_run_time(run, ASJ_STAGE_REFINE);
    return status;
}

/* Step 6 decomposes the junctions as the result is filled. */
static asj_status finish(asj_detection_run *run, double start, asj_detection **result)
{
    const double minimum_opening = run->options->minimum_opening;
    const asj_findings findings = {run->hypotheses, run->hypothesis_count, run->edges, run->edge_count};
    asj_status status = asj_result_fill(run->context, &findings, minimum_opening, result);
    if (status != ASJ_OK)
        return asj_fail(run->context, status, "no memory for %zu junctions", run->hypothesis_count);
    asj_detection *found = *result;
    found->width = run->image->width;
    found->height = run->image->height;
    found->backend = asj_context_backend(run->context);
    found->candidates = run->candidate_count;
    found->isotropic = run->isotropic_count;
    asj_detection_run_time(run, ASJ_STAGE_DECOMPOSE);
    memcpy(found->stage_ms, run->stage_ms, sizeof found->stage_ms);
    found->total_ms = run->clock - start;
    return ASJ_OK;
}

static asj_status detect(asj_context *context, const asj_image *image, const asj_region *region, const asj_detect_options *options,
                         double start, asj_detection **result)
{
    asj_detection_run run;
    asj_status status = asj_detection_run_begin(&run, context, image, options, result);
    run.clock = start;
    run.region = region;
    if (status == ASJ_OK)
        status = asj_region_check(context, image, region);
    if (status == ASJ_OK)
        status = run_octaves(&run);
    if (status == ASJ_OK)
        status = finish(&run, start, result);
    asj_detection_run_end(&run);
    return status;
}

asj_status asj_detect_region(asj_context *context, const asj_image *image, const asj_region *region,
                             const asj_detect_options *options, asj_detection **result)
{
    const double start = asj_clock_ms();
    asj_status status;
    if (result && *result)
        asj_result_clear(*result);
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    asj_backend_begin(context);
    do
        status = detect(context, image, region, options, start, result);
    while (asj_backend_retry(context, status));
    return status;
}

asj_status asj_detect_into(asj_context *context, const asj_image *image, const asj_detect_options *options, asj_detection **result)
{
    return asj_detect_region(context, image, NULL, options, result);
}

asj_status asj_detect(asj_context *context, const asj_image *image, const asj_detect_options *options, asj_detection **result)
{
    if (result)
        *result = NULL;
    return asj_detect_into(context, image, options, result);
}
