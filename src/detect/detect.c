/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_detect(): the paper's steps in order. */
#include "core/backend.h"
#include "luma_step.h"
#include "octaves.h"
#include "region.h"
#include "result.h"
#include "steps.h"

#include <string.h>

typedef struct step {
    asj_status (*run)(asj_detection_run *run);
    int32_t stage;
    double done; /* of these steps, when it ends */
} step;

/* They are this share of the octave, behind what is done of it `before`. */
static asj_status run_steps(asj_detection_run *run, const step *steps, size_t count, double before, double share)
{
    asj_status status = ASJ_OK;
    for (size_t i = 0; i < count && status == ASJ_OK; i++) {
        status = steps[i].run(run);
        asj_detection_run_time(run, steps[i].stage);
        if (status == ASJ_OK)
            status = asj_detection_run_progress(run, steps[i].stage, before + share * steps[i].done);
    }
    return status;
}

/* Lengths and orientations depend on each other: a ray along a branch that is a degree off leaves the edge early. So the branches
 * are scanned, oriented over their length, and scanned again where that moved them. */
static asj_status choose(asj_detection_run *run, double before, double share)
{
    static const step steps[] = {
        {asj_step_locate, ASJ_STAGE_LOCATE, 0.2},
        {asj_step_scan_roughly, ASJ_STAGE_SCAN, 0.6}, /* step 4 */
        {asj_step_orient, ASJ_STAGE_REFINE, 0.7},     /* step 5 */
        {asj_step_scan, ASJ_STAGE_SCAN, 0.85},        /* step 4 */
        {asj_step_refine, ASJ_STAGE_REFINE, 1.0},     /* step 5 */
    };
    return run_steps(run, steps, sizeof steps / sizeof *steps, before, share);
}

/* The isotropic test finds a corner at several pixels, and the most meaningful one suppresses the others before anything is known
 * of its branches. Where that one fails the validation the corner would be lost, and which pixel is the most meaningful is what a
 * tenth of a grey level decides: so what it has suppressed gets a second choice. Not in presets that validate next to nothing. Of
 * 24 photographs' junctions a second choice adds one in thirteen for 3 to 9 % of the time, a third one or two in a hundred. */
static asj_status choose_again(asj_detection_run *run)
{
    if (!run->options->strip_test || run->guess_count == 0)
        return ASJ_OK;
    run->choice = 1;
    run->validated = run->hypothesis_count;
    asj_guess_sort(run->guesses, run->guess_count);
    const asj_status status = choose(run, 0.96, 0.02);
    run->validated = 0;
    return status;
}

static asj_status run_octave(asj_detection_run *run)
{
    static const step before[] = {
        {asj_step_gradient, ASJ_STAGE_GRADIENT, 0.05},     /* step 1 */
        {asj_step_candidates, ASJ_STAGE_CANDIDATES, 0.50}, /* step 2 */
        {asj_step_isotropic, ASJ_STAGE_ISOTROPIC, 0.70},   /* step 3 */
        {asj_step_guess, ASJ_STAGE_LOCATE, 0.75},
    };
    static const step after[] = {{asj_step_complete, ASJ_STAGE_REFINE, 0.985}, {asj_step_ends, ASJ_STAGE_REFINE, 0.99}};
    asj_status status = run_steps(run, before, sizeof before / sizeof *before, 0, 1);
    if (status == ASJ_OK)
        status = choose(run, 0.75, 0.21);
    if (status == ASJ_OK)
        status = choose_again(run);
    return status == ASJ_OK ? run_steps(run, after, sizeof after / sizeof *after, 0, 1) : status;
}

/* From the finest to the coarsest; each takes as long as its share of all pixels. Copies of another size have the octaves of the
 * image itself: what only one size can see has no second vote. */
static asj_status run_octaves(asj_detection_run *run)
{
    const asj_octave_range range = asj_octaves_of(run->options, run->whole->width, run->whole->height);
    const double pixels = range.pixels * run->planes.count * asj_sizes_time(run);
    asj_status status = asj_step_load(run);
    while (run->octave < range.first && status == ASJ_OK)
        status = asj_step_halve(run);
    for (;;) {
        run->done += run->size > 0 || run->plane > 0 || run->octave > range.first ? run->share : 0;
        run->share = asj_size_time(run) * run->frame->width * run->frame->height / pixels;
        status = status == ASJ_OK ? run_octave(run) : status;
        if (status != ASJ_OK || run->octave + 1 >= range.end)
            break;
        status = asj_step_next_octave(run);
    }
    return status == ASJ_OK ? asj_step_merge_octaves(run) : status;
}

static asj_status run_plane(asj_detection_run *run)
{
    const int keeps = run->plane == ASJ_PLANE_LUMA && asj_luma_may_be_kept(run);
    asj_status status = ASJ_OK;
    if (keeps && run->luma->is_known)
        return asj_step_recall_luma(run);
    if (run->plane > 0)
        status = asj_detection_run_start_plane(run);
    if (status == ASJ_OK)
        status = run_octaves(run);
    if (status == ASJ_OK)
        status = asj_step_merge_planes(run);
    return status == ASJ_OK && keeps && !run->options->colours ? asj_step_keep_luma(run) : status;
}

/* The luma, and planes of colour where there are some. */
static asj_status run_planes(asj_detection_run *run)
{
    asj_status status = ASJ_OK;
    for (run->plane = 0; run->plane < run->planes.count && status == ASJ_OK; run->plane++)
        status = run_plane(run);
    run->plane = 0;
    return status;
}

/* The image, and with three_sizes two copies of it. */
static asj_status run_sizes(asj_detection_run *run)
{
    const int32_t sizes = asj_sizes_of(run);
    asj_status status = run_planes(run);
    while (run->size + 1 < sizes && status == ASJ_OK) {
        status = asj_step_next_size(run);
        if (status == ASJ_OK)
            status = run_planes(run);
    }
    if (status == ASJ_OK && sizes > 1)
        status = asj_step_merge_sizes(run);
    if (status == ASJ_OK)
        status = asj_step_list(run);
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
                         asj_luma_found *luma, double start, asj_detection **result)
{
    asj_detection_run run;
    asj_status status = asj_detection_run_begin(&run, context, image, options, result);
    run.clock = start;
    run.region = run.whole_region = region;
    run.luma = luma;
    if (status == ASJ_OK)
        status = asj_region_check(context, image, region);
    if (status == ASJ_OK)
        status = run_sizes(&run);
    if (status == ASJ_OK)
        status = finish(&run, start, result);
    asj_detection_run_end(&run);
    return status;
}

static asj_status detect_in(asj_context *context, const asj_image *image, const asj_region *region,
                            const asj_detect_options *options, asj_luma_found *luma, asj_detection **result)
{
    const double start = asj_clock_ms();
    asj_status status;
    if (result && *result)
        asj_result_clear(*result);
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    asj_backend_begin(context);
    do
        status = detect(context, image, region, options, luma, start, result);
    while (asj_backend_retry(context, status));
    return status;
}

asj_status asj_detect_region(asj_context *context, const asj_image *image, const asj_region *region,
                             const asj_detect_options *options, asj_detection **result)
{
    return detect_in(context, image, region, options, NULL, result);
}

asj_status asj_detect_with_luma(asj_context *context, const asj_image *image, const asj_detect_options *options,
                                asj_luma_found *luma, asj_detection **result)
{
    if (result)
        *result = NULL;
    return detect_in(context, image, NULL, options, luma, result);
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
