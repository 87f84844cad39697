/* SPDX-License-Identifier: BSD-2-Clause */
#include "stages.h"
#include "ends.h"
#include "gradient.h"
#include "refine.h"
#include "core/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#define LEAST_JUNCTIONS 4 /* for a thread: about 40 us */
#define LEAST_LIST 256    /* elements that there is room for, so that the next of a stream of pictures needs no more */

static void free_detector(asj_memory *memory, void *state)
{
    struct asj_detector *detector = state;
    asj_frame_free(memory, &detector->frame);
    asj_field_free(memory, &detector->field);
    asj_isotropic_free(memory, &detector->isotropic);
    asj_scan_cache_free(memory, &detector->scan_cache);
    asj_release(memory, detector);
}

static asj_status prepare_tables(asj_context *context, const asj_detect_options *options)
{
    struct asj_detector *detector = context->detector.state;
    if (!detector) {
        detector = asj_allocate_zero(&context->memory, 1, sizeof *detector);
        if (!detector)
            return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the detector");
        context->detector = (asj_kept){detector, free_detector};
    }
    if (detector->ready && memcmp(&detector->options, options, sizeof *options) == 0)
        return ASJ_OK;
    detector->ready = 0;
    detector->width = detector->height = 0;
    asj_field_free(&context->memory, &detector->field);
    asj_isotropic_free(&context->memory, &detector->isotropic);
    asj_status status = asj_field_create(context, options, &detector->field);
    if (status == ASJ_OK)
        status = asj_isotropic_create(context, options, &detector->isotropic);
    if (status != ASJ_OK)
        return status;
    asj_scan_prepare(context, options, &detector->field, 1, 1, &detector->scan);
    detector->options = *options;
    detector->ready = 1;
    return ASJ_OK;
}

asj_status asj_stage_prepare(asj_detection_run *d, int32_t width, int32_t height)
{
    asj_context *context = d->context;
    asj_status status = prepare_tables(context, d->options);
    if (status != ASJ_OK)
        return status;
    struct asj_detector *detector = d->detector = context->detector.state;
    status = asj_frame_prepare(context, &detector->frame, width, height);
    if (status != ASJ_OK)
        return status;
    if (width != detector->width || height != detector->height) {
        asj_isotropic_set_size(d->options, width, height, &detector->isotropic);
        asj_scan_set_size(context, d->options, width, height, &detector->scan);
        detector->width = width;
        detector->height = height;
    }
    status = asj_scan_cache_prepare(context, &detector->frame, context->threads, &detector->scan_cache);
    if (status != ASJ_OK)
        return status;
    detector->scan.cache = &detector->scan_cache;
    d->scratch_size = asj_field_scratch(&detector->field);
    if (detector->isotropic.scratch > d->scratch_size)
        d->scratch_size = detector->isotropic.scratch;
    d->scratch = asj_allocate(&context->memory, (size_t)d->threads * d->scratch_size, sizeof *d->scratch);
    if (!d->scratch)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %d threads", (int)d->threads);
    return ASJ_OK;
}

void asj_stage_release(asj_detection_run *d)
{
    asj_memory *memory = &d->context->memory;
    asj_release(memory, d->scratch);
    asj_release(memory, d->candidates);
    asj_release(memory, d->isotropic);
    asj_release(memory, d->drafts);
}

uint16_t *asj_stage_scratch(const asj_detection_run *d)
{
#ifdef _OPENMP
    return d->scratch + (size_t)omp_get_thread_num() * d->scratch_size;
#else
    return d->scratch;
#endif
}

static void dump_plane(const asj_detection_run *d, int32_t kind, const char *name, const void *data, double unit)
{
    const asj_frame *frame = &d->detector->frame;
    const asj_dump dump = {ASJ_STAGE_GRADIENT, kind, name, data, frame->width, frame->height, frame->stride, 0, unit};
    if (d->context->options.dump)
        d->context->options.dump(d->context->options.dump_user, &dump);
}

