/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_detect(): the paper's steps in order. */
#include "core/backend.h"
#include "detect_options.h"
#include "nfa.h"
#include "result.h"
#include "stages.h"

#include <math.h>
#include <string.h>

#define TWO_PI 6.283185307179586

/* The stage's time is what has passed since *start. */
static void stop_watch(double *stage_ms, int32_t stage, double *start)
{
    double now = asj_clock_ms();
    stage_ms[stage] += now - *start;
    *start = now;
}

/* The pipeline. Lengths and orientations depend on each other: a ray along a branch that is a degree off leaves the edge early. So
 * the branches are scanned, oriented over their length, and scanned again where that moved them. */
static asj_status run_steps(asj_detection_run *d, const asj_image *image, double *stage_ms, double *clock)
{
    static const struct {
        int32_t stage;
        asj_status (*run)(asj_detection_run *d);
        double done;
    } steps[] = {
        {ASJ_STAGE_CANDIDATES, asj_stage_candidates, 0.50}, /* step 2 */
        {ASJ_STAGE_ISOTROPIC, asj_stage_isotropic, 0.70},   /* step 3 */
        {ASJ_STAGE_LOCATE, asj_stage_locate, 0.80},
        {ASJ_STAGE_SCAN, asj_stage_scan, 0.90},             /* step 4 */
        {ASJ_STAGE_REFINE, asj_stage_orient, 0.92},         /* step 5 */
        {ASJ_STAGE_SCAN, asj_stage_scan, 0.95},
        {ASJ_STAGE_REFINE, asj_stage_validate, 0.99},
    };
    asj_status status = asj_stage_gradient(d, image);       /* step 1 */
    stop_watch(stage_ms, ASJ_STAGE_GRADIENT, clock);
    for (size_t i = 0; i < sizeof steps / sizeof steps[0] && status == ASJ_OK; i++) {
        status = steps[i].run(d);
        stop_watch(stage_ms, steps[i].stage, clock);
        if (status == ASJ_OK)
            status = asj_progress(d->context, steps[i].stage, steps[i].done);
    }
    return status;
}

/* What both public functions check and set up. On failure nothing is held. */
static asj_status begin(asj_context *context, const asj_image *image, const asj_detect_options **options,
                        asj_detect_options *defaults, const void *output, asj_detection_run *d)
{
    char message[256];
    memset(d, 0, sizeof *d);
    if (!context)
        return ASJ_ERROR_ARGUMENT;
    d->context = context;
    if (!image || !output)
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "%s is NULL", image ? "the place for the result" : "the image");
    if (!*options) {
        asj_detect_options_init(defaults);
        *options = defaults;
    }
    if (asj_detect_options_check(*options, message, sizeof message) != ASJ_OK)
        return asj_fail(context, ASJ_ERROR_OPTION, "%s", message);
    d->options = *options;
    d->threads = context->threads;
    asj_status status = asj_image_check(context, image);
    return status == ASJ_OK ? asj_stage_prepare(d, image->width, image->height) : status;
}

static asj_status finish(asj_detection_run *d, const asj_image *image, const double *stage_ms, asj_detection **result)
{
    asj_status status = asj_result_fill(d->context, d->drafts, d->draft_count, d->options->minimum_opening, result);
    if (status != ASJ_OK)
        return asj_fail(d->context, status, "no memory for %zu junctions", d->draft_count);
    asj_detection *found = *result;
    found->width = image->width;
    found->height = image->height;
    found->backend = asj_context_backend(d->context);
    found->candidates = d->candidate_total;
    found->isotropic = d->isotropic_count;
    memcpy(found->stage_ms, stage_ms, sizeof found->stage_ms);
    return ASJ_OK;
}

static asj_status detect(asj_context *context, const asj_image *image, const asj_detect_options *options, double start,
                         asj_detection **result)
{
    asj_detect_options defaults;
    asj_detection_run d;
    double stage_ms[16] = {0}, clock = start;
    asj_status status = begin(context, image, &options, &defaults, result, &d);
    if (status == ASJ_OK)
        status = run_steps(&d, image, stage_ms, &clock);
    if (status == ASJ_OK)
        status = finish(&d, image, stage_ms, result);
    if (status == ASJ_OK) {
        stop_watch((*result)->stage_ms, ASJ_STAGE_DECOMPOSE, &clock);
        (*result)->total_ms = clock - start;
    }
    asj_stage_release(&d);
    return status;
}

asj_status asj_detect_into(asj_context *context, const asj_image *image, const asj_detect_options *options,
                           asj_detection **result)
{
    const double start = asj_clock_ms();
    asj_status status;
    if (result && *result)
        asj_result_clear(*result);
    if (!context)
        return ASJ_ERROR_ARGUMENT;
    asj_backend_begin(context);
    do
        status = detect(context, image, options, start, result);
    while (asj_backend_retry(context, status));
    return status;
}

asj_status asj_detect(asj_context *context, const asj_image *image, const asj_detect_options *options,
                      asj_detection **result)
{
    if (result)
        *result = NULL;
    return asj_detect_into(context, image, options, result);
}

