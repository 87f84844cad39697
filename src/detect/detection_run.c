/* SPDX-License-Identifier: BSD-2-Clause */
/* Tables, planes and scratch of a pass; loops over its hypotheses; what it tells the caller while it works. */
#include "detection_run.h"
#include "detect_options.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define SHARING_FROM 600000     /* pixels; their planes take most of the memory then */
#define MOST_SHARED (8 << 20)   /* bytes of planes that share large pages too: they stay as long as anything there does */
#define SHARED_REST 1400000     /* bytes: tables and lists of photographs, .. */
#define SHARED_BY_THREAD 600000 /* .. cache and scratch of a thread */

#define LEAST_LIST 256 /* elements */

static void free_detector(asj_memory *memory, void *state)
{
    asj_detector *detector = state;
    asj_frame_free(memory, &detector->frame);
    asj_field_free(memory, &detector->field);
    asj_isotropic_free(memory, &detector->isotropic);
    asj_scan_cache_free(memory, &detector->scan_cache);
    asj_release(memory, detector);
}

/* The context's detector, with tables for these options. */
static asj_status make_tables(asj_context *context, const asj_detect_options *options, asj_detector **result)
{
    asj_detector *detector = *result = context->detector.state;
    if (!detector) {
        detector = *result = asj_allocate_zero(&context->memory, 1, sizeof *detector);
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
    asj_scan_prepare(options, &detector->field, &detector->scan_cache, &detector->scan);
    detector->options = *options;
    detector->ready = 1;
    return ASJ_OK;
}

static double first_octave(const asj_detection_run *run)
{
    return run->options->first_octave < 0 ? ASJ_FIRST_OCTAVE : 0;
}

asj_status asj_detection_run_start_plane(asj_detection_run *run)
{
    run->octave = first_octave(run);
    const asj_status status = asj_frame_prepare(run->context, run->frame, asj_octave_size(run->image->width, run->octave),
                                                asj_octave_size(run->image->height, run->octave));
    run->frame->octaves = run->sharing;
    return status == ASJ_OK ? asj_detection_run_set_size(run) : status;
}

asj_status asj_detection_run_set_size(asj_detection_run *run)
{
    asj_context *context = run->context;
    asj_detector *detector = context->detector.state;
    const asj_frame *frame = run->frame;
    if (frame->width != detector->width || frame->height != detector->height || frame->octaves != detector->octaves) {
        asj_isotropic_set_size(run->options, frame->width, frame->height, frame->octaves, &detector->isotropic);
        asj_scan_set_size(run->options, frame->width, frame->height, &detector->scan);
        detector->width = frame->width;
        detector->height = frame->height;
        detector->octaves = frame->octaves;
    }
    return asj_scan_cache_prepare(context, frame, context->threads, &detector->scan_cache);
}

static asj_status make_scratch(asj_detection_run *run)
{
    const size_t threads = (size_t)run->context->threads, field = asj_field_scratch(run->field), test = run->test->scratch;
    run->scratch.size = field > test ? field : test;
    run->scratch.memory = asj_allocate(&run->context->memory, threads * run->scratch.size, sizeof *run->scratch.memory);
    return run->scratch.memory ? ASJ_OK : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu threads", threads);
}

static asj_status prepare(asj_detection_run *run)
{
    asj_detector *detector;
    asj_status status = make_tables(run->context, run->options, &detector);
    if (status != ASJ_OK)
        return status;
    run->frame = &detector->frame;
    run->field = &detector->field;
    run->test = &detector->isotropic;
    run->scan = &detector->scan;
    status = asj_detection_run_start_plane(run);
    return status == ASJ_OK ? make_scratch(run) : status;
}

static asj_status look_at_planes(asj_detection_run *run)
{
    const asj_detect_options *options = run->options;
    run->planes.count = 1;
    const asj_status status = options->colours ? asj_colour_planes_look(run->context, run->image, &run->planes) : ASJ_OK;
    const int32_t octaves = asj_octaves_sharing(options, run->image->width, run->image->height);
    run->one_list = octaves > 1;
    run->sharing = options->independent_octaves ? 1 : octaves * run->planes.count;
    return status;
}

/* What the first image of a context takes; 0 = too little to share large pages. */
static size_t shared_bytes(const asj_detection_run *run)
{
    const int32_t width = run->image->width, height = run->image->height;
    const double octave = first_octave(run);
    const size_t planes = asj_frame_bytes(asj_octave_size(width, octave), asj_octave_size(height, octave));
    if ((int64_t)width * height < SHARING_FROM)
        return 0;
    return planes <= MOST_SHARED ? planes + SHARED_REST + (size_t)run->context->threads * SHARED_BY_THREAD : 1;
}

asj_status asj_detection_run_begin(asj_detection_run *run, asj_context *context, const asj_image *image,
                                   const asj_detect_options *options, const void *output)
{
    char message[256];
    memset(run, 0, sizeof *run);
    run->clock = asj_clock_ms();
    run->share = 1;
    run->context = context;
    run->image = run->whole = image;
    if (!image || !output)
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "%s is NULL", image ? "the place for the result" : "the image");
    if (!options)
        asj_detect_options_init(&run->defaults);
    run->options = options ? options : &run->defaults;
    if (asj_detect_options_check(run->options, message, sizeof message) != ASJ_OK)
        return asj_fail(context, ASJ_ERROR_OPTION, "%s", message);
    asj_status status = asj_image_check(context, image);
    if (status == ASJ_OK && run->options->first_octave < 0)
        status = asj_upsample_check(context, image);
    if (status == ASJ_OK)
        status = look_at_planes(run);
    if (status != ASJ_OK)
        return status;
    asj_memory_share(&context->memory, shared_bytes(run));
    return prepare(run);
}