static void hand_out(const asj_detection_run *d, int32_t stage, const char *name, size_t count, const int32_t *points)
{
    const asj_frame *frame = &d->detector->frame;
    const asj_dump dump = {stage, ASJ_DUMP_POINTS, name, points, frame->width, frame->height, 0, count, 1};
    d->context->options.dump(d->context->options.dump_user, &dump);
}

/* Hands out `count` points, given one by one by `point`. Memory that cannot be had is an error like any other. */
static asj_status dump_points(const asj_detection_run *d, int32_t stage, const char *name, size_t count,
                              void (*point)(const asj_detection_run *d, size_t i, int32_t *xy))
{
    if (!d->context->options.dump)
        return ASJ_OK;
    int32_t *points = asj_allocate_list(&d->context->memory, count, 2 * sizeof *points);
    if (!points)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory to dump %zu points", count);
    for (size_t i = 0; i < count; i++)
        point(d, i, points + 2 * i);
    hand_out(d, stage, name, count, points);
    asj_release(&d->context->memory, points);
    return ASJ_OK;
}

static void isotropic_point(const asj_detection_run *d, size_t i, int32_t *xy)
{
    xy[0] = d->isotropic[i].x;
    xy[1] = d->isotropic[i].y;
}

static void draft_point(const asj_detection_run *d, size_t i, int32_t *xy)
{
    xy[0] = (int32_t)lrint(d->drafts[i].x);
    xy[1] = (int32_t)lrint(d->drafts[i].y);
}

/* Step 1. */
asj_status asj_stage_gradient(asj_detection_run *d, const asj_image *image)
{
    asj_frame *frame = &d->detector->frame;
    asj_status status = asj_frame_load(d->context, frame, image);
    if (status == ASJ_OK)
        status = d->context->ops->gradient->planes(d->context, frame, d->options);
    if (status != ASJ_OK)
        return status;
    dump_plane(d, ASJ_DUMP_PLANE_U16, "gray", frame->gray, 1.0 / ASJ_GRAY_ONE);
    dump_plane(d, ASJ_DUMP_PLANE_I16, "gradient_x", frame->gradient_x, 1.0 / ASJ_GRADIENT_ONE);
    dump_plane(d, ASJ_DUMP_PLANE_I16, "gradient_y", frame->gradient_y, 1.0 / ASJ_GRADIENT_ONE);
    return asj_progress(d->context, ASJ_STAGE_GRADIENT, 0.05);
}

static size_t count_bits(const uint16_t *masks, size_t count)
{
    size_t bits = 0;
    for (size_t i = 0; i < count; i++)
        for (uint32_t mask = masks[i]; mask; mask &= mask - 1)
            bits++;
    return bits;
}

static asj_status dump_candidates(const asj_detection_run *d)
{
    const asj_frame *frame = &d->detector->frame;
    const size_t runs = (size_t)frame->blocks * (size_t)frame->height;
    if (!d->context->options.dump)
        return ASJ_OK;
    const size_t total = count_bits(d->candidates, runs);
    int32_t *points = asj_allocate_list(&d->context->memory, total, 2 * sizeof *points), *next = points;
    if (!points)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory to dump %zu points", total);
    for (size_t i = 0; i < runs; i++)
        for (int32_t bit = 0; bit < ASJ_LANES; bit++)
            if (d->candidates[i] >> bit & 1) {
                *next++ = (int32_t)(i % (size_t)frame->blocks) * ASJ_LANES + bit;
                *next++ = (int32_t)(i / (size_t)frame->blocks);
            }
    hand_out(d, ASJ_STAGE_CANDIDATES, "candidates", total, points);
    asj_release(&d->context->memory, points);
    return ASJ_OK;
}

