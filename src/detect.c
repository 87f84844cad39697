/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_detect(): the paper's steps in order. */
#include "detect.h"
#include "gradient.h"
#include "isotropic.h"
#include "locate.h"
#include "options.h"
#include "refine.h"
#include "result.h"
#include "scan.h"

#include <math.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#define TWO_PI 6.283185307179586

struct asj_detector {
    asj_frame frame;
    asj_detect_options options; /* the tables below were made for these */
    int ready;
    asj_field field;
    asj_isotropic isotropic;
    asj_scan scan;
};

/* What one call of asj_detect() passes from step to step. */
typedef struct detection {
    asj_context *context;
    asj_detector *detector;
    const asj_detect_options *options;
    int32_t threads;
    uint16_t *scratch;           /* `scratch_size` elements for each thread */
    size_t scratch_size;
    uint16_t *candidates;        /* one bit for each pixel: run b of row y at [y * blocks + b] */
    asj_isotropic_junction *isotropic;
    size_t isotropic_count;
    asj_draft *drafts;
    size_t draft_count;
    uint64_t candidate_total;
} detection;

void asj_detector_free(asj_memory *memory, asj_detector **pointer)
{
    asj_detector *detector = *pointer;
    if (!detector)
        return;
    asj_frame_free(memory, &detector->frame);
    asj_field_free(memory, &detector->field);
    asj_isotropic_free(memory, &detector->isotropic);
    asj_release(memory, detector);
    *pointer = NULL;
}

static asj_status prepare_tables(asj_context *context, const asj_detect_options *options)
{
    asj_detector *detector = context->detector;
    if (!detector) {
        detector = asj_allocate_zero(&context->memory, 1, sizeof *detector);
        if (!detector)
            return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the detector");
        context->detector = detector;
    }
    if (detector->ready && memcmp(&detector->options, options, sizeof *options) == 0)
        return ASJ_OK;
    detector->ready = 0;
    asj_field_free(&context->memory, &detector->field);
    asj_isotropic_free(&context->memory, &detector->isotropic);
    asj_status status = asj_field_create(context, options, &detector->field);
    if (status == ASJ_OK)
        status = asj_isotropic_create(context, options, &detector->isotropic);
    if (status != ASJ_OK)
        return status;
    detector->options = *options;
    detector->ready = 1;
    return ASJ_OK;
}

static asj_status prepare(detection *d, const asj_image *image)
{
    asj_context *context = d->context;
    asj_status status = prepare_tables(context, d->options);
    if (status == ASJ_OK)
        status = asj_frame_prepare(context, &context->detector->frame, image->width, image->height);
    if (status != ASJ_OK)
        return status;
    asj_detector *detector = d->detector = context->detector;
    asj_isotropic_set_size(d->options, image->width, image->height, &detector->isotropic);
    asj_scan_prepare(context, d->options, &detector->field, image->width, image->height, &detector->scan);
    d->scratch_size = asj_field_scratch(&detector->field);
    if (detector->isotropic.scratch > d->scratch_size)
        d->scratch_size = detector->isotropic.scratch;
    d->scratch = asj_allocate(&context->memory, (size_t)d->threads * d->scratch_size, sizeof *d->scratch);
    if (!d->scratch)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %d threads", (int)d->threads);
    return ASJ_OK;
}

static uint16_t *thread_scratch(const detection *d)
{
#ifdef _OPENMP
    return d->scratch + (size_t)omp_get_thread_num() * d->scratch_size;
#else
    return d->scratch;
#endif
}

/* Rows are worked on in groups, between which progress is reported. */
#define GROUP 128

/* Step 2: candidates, one bit for each pixel. */
static asj_status find_candidates(detection *d)
{
    const asj_frame *frame = &d->detector->frame;
    const int32_t blocks = frame->blocks, height = frame->height;
    d->candidates = asj_allocate(&d->context->memory, (size_t)blocks * (size_t)height, sizeof *d->candidates);
    if (!d->candidates)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for the candidates");
    for (int32_t top = 0; top < height; top += GROUP) {
        const int32_t bottom = height - top < GROUP ? height : top + GROUP;
#ifdef _OPENMP
#pragma omp parallel for num_threads(d->threads) schedule(dynamic, 4)
#endif
        for (int32_t y = top; y < bottom; y++) {
            uint16_t *row = d->candidates + (ptrdiff_t)y * blocks;
            for (int32_t b = 0; b < blocks; b++) {
                uint32_t mask = asj_field_candidates(&d->detector->field, frame, b * ASJ_LANES, y, thread_scratch(d));
                int32_t valid = frame->width - b * ASJ_LANES;
                row[b] = (uint16_t)(valid < ASJ_LANES ? mask & ((1u << valid) - 1) : mask);
            }
        }
        asj_status status = asj_progress(d->context, ASJ_STAGE_CANDIDATES, 0.05 + 0.45 * bottom / height);
        if (status != ASJ_OK)
            return status;
    }
    return ASJ_OK;
}