static asj_local_branch local_branch(const asj_detection_run *d, asj_field_branch branch)
{
    const asj_sectors *s = &d->detector->field.sectors;
    asj_local_branch out = {0};
    if (!branch.strength)
        return out;
    const int32_t k = (int32_t)((branch.angle * (int64_t)s->count + 32768) / 65536) % s->count, n = s->size[k];
    const double strength = (double)branch.strength / ASJ_STRENGTH_ONE;
    const double sum = n * ASJ_GAMMA_MEAN + strength * ASJ_GAMMA_SD * sqrt(n);
    out.angle = (float)(branch.angle * (TWO_PI / 65536));
    out.strength = (float)strength;
    out.log10_nfa = (float)((log(s->count) + asj_nfa_log_sector_tail(asj_nfa_of(d->context), sum, n)) / log(10));
    return out;
}

/* Step 2 for row y of the public field. */
static void field_row(const asj_detection_run *d, int32_t y, asj_local_branch *out)
{
    enum { PART = 2 * ASJ_FIELD_BATCH };
    const asj_frame *frame = &d->detector->frame;
    asj_field_branch found[PART][ASJ_FIELD_BRANCHES];
    asj_pixel pixels[PART];
    for (int32_t first = 0; first < frame->width; first += PART) {
        const int32_t count = frame->width - first < PART ? frame->width - first : PART;
        for (int32_t i = 0; i < count; i++)
            pixels[i] = (asj_pixel){first + i, y};
        d->context->ops->field->pixels(&d->detector->field, frame, pixels, count, asj_stage_scratch(d), found);
        for (int32_t i = 0; i < count; i++)
            for (int b = 0; b < ASJ_FIELD_BRANCHES; b++)
                *out++ = local_branch(d, found[i][b]);
    }
}

static asj_status local_field(asj_context *context, const asj_image *image, const asj_detect_options *options,
                              asj_local_branch *branches)
{
    asj_detect_options defaults;
    asj_detection_run d;
    asj_status status = begin(context, image, &options, &defaults, branches, &d);
    if (status == ASJ_OK)
        status = asj_stage_gradient(&d, image);
    for (int32_t top = 0; status == ASJ_OK && top < image->height; top += ASJ_ROW_GROUP) {
        const int32_t bottom = image->height - top < ASJ_ROW_GROUP ? image->height : top + ASJ_ROW_GROUP;
#ifdef _OPENMP
#pragma omp parallel for num_threads(d.threads) schedule(dynamic, 4)
#endif
        for (int32_t y = top; y < bottom; y++)
            field_row(&d, y, branches + (size_t)y * (size_t)image->width * ASJ_FIELD_BRANCHES);
        status = asj_progress(context, ASJ_STAGE_CANDIDATES, (double)bottom / image->height);
    }
    asj_stage_release(&d);
    return status;
}

asj_status asj_local_field(asj_context *context, const asj_image *image, const asj_detect_options *options,
                           asj_local_branch *branches)
{
    asj_status status;
    if (!context)
        return ASJ_ERROR_ARGUMENT;
    asj_backend_begin(context);
    do
        status = local_field(context, image, options, branches);
    while (asj_backend_retry(context, status));
    return status;
}

/* ---- preparation ---- */

/* The kernels of the device, if there is one. */
static asj_status build_kernels(asj_context *context)
{
    asj_status status;
    asj_backend_begin(context);
    do
        status = asj_backend_prepare(context);
    while (asj_backend_retry(context, status));
    return status;
}

/* Dark with a bright rectangle: every step of the detector has something to do. */
static void draw_test_picture(uint8_t *pixels, int32_t width, int32_t height)
{
    const size_t row = (size_t)width, left = row / 4;
    memset(pixels, 60, row * (size_t)height);
    for (int32_t y = height / 4; y < height / 2; y++)
        memset(pixels + (size_t)y * row + left, 200, row / 2 - left);
}

asj_status asj_prepare(asj_context *context, const asj_detect_options *options, int32_t width, int32_t height)
{
    const uint8_t pixel = 0;
    asj_image image = {&pixel, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    asj_detection *found = NULL;
    if (!context)
        return ASJ_ERROR_ARGUMENT;
    asj_status status = asj_image_check(context, &image);
    if (status == ASJ_OK)
        status = build_kernels(context);
    if (status != ASJ_OK)
        return status;
    uint8_t *pixels = asj_allocate(&context->memory, (size_t)width * (size_t)height, 1);
    if (!pixels)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a test picture of %d x %d", (int)width, (int)height);
    draw_test_picture(pixels, width, height);
    image.data = pixels;
    const asj_progress_callback progress = context->options.progress;
    const asj_dump_callback dump = context->options.dump;
    context->options.progress = NULL;
    context->options.dump = NULL;
    status = asj_detect(context, &image, options, &found);
    context->options.progress = progress;
    context->options.dump = dump;
    asj_detection_free(&found);
    asj_release(&context->memory, pixels);
    return status;
}
