/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_local_field(): the very local junctions of step 2 at every pixel of the image itself, no other octave. */
#include "core/angle.h"
#include "core/backend.h"
#include "core/decade.h"
#include "nfa.h"
#include "steps.h"

#include <math.h>

#define MOST_PIXELS ((size_t)1 << 20) /* at once, .. */
#define LEAST_ROWS 8                   /* .. in rows of any width */

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
    out.log10_nfa = (float)((log(s->count) + asj_nfa_log_sector_tail(asj_nfa_tables(), sum, n)) / ASJ_LN_10);
    return out;
}

typedef struct job {
    const asj_detection_run *run;
    asj_field_branch (*found)[ASJ_FIELD_BRANCHES]; /* of a group of rows */
    asj_local_branch *branches;
} job;

static void tell_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    const int64_t width = j->run->frame->width;
    for (int64_t i = part->first * width; i < part->end * width; i++)
        for (int b = 0; b < ASJ_FIELD_BRANCHES; b++)
            j->branches[i * ASJ_FIELD_BRANCHES + b] = local_branch(j->run, j->found[i][b]);
}

static asj_status field_rows(const asj_detection_run *run, asj_local_branch *branches)
{
    asj_context *context = run->context;
    const asj_frame *frame = run->frame;
    const int32_t height = frame->height;
    const size_t row = (size_t)frame->width;
    int32_t group = ASJ_ROW_GROUP; /* rows */
    while (group > LEAST_ROWS && (size_t)group * row > MOST_PIXELS)
        group /= 2;
    const int32_t most = height < group ? height : group;
    asj_field_branch (*found)[ASJ_FIELD_BRANCHES] = asj_allocate(&context->memory, (size_t)most * row, sizeof *found);
    if (!found)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the local junctions of %zu pixels", (size_t)most * row);
    asj_status status = asj_detection_run_progress(run, ASJ_STAGE_GRADIENT, 0.05);
    for (int32_t top = 0; status == ASJ_OK && top < height; top += group) {
        const int32_t bottom = height - top < group ? height : top + group;
        status = context->ops->field->branches(context, run->field, frame, top, bottom, &run->scratch, found);
        if (status != ASJ_OK)
            break;
        const job j = {run, found, branches + (size_t)top * row * ASJ_FIELD_BRANCHES};
        asj_parallel(context, context->threads, bottom - top, 4, tell_rows, &j);
        status = asj_detection_run_progress(run, ASJ_STAGE_CANDIDATES, (double)bottom / height);
    }
    asj_release(&context->memory, found);
    return status;
}

static asj_status local_field(asj_context *context, const asj_image *image, const asj_detect_options *options,
                              asj_local_branch *branches)
{
    asj_detection_run run;
    asj_detect_options of_image;
    if (options) {
        of_image = *options;
        if (of_image.colours == 1) /* the field is that of the luma; other numbers are refused */
            of_image.colours = 0;
        if (of_image.first_octave == ASJ_FIRST_OCTAVE) /* no larger than the image */
            of_image.first_octave = 0;
    }
    asj_status status = asj_detection_run_begin(&run, context, image, options ? &of_image : NULL, branches);
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
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    asj_backend_begin(context);
    do
        status = local_field(context, image, options, branches);
    while (asj_backend_retry(context, status));
    return status;
}