void asj_detection_run_end(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    asj_detection_run_clear(run);
    asj_detection_run_clear_sizes(run);
    asj_release(memory, run->edges);
    asj_release(memory, run->evidence);
    asj_release(memory, run->candidates);
    asj_release(memory, run->all);
    asj_release(memory, run->found);
    asj_release(memory, run->scratch.memory);
    asj_release(memory, run->kept.levels);
    if (run->frame)
        asj_frame_free(memory, run->frame); /* kept as all that is released, but not for good: the next image may be small */
}

int asj_detection_run_is_coarse(const asj_detection_run *run)
{
    return run->frame->octave > 0 && !run->options->independent_octaves;
}

void asj_detection_run_clear(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    asj_release(memory, run->isotropic);
    asj_release(memory, run->guesses);
    asj_release(memory, run->hypotheses);
    run->isotropic = NULL;
    run->guesses = NULL;
    run->hypotheses = NULL;
    run->candidate_count = run->isotropic_count = run->hypothesis_count = run->validated = 0;
    run->choice = 0;
    run->guess_count = run->guess_capacity = run->hypothesis_capacity = 0;
}

void asj_detection_run_clear_sizes(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    for (int32_t i = 0; i < run->sizes.count; i++)
        asj_release(memory, run->sizes.found[i].found);
    asj_release(memory, run->places);
    asj_release(memory, run->size_cells);
    asj_release(memory, run->rejected);
    run->sizes.count = 0;
    run->places = run->rejected = NULL;
    run->size_cells = NULL;
}

asj_status asj_detection_run_known(const asj_detection_run *run, asj_octave_known *known)
{
    const int32_t width = run->image->width, height = run->image->height;
    *known = (asj_octave_known){.finer = NULL};
    if (run->all_count == 0 || run->options->independent_octaves)
        return ASJ_OK;
    const size_t count = asj_octave_grid_cells(run->all_count, width, height);
    int32_t *cells = asj_allocate_list(&run->context->memory, count, sizeof *cells);
    if (!cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    *known = asj_octave_known_start(run->all, run->all_count, run->octave, run->options, width, height, cells);
    return ASJ_OK;
}

size_t asj_detection_run_room(size_t count)
{
    return count > LEAST_LIST ? count : LEAST_LIST;
}

typedef struct job {
    asj_detection_run *run;
    asj_watch *watch;
    asj_hypothesis_work work;
} job;

static void work_on_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++)
        j->work(j->run, &j->run->hypotheses[j->run->validated + (size_t)i]);
}

asj_status asj_detection_run_each(asj_detection_run *run, int32_t stage, int32_t least, asj_hypothesis_work work)
{
    const int64_t count = (int64_t)(run->hypothesis_count - run->validated);
    asj_watch watch;
    const job j = {run, &watch, work};
    asj_watch_start(&watch, run->context, stage);
    asj_parallel(run->context, asj_threads_for(run->context, count, least), count, ASJ_JUNCTIONS_AT_ONCE, work_on_some, &j);
    return asj_watch_end(&watch);
}

void asj_detection_run_drop_rejected(asj_detection_run *run)
{
    size_t kept = run->validated;
    for (size_t i = kept; i < run->hypothesis_count; i++)
        if (run->hypotheses[i].branch_count > 0)
            run->hypotheses[kept++] = run->hypotheses[i];
    run->hypothesis_count = kept;
}

asj_status asj_detection_run_progress(const asj_detection_run *run, int32_t stage, double done)
{
    return asj_progress(run->context, stage, fmin(run->done + run->share * done, 1));
}

void asj_detection_run_time(asj_detection_run *run, int32_t stage)
{
    const double now = asj_clock_ms();
    run->stage_ms[stage] += now - run->clock;
    run->clock = now;
}

void asj_detection_run_dump_plane(const asj_detection_run *run, int32_t kind, const char *name, const void *data, double unit)
{
    const asj_frame *frame = run->frame;
    if (run->size > 0)
        return;
    const asj_dump dump = {ASJ_STAGE_GRADIENT, kind, name, data, frame->width, frame->height, frame->stride, 0, unit};
    asj_dump_out(run->context, &dump);
}

void asj_detection_run_dump_points(const asj_detection_run *run, int32_t stage, const char *name, size_t count,
                                   const int32_t *points)
{
    const asj_frame *frame = run->frame;
    if (run->size > 0)
        return;
    const asj_dump dump = {stage, ASJ_DUMP_POINTS, name, points, frame->width, frame->height, 0, count, 1};
    asj_dump_out(run->context, &dump);
}

asj_status asj_detection_run_dump_hypotheses(const asj_detection_run *run, int32_t stage, const char *name)
{
    asj_memory *memory = &run->context->memory;
    size_t count = 0;
    if (!run->context->options.dump)
        return ASJ_OK;
    int32_t *points = asj_allocate_list(memory, run->hypothesis_count, 2 * sizeof *points);
    if (!points)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to dump %zu points", run->hypothesis_count);
    for (size_t i = 0; i < run->hypothesis_count; i++) {
        points[2 * count] = (int32_t)lrint(run->hypotheses[i].x);
        points[2 * count + 1] = (int32_t)lrint(run->hypotheses[i].y);
        count += run->hypotheses[i].branch_count > 0;
    }
    asj_detection_run_dump_points(run, stage, name, count, points);
    asj_release(memory, points);
    return ASJ_OK;
}