/* Step 2: candidates, one bit for each pixel. */
asj_status asj_stage_candidates(asj_detection_run *d)
{
    const asj_frame *frame = &d->detector->frame;
    const int32_t blocks = frame->blocks, height = frame->height;
    d->candidates = asj_allocate(&d->context->memory, (size_t)blocks * (size_t)height, sizeof *d->candidates);
    if (!d->candidates)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for the candidates");
    for (int32_t top = 0; top < height; top += ASJ_ROW_GROUP) {
        const int32_t bottom = height - top < ASJ_ROW_GROUP ? height : top + ASJ_ROW_GROUP;
        asj_status status = d->context->ops->field->rows(d->context, &d->detector->field, frame, top, bottom, d->scratch,
                                                        d->scratch_size, d->candidates);
        if (status == ASJ_OK)
            status = asj_progress(d->context, ASJ_STAGE_CANDIDATES, 0.05 + 0.45 * bottom / height);
        if (status != ASJ_OK)
            return status;
    }
    return dump_candidates(d);
}

static size_t at_least(size_t count)
{
    return count > LEAST_LIST ? count : LEAST_LIST;
}

/* Tests all candidates, group by group; what passes is collected in d->isotropic. */
static asj_status test_candidates(asj_detection_run *d)
{
    asj_memory *memory = &d->context->memory;
    const asj_frame *frame = &d->detector->frame;
    void *records = NULL, *found = NULL;
    size_t record_capacity = 0, found_capacity = 0, starts[ASJ_ROW_GROUP + 1];
    asj_status status = ASJ_OK;
    for (int32_t top = 0; top < frame->height && status == ASJ_OK; top += ASJ_ROW_GROUP) {
        const int32_t bottom = frame->height - top < ASJ_ROW_GROUP ? frame->height : top + ASJ_ROW_GROUP;
        starts[0] = 0;
        for (int32_t y = top; y < bottom; y++)
            starts[y - top + 1] = starts[y - top] + count_bits(d->candidates + (ptrdiff_t)y * frame->blocks, (size_t)frame->blocks);
        const size_t total = starts[bottom - top];
        d->candidate_total += total;
        status = asj_grow(memory, &records, &record_capacity, at_least(total), sizeof(asj_isotropic_junction), 0);
        if (status == ASJ_OK)
            status = asj_grow(memory, &found, &found_capacity, at_least(d->isotropic_count + total), sizeof(asj_isotropic_junction),
                              d->isotropic_count);
        if (status != ASJ_OK) {
            asj_fail(d->context, status, "no memory for %zu candidates", d->isotropic_count + total);
            break;
        }
        if (total > 0)
            status = d->context->ops->isotropic->rows(d->context, &d->detector->isotropic, frame, top, bottom, d->candidates,
                                                      starts, d->scratch, d->scratch_size, records);
        if (status != ASJ_OK)
            break;
        const asj_isotropic_junction *tested = records;
        for (size_t i = 0; i < total; i++)
            if (tested[i].branch_count)
                ((asj_isotropic_junction *)found)[d->isotropic_count++] = tested[i];
        status = asj_progress(d->context, ASJ_STAGE_ISOTROPIC, 0.5 + 0.2 * bottom / frame->height);
    }
    asj_release(memory, records);
    d->isotropic = found;
    return status;
}

static asj_status thin(asj_detection_run *d)
{
    const asj_frame *frame = &d->detector->frame;
    const size_t bytes = asj_isotropic_thin_scratch(d->isotropic_count, frame->width, frame->height);
    void *scratch = asj_allocate(&d->context->memory, bytes, 1);
    if (!scratch)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory to order %zu junctions", d->isotropic_count);
    d->isotropic_count = asj_isotropic_thin(d->isotropic, d->isotropic_count, d->options, frame->width, frame->height, scratch);
    asj_release(&d->context->memory, scratch);
    return dump_points(d, ASJ_STAGE_ISOTROPIC, "isotropic", d->isotropic_count, isotropic_point);
}

/* Step 3: isotropic junctions. */
asj_status asj_stage_isotropic(asj_detection_run *d)
{
    asj_status status = test_candidates(d);
    return status == ASJ_OK ? thin(d) : status;
}

static asj_status suppress(asj_detection_run *d, int same)
{
    const asj_frame *frame = &d->detector->frame;
    const size_t count = asj_locate_cells(d->draft_count, frame->width, frame->height);
    int32_t *cells = asj_allocate_list(&d->context->memory, count, sizeof *cells);
    if (!cells)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    d->draft_count = asj_locate_suppress(d->drafts, d->draft_count, same, frame->width, frame->height, cells);
    asj_release(&d->context->memory, cells);
    return ASJ_OK;
}

