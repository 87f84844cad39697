/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_local_field(): the very local junctions of step 2 at every pixel. */
#include "core/angle.h"
#include "core/backend.h"
#include "nfa.h"
#include "steps.h"

#include <math.h>

static asj_local_branch local_branch(const asj_detection_run *run, asj_field_branch branch)
{
    const asj_sectors *s = &run->field->sectors;
    asj_local_branch out = {0};
    if (!branch.strength)
        return out;
    const int32_t k = (int32_t)((branch.angle * (int64_t)s->count + 32768) / 65536) % s->count, n = s->size[k];
    const double strength = (double)branch.strength / ASJ_STRENGTH_ONE;
    const double sum = n * ASJ_GAMMA_MEAN + strength * ASJ_GAMMA_SD * sqrt(n);
    out.angle = (float)(branch.angle * (ASJ_TWO_PI / 65536));
    out.strength = (float)strength;
    out.log10_nfa = (float)((log(s->count) + asj_nfa_log_sector_tail(asj_nfa_of(run->context), sum, n)) / log(10));
    return out;
}

static void field_row(const asj_detection_run *run, int32_t y, uint16_t *scratch, asj_local_branch *out)
{
    enum { PART = 2 * ASJ_FIELD_BATCH };
    const asj_frame *frame = run->frame;
    asj_field_branch found[PART][ASJ_FIELD_BRANCHES];
    asj_pixel pixels[PART];
    for (int32_t first = 0; first < frame->width; first += PART) {
        const int32_t count = frame->width - first < PART ? frame->width - first : PART;
        for (int32_t i = 0; i < count; i++)
            pixels[i] = (asj_pixel){first + i, y};
        run->context->ops->field->pixels(run->field, frame, pixels, count, scratch, found);
        for (int32_t i = 0; i < count; i++)
            for (int b = 0; b < ASJ_FIELD_BRANCHES; b++)
                *out++ = local_branch(run, found[i][b]);
    }
}

typedef struct job {
    const asj_detection_run *run;
    int32_t top;
    asj_local_branch *branches;
} job;

static void do_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t y = j->top + part->first; y < j->top + part->end; y++)
        field_row(j->run, (int32_t)y, asj_thread_scratch(&j->run->scratch, part),
                  j->branches + (size_t)y * (size_t)j->run->frame->width * ASJ_FIELD_BRANCHES);
}

static asj_status field_rows(const asj_detection_run *run, asj_local_branch *branches)
{
    const int32_t height = run->frame->height;
    asj_status status = asj_detection_run_progress(run, ASJ_STAGE_GRADIENT, 0.05);
    for (int32_t top = 0; status == ASJ_OK && top < height; top += ASJ_ROW_GROUP) {
        const int32_t bottom = height - top < ASJ_ROW_GROUP ? height : top + ASJ_ROW_GROUP;
        const job j = {run, top, branches};
        asj_parallel(run->context, run->context->threads, bottom - top, 4, do_rows, &j);
        status = asj_detection_run_progress(run, ASJ_STAGE_CANDIDATES, (double)bottom / height);
    }
    return status;
}

static asj_status local_field(asj_context *context, const asj_image *image, const asj_detect_options *options,
                              asj_local_branch *branches)
{
    asj_detection_run run;
    asj_status status = asj_detection_run_begin(&run, context, image, options, branches);
    if (status == ASJ_OK)
        status = asj_step_load(&run);
    if (status == ASJ_OK)
        status = asj_step_gradient(&run);
    if (status == ASJ_OK)
        status = field_rows(&run, branches);
    asj_detection_run_end(&run);
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
