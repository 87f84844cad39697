/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3 over an image: every candidate is tested, and of those that pass the ones close to something better go. */
#include "isotropic_thin.h"
#include "steps.h"

#define ROWS (2 * ASJ_ROW_GROUP) /* in a group: more make threads wait less for each other, and take more memory */

/* asj_isotropic_junction: those that passed, of all groups, and behind them one for each candidate of the group that is tested. */
typedef struct list {
    void *junctions;
    size_t capacity;
} list;

/* starts[y - top]: candidates of the group before row y. */
static void count_candidates(const asj_detection_run *run, int32_t top, int32_t bottom, size_t *starts)
{
    const int32_t blocks = run->frame->blocks;
    starts[0] = 0;
    for (int32_t y = top; y < bottom; y++)
        starts[y - top + 1] = starts[y - top] + asj_candidates_count(run->candidates + (ptrdiff_t)y * blocks, (size_t)blocks);
}

static asj_status test_group(asj_detection_run *run, int32_t top, int32_t bottom, list *l)
{
    asj_context *context = run->context;
    size_t starts[ROWS + 1];
    count_candidates(run, top, bottom, starts);
    run->candidate_count += starts[bottom - top];
    const asj_candidate_rows rows = {top, bottom, run->candidates, starts};
    const size_t total = starts[bottom - top], most = run->isotropic_count + total, size = sizeof(asj_isotropic_junction);
    asj_status status = asj_grow(&context->memory, &l->junctions, &l->capacity, asj_detection_run_room(most), size,
                                 run->isotropic_count);
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for %zu candidates", most);
    asj_isotropic_junction *found = l->junctions, *tested = found + run->isotropic_count;
    if (total > 0)
        status = context->ops->isotropic->rows(context, run->test, run->frame, &rows, &run->scratch, tested);
    if (status != ASJ_OK)
        return status;
    for (size_t i = 0; i < total; i++)
        if (asj_isotropic_persists(run->test, &tested[i]))
            found[run->isotropic_count++] = tested[i];
    return ASJ_OK;
}

static asj_status test_candidates(asj_detection_run *run)
{
    const int32_t height = run->frame->height;
    asj_status status = ASJ_OK;
    list l = {0};
    for (int32_t top = 0; top < height && status == ASJ_OK; top += ROWS) {
        const int32_t bottom = height - top < ROWS ? height : top + ROWS;
        status = test_group(run, top, bottom, &l);
        if (status == ASJ_OK)
            status = asj_detection_run_progress(run, ASJ_STAGE_ISOTROPIC, 0.5 + 0.2 * bottom / height);
    }
    run->isotropic = l.junctions;
    return status;
}

static asj_status thin(asj_detection_run *run)
{
    const asj_frame *frame = run->frame;
    const size_t bytes = asj_isotropic_thin_scratch(run->isotropic_count, frame->width, frame->height);
    void *scratch = asj_allocate(&run->context->memory, bytes, 1);
    if (!scratch)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to order %zu junctions", run->isotropic_count);
    run->isotropic_count = asj_isotropic_thin(run->isotropic, run->isotropic_count, run->options, frame->width, frame->height,
                                              scratch);
    asj_release(&run->context->memory, scratch);
    return ASJ_OK;
}

static asj_status dump(const asj_detection_run *run)
{
    int32_t *points = asj_allocate_list(&run->context->memory, run->isotropic_count, 2 * sizeof *points);
    if (!points)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to dump %zu points", run->isotropic_count);
    for (size_t i = 0; i < run->isotropic_count; i++) {
        points[2 * i] = run->isotropic[i].x;
        points[2 * i + 1] = run->isotropic[i].y;
    }
    asj_detection_run_dump_points(run, ASJ_STAGE_ISOTROPIC, "isotropic", run->isotropic_count, points);
    asj_release(&run->context->memory, points);
    return ASJ_OK;
}

asj_status asj_step_isotropic(asj_detection_run *run)
{
    asj_status status = test_candidates(run);
    if (status == ASJ_OK)
        status = thin(run);
    return status == ASJ_OK && run->context->options.dump ? dump(run) : status;
}