/* Between 3 and 4: locations. */
asj_status asj_stage_locate(asj_detection_run *d)
{
    d->drafts = asj_allocate_list(&d->context->memory, at_least(d->isotropic_count), sizeof *d->drafts);
    if (!d->drafts)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", d->isotropic_count);
    for (size_t i = 0; i < d->isotropic_count; i++)
        if (asj_locate_worthwhile(d->options, &d->isotropic[i]))
            asj_locate_start(&d->isotropic[i], &d->drafts[d->draft_count++]);
    const int64_t count = (int64_t)d->draft_count;
    int32_t threads = asj_threads_for(d->context, count, 4 * LEAST_JUNCTIONS); /* a quick look each */
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(dynamic, 16)
#else
    (void)threads;
#endif
    for (int64_t i = 0; i < count; i++)
        asj_locate_guess(d->context, &d->detector->frame, d->options, &d->drafts[i]);
    asj_status status = suppress(d, 1);
    if (status != ASJ_OK)
        return status;
    const int64_t left = (int64_t)d->draft_count;
    threads = asj_threads_for(d->context, left, LEAST_JUNCTIONS);
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(dynamic, 8)
#else
    (void)threads;
#endif
    for (int64_t i = 0; i < left; i++) {
        asj_locate(d->context, &d->detector->frame, d->options, &d->drafts[i]);
        asj_foresee(d->context, &d->detector->frame, d->options, &d->drafts[i]);
    }
    status = suppress(d, 0);
    return status == ASJ_OK ? dump_points(d, ASJ_STAGE_LOCATE, "located", d->draft_count, draft_point) : status;
}

#define STRIP 64         /* px */
#define SCANNED_AGAIN 16 /* px: the last part of a branch, which a better angle may change */

/* Whether a branch has no length yet, or has turned or moved away by more than a pixel somewhere along the ray that gave
 * it. */
static int needs_scan(const asj_draft *draft, const asj_draft_branch *branch)
{
    const double turned = asj_angle_distance(branch->angle, branch->scanned[2]) * branch->length;
    return branch->length <= 0 || turned + hypot(draft->x - branch->scanned[0], draft->y - branch->scanned[1]) > 1;
}

static void set_length(const asj_detection_run *d, const asj_ray *ray, asj_draft_branch *branch)
{
    const double length = d->options->scan_axial ? 0.5 * (ray->forward + ray->axial) : ray->forward;
    /* a ray that starts at the isotropic scale is as long as that already */
    branch->length = d->options->scan_start == 0 && length < ray->start ? ray->start : length;
    branch->scanned[0] = ray->x;
    branch->scanned[1] = ray->y;
    branch->scanned[2] = ray->angle;
}

/* One ray for each branch that needs it: from the junction on, or over the last part of a branch whose length is known. */
static size_t list_rays(const asj_detection_run *d, asj_ray *rays, asj_draft_branch **branches)
{
    size_t count = 0;
    for (size_t i = 0; i < d->draft_count; i++) {
        asj_draft *draft = &d->drafts[i];
        const int32_t start = d->options->scan_start;
        for (int32_t b = 0; b < draft->branch_count; b++) {
            asj_draft_branch *branch = &draft->branches[b];
            const int32_t again = start > 0 ? (int32_t)branch->length - SCANNED_AGAIN : 0;
            if (!needs_scan(draft, branch))
                continue;
            branches[count] = branch;
            const int32_t first = again > start ? again : start > 0 ? start : (int32_t)draft->radius;
            rays[count++] = (asj_ray){draft->x, draft->y, branch->angle, first, 0, 0};
        }
    }
    return count;
}