static size_t count_bits(const uint16_t *masks, size_t count)
{
    size_t bits = 0;
    for (size_t i = 0; i < count; i++)
        for (uint32_t mask = masks[i]; mask; mask &= mask - 1)
            bits++;
    return bits;
}

/* Step 3 for rows top .. bottom - 1, whose candidates have room in `records`: row y from record starts[y - top] on. */
static void test_rows(const detection *d, int32_t top, int32_t bottom, const size_t *starts, asj_isotropic_junction *records)
{
    const asj_frame *frame = &d->detector->frame;
#ifdef _OPENMP
#pragma omp parallel for num_threads(d->threads) schedule(dynamic, 4)
#endif
    for (int32_t y = top; y < bottom; y++) {
        const uint16_t *row = d->candidates + (ptrdiff_t)y * frame->blocks;
        asj_isotropic_junction *next = records + starts[y - top];
        for (int32_t b = 0; b < frame->blocks; b++) {
            if (!row[b])
                continue;
            asj_isotropic_block(&d->detector->isotropic, frame, b * ASJ_LANES, y, row[b], thread_scratch(d), next);
            next += count_bits(&row[b], 1);
        }
    }
}

/* Step 3: isotropic junctions at the candidates. */
static asj_status test_candidates(detection *d)
{
    asj_memory *memory = &d->context->memory;
    const asj_frame *frame = &d->detector->frame;
    void *records = NULL, *found = NULL;
    size_t record_capacity = 0, found_capacity = 0, starts[GROUP + 1];
    asj_status status = ASJ_OK;
    for (int32_t top = 0; top < frame->height && status == ASJ_OK; top += GROUP) {
        const int32_t bottom = frame->height - top < GROUP ? frame->height : top + GROUP;
        starts[0] = 0;
        for (int32_t y = top; y < bottom; y++)
            starts[y - top + 1] = starts[y - top] + count_bits(d->candidates + (ptrdiff_t)y * frame->blocks, (size_t)frame->blocks);
        const size_t total = starts[bottom - top];
        d->candidate_total += total;
        status = asj_grow(memory, &records, &record_capacity, total, sizeof(asj_isotropic_junction), 0);
        if (status == ASJ_OK)
            status = asj_grow(memory, &found, &found_capacity, d->isotropic_count + total, sizeof(asj_isotropic_junction),
                              d->isotropic_count);
        if (status != ASJ_OK) {
            asj_fail(d->context, status, "no memory for %zu candidates", d->isotropic_count + total);
            break;
        }
        test_rows(d, top, bottom, starts, records);
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

static asj_status thin(detection *d)
{
    const asj_frame *frame = &d->detector->frame;
    const size_t bytes = ((size_t)frame->width + 7) / 8 * (size_t)frame->height;
    uint8_t *taken = asj_allocate_zero(&d->context->memory, bytes, 1);
    if (!taken)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for a map of %zu bytes", bytes);
    d->isotropic_count = asj_isotropic_thin(d->isotropic, d->isotropic_count, d->options, frame->width, frame->height, taken);
    asj_release(&d->context->memory, taken);
    return ASJ_OK;
}

static asj_status suppress(detection *d)
{
    const asj_frame *frame = &d->detector->frame;
    const size_t count = asj_locate_cells(d->draft_count, frame->width, frame->height);
    int32_t *cells = asj_allocate(&d->context->memory, count, sizeof *cells);
    if (!cells)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    d->draft_count = asj_locate_suppress(d->drafts, d->draft_count, frame->width, frame->height, cells);
    asj_release(&d->context->memory, cells);
    return ASJ_OK;
}

/* Between 3 and 4: locations. */
static asj_status locate(detection *d)
{
    const int64_t count = (int64_t)d->isotropic_count;
    d->drafts = asj_allocate(&d->context->memory, d->isotropic_count, sizeof *d->drafts);
    if (!d->drafts)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", d->isotropic_count);
#ifdef _OPENMP
#pragma omp parallel for num_threads(d->threads) schedule(dynamic, 16)
#endif
    for (int64_t i = 0; i < count; i++) {
        asj_locate_start(&d->isotropic[i], &d->drafts[i]);
        asj_locate(&d->detector->frame, d->options, &d->drafts[i]);
    }
    d->draft_count = d->isotropic_count;
    return suppress(d);
}

/* Whether a branch has no length yet, or has turned or moved away by more than half a pixel somewhere along the ray that gave it. */
static int needs_scan(const asj_draft *draft, const asj_draft_branch *branch)
{
    const double turned = asj_angle_distance(branch->angle, branch->scanned[2]) * branch->length;
    return branch->length <= 0 || turned + hypot(draft->x - branch->scanned[0], draft->y - branch->scanned[1]) > 0.5;
}

static void set_length(const detection *d, const asj_ray *ray, asj_draft_branch *branch)
{
    const double length = d->options->scan_axial ? 0.5 * (ray->forward + ray->axial) : ray->forward;
    /* a ray that starts at the isotropic scale is as long as that already */
    branch->length = d->options->scan_start == 0 && length < ray->start ? ray->start : length;
    branch->scanned[0] = ray->x;
    branch->scanned[1] = ray->y;
    branch->scanned[2] = ray->angle;
}

/* Step 4: branch lengths, where they are not known or no longer hold. */
static asj_status scan(detection *d)
{
    size_t count = 0, total = 0;
    for (size_t i = 0; i < d->draft_count; i++)
        total += (size_t)d->drafts[i].branch_count;
    asj_ray *rays = asj_allocate(&d->context->memory, total, sizeof *rays);
    asj_draft_branch **branches = asj_allocate(&d->context->memory, total, sizeof *branches);
    asj_status status = ASJ_OK;
    if (rays && branches) {
        for (size_t i = 0; i < d->draft_count; i++) {
            asj_draft *draft = &d->drafts[i];
            const int32_t start = d->options->scan_start > 0 ? d->options->scan_start : (int32_t)draft->radius;
            for (int32_t b = 0; b < draft->branch_count; b++)
                if (needs_scan(draft, &draft->branches[b])) {
                    branches[count] = &draft->branches[b];
                    rays[count++] = (asj_ray){draft->x, draft->y, draft->branches[b].angle, start, 0, 0};
                }
        }
        status = asj_scan_rays(d->context, &d->detector->scan, &d->detector->frame, rays, count);
        for (size_t i = 0; i < count && status == ASJ_OK; i++)
            set_length(d, &rays[i], branches[i]);
    } else {
        status = asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for %zu rays", total);
    }
    asj_release(&d->context->memory, branches);
    asj_release(&d->context->memory, rays);
    return status;
}

static asj_status orient(detection *d)
{
    const int64_t count = (int64_t)d->draft_count;
#ifdef _OPENMP
#pragma omp parallel for num_threads(d->threads) schedule(dynamic, 8)
#endif
    for (int64_t i = 0; i < count; i++)
        asj_refine(d->context, &d->detector->frame, d->options, &d->drafts[i]);
    return ASJ_OK;
}

/* Step 5: orientation, location, validation. */
static asj_status refine(detection *d)
{
    const int64_t count = (int64_t)d->draft_count;
#ifdef _OPENMP
#pragma omp parallel for num_threads(d->threads) schedule(dynamic, 8)
#endif
    for (int64_t i = 0; i < count; i++) {
        asj_refine(d->context, &d->detector->frame, d->options, &d->drafts[i]);
        asj_validate(d->context, &d->detector->frame, d->options, &d->drafts[i]);
    }
    return suppress(d);
}

static void dump_plane(const detection *d, int32_t kind, const char *name, const void *data, double unit)
{
    const asj_frame *frame = &d->detector->frame;
    const asj_dump dump = {ASJ_STAGE_GRADIENT, kind, name, data, frame->width, frame->height, frame->stride, 0, unit};
    if (d->context->options.dump)
        d->context->options.dump(d->context->options.dump_user, &dump);
}

static asj_status load_and_normalise(detection *d, const asj_image *image)
{
    asj_frame *frame = &d->detector->frame;
    asj_status status = asj_frame_load(d->context, frame, image);
    if (status == ASJ_OK)
        status = asj_gradient(d->context, frame, d->options);
    if (status != ASJ_OK)
        return status;
    dump_plane(d, ASJ_DUMP_PLANE_U16, "gray", frame->gray, 1.0 / ASJ_GRAY_ONE);
    dump_plane(d, ASJ_DUMP_PLANE_I16, "gradient_x", frame->gradient_x, 1.0 / ASJ_GRADIENT_ONE);
    dump_plane(d, ASJ_DUMP_PLANE_I16, "gradient_y", frame->gradient_y, 1.0 / ASJ_GRADIENT_ONE);
    return asj_progress(d->context, ASJ_STAGE_GRADIENT, 0.05);
}

static void release(detection *d)
{
    asj_memory *memory = &d->context->memory;
    asj_release(memory, d->scratch);
    asj_release(memory, d->candidates);
    asj_release(memory, d->isotropic);
    asj_release(memory, d->drafts);
}

/* The stage's time is what has passed since *start. */
static void stop_watch(double *stage_ms, int32_t stage, double *start)
{
    double now = asj_clock_ms();
    stage_ms[stage] += now - *start;
    *start = now;
}

static asj_status run_steps(detection *d, const asj_image *image, double *stage_ms, double *clock)
{
    static const struct {
        int32_t stage;
        asj_status (*run)(detection *d);
        double done;
    } steps[] = {
        {ASJ_STAGE_CANDIDATES, find_candidates, 0.50}, {ASJ_STAGE_ISOTROPIC, test_candidates, 0.70},
        {ASJ_STAGE_ISOTROPIC, thin, 0.70},             {ASJ_STAGE_LOCATE, locate, 0.80},
        {ASJ_STAGE_SCAN, scan, 0.90},                  {ASJ_STAGE_REFINE, orient, 0.92},
        {ASJ_STAGE_SCAN, scan, 0.95},                  {ASJ_STAGE_REFINE, refine, 0.99},
    };
    asj_status status = load_and_normalise(d, image);
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
                        asj_detect_options *defaults, const void *output, detection *d)
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
    context->progress = 0;
    asj_status status = asj_image_check(context, image);
    return status == ASJ_OK ? prepare(d, image) : status;
}

static asj_status finish(detection *d, const asj_image *image, const double *stage_ms, asj_detection **result)
{
    asj_detection *found = asj_result_create(d->context, d->drafts, d->draft_count, d->options->minimum_opening);
    if (!found)
        return asj_fail(d->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", d->draft_count);
    found->width = image->width;
    found->height = image->height;
    found->backend = ASJ_BACKEND_CPU;
    found->candidates = d->candidate_total;
    found->isotropic = d->isotropic_count;
    memcpy(found->stage_ms, stage_ms, sizeof found->stage_ms);
    *result = found;
    return ASJ_OK;
}

asj_status asj_detect(asj_context *context, const asj_image *image, const asj_detect_options *options,
                      asj_detection **result)
{
    asj_detect_options defaults;
    detection d;
    double stage_ms[16] = {0}, start = asj_clock_ms(), clock = start;
    if (result)
        *result = NULL;
    asj_status status = begin(context, image, &options, &defaults, result, &d);
    if (status == ASJ_OK)
        status = run_steps(&d, image, stage_ms, &clock);
    if (status == ASJ_OK)
        status = finish(&d, image, stage_ms, result);
    if (status == ASJ_OK) {
        stop_watch((*result)->stage_ms, ASJ_STAGE_DECOMPOSE, &clock);
        (*result)->total_ms = clock - start;
    }
    if (context)
        release(&d);
    return status;
}

/* Step 2 for row y of the public field. */
static void field_row(const detection *d, int32_t y, asj_local_branch *out)
{
    const asj_frame *frame = &d->detector->frame;
    const asj_sectors *s = &d->detector->field.sectors;
    asj_field_branch found[ASJ_LANES][ASJ_FIELD_BRANCHES];
    for (int32_t x = 0; x < frame->width; x++) {
        if (x % ASJ_LANES == 0)
            asj_field_block(&d->detector->field, frame, x, y, thread_scratch(d), found);
        for (int i = 0; i < ASJ_FIELD_BRANCHES; i++) {
            const asj_field_branch branch = found[x % ASJ_LANES][i];
            asj_local_branch *to = &out[(size_t)x * ASJ_FIELD_BRANCHES + (size_t)i];
            memset(to, 0, sizeof *to);
            if (!branch.strength)
                continue;
            const int32_t k = (int32_t)((branch.angle * (int64_t)s->count + 32768) / 65536) % s->count, n = s->size[k];
            const double strength = (double)branch.strength / ASJ_STRENGTH_ONE;
            const double sum = n * ASJ_GAMMA_MEAN + strength * ASJ_GAMMA_SD * sqrt(n);
            to->angle = (float)(branch.angle * (TWO_PI / 65536));
            to->strength = (float)strength;
            to->log10_nfa = (float)((log(s->count) + asj_nfa_log_sector_tail(d->context->nfa, sum, n)) / log(10));
        }
    }
}

asj_status asj_local_field(asj_context *context, const asj_image *image, const asj_detect_options *options,
                           asj_local_branch *branches)
{
    asj_detect_options defaults;
    detection d;
    asj_status status = begin(context, image, &options, &defaults, branches, &d);
    if (status == ASJ_OK)
        status = load_and_normalise(&d, image);
    for (int32_t top = 0; status == ASJ_OK && top < image->height; top += GROUP) {
        const int32_t bottom = image->height - top < GROUP ? image->height : top + GROUP;
#ifdef _OPENMP
#pragma omp parallel for num_threads(d.threads) schedule(dynamic, 4)
#endif
        for (int32_t y = top; y < bottom; y++)
            field_row(&d, y, branches + (size_t)y * (size_t)image->width * ASJ_FIELD_BRANCHES);
        status = asj_progress(context, ASJ_STAGE_CANDIDATES, (double)bottom / image->height);
    }
    if (context)
        release(&d);
    return status;
}