/* From top to bottom in strips, in a strip from left to right: rays that follow each other then need the same local junctions. */
static int by_strip(const void *a, const void *b)
{
    const asj_draft *p = a, *q = b;
    const int32_t row = (int32_t)p->y / STRIP, other = (int32_t)q->y / STRIP;
    if (row != other)
        return row < other ? -1 : 1;
    return p->x != q->x ? p->x < q->x ? -1 : 1 : (p->y > q->y) - (p->y < q->y);
}

static asj_status scan_rays(asj_detection_run *d, asj_ray *rays, size_t count)
{
    return d->context->ops->scan->rays(d->context, &d->detector->scan, &d->detector->frame, rays, count);
}

static asj_status scan_branches(asj_detection_run *d, asj_ray *rays, asj_draft_branch **branches)
{
    if (d->draft_count > 1)
        qsort(d->drafts, d->draft_count, sizeof *d->drafts, by_strip);
    const size_t count = list_rays(d, rays, branches);
    size_t left = 0;
    asj_status status = scan_rays(d, rays, count);
    for (size_t i = 0; i < count && status == ASJ_OK; i++) {
        if (d->options->scan_start <= 0 || rays[i].start == d->options->scan_start ||
            (rays[i].forward > 0 && (rays[i].axial > 0 || !d->options->scan_axial))) {
            set_length(d, &rays[i], branches[i]);
        } else { /* it ends before the last part */
            branches[left] = branches[i];
            rays[left] = rays[i];
            rays[left++].start = d->options->scan_start;
        }
    }
    if (left > 0 && status == ASJ_OK)
        status = scan_rays(d, rays, left);
    for (size_t i = 0; i < left && status == ASJ_OK; i++)
        set_length(d, &rays[i], branches[i]);
    return status;
}

/* Step 4: branch lengths, where they are not known or no longer hold. */
asj_status asj_stage_scan(asj_detection_run *d)
{
    size_t total = 0;
    for (size_t i = 0; i < d->draft_count; i++)
        total += (size_t)d->drafts[i].branch_count;
    asj_ray *rays = asj_allocate_list(&d->context->memory, at_least(total), sizeof *rays);
    asj_draft_branch **branches = asj_allocate_list(&d->context->memory, at_least(total), sizeof *branches);
    asj_status status = ASJ_OK;
    if (rays && branches)
        status = scan_branches(d, rays, branches);
    else
        status = asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for %zu rays", total);
    asj_release(&d->context->memory, branches);
    asj_release(&d->context->memory, rays);
    return status;
}

/* Step 5: orientation. */
asj_status asj_stage_orient(asj_detection_run *d)
{
    const int64_t count = (int64_t)d->draft_count;
    const int32_t threads = asj_threads_for(d->context, count, LEAST_JUNCTIONS);
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(dynamic, 8)
#else
    (void)threads;
#endif
    for (int64_t i = 0; i < count; i++)
        asj_orient(d->context, &d->detector->frame, d->options, &d->drafts[i]);
    return ASJ_OK;
}

static asj_status snap_ends(asj_detection_run *d)
{
    const asj_draft **order = asj_allocate_list(&d->context->memory, at_least(d->draft_count), sizeof *order);
    if (!order)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", d->draft_count);
    asj_ends_snap(d->drafts, d->draft_count, d->options->snap_distance, order);
    asj_release(&d->context->memory, order);
    return ASJ_OK;
}

/* Step 5, last time, and validation. */
asj_status asj_stage_validate(asj_detection_run *d)
{
    const int64_t count = (int64_t)d->draft_count;
    const int32_t threads = asj_threads_for(d->context, count, LEAST_JUNCTIONS);
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(dynamic, 8)
#else
    (void)threads;
#endif
    for (int64_t i = 0; i < count; i++) {
        asj_refine(d->context, &d->detector->frame, d->options, &d->drafts[i]);
        asj_validate(d->context, &d->detector->frame, d->options, &d->drafts[i]);
    }
    asj_status status = suppress(d, 0);
    if (status == ASJ_OK)
        status = snap_ends(d);
    return status == ASJ_OK ? dump_points(d, ASJ_STAGE_REFINE, "junctions", d->draft_count, draft_point) : status;
}
