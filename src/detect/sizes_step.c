/* SPDX-License-Identifier: BSD-2-Clause */
/* Sizes over an image: its copies, and what each leaves behind. */
#include "sizes.h"
#include "steps.h"
#include "suppress.h"
#include "core/stretch.h"

#include <math.h>
#include <string.h>

/* Around a disputed place candidates lie so far: px of the image, in which it may move, and of the octave, in which a junction lies
 * beside its pixel. */
#define AROUND 3.0
#define BESIDE 3.5

int32_t asj_sizes_of(const asj_detection_run *run)
{
    const asj_image *image = run->whole;
    const double fine = run->options->first_octave < 0 ? 2 : 1;
    const double width = fine * asj_size_px(image->width, 2), height = fine * asj_size_px(image->height, 2);
    const int fits = width <= ASJ_MAX_SIDE && height <= ASJ_MAX_SIDE && width * height <= ASJ_MAX_PIXELS;
    const int32_t shorter = image->width < image->height ? image->width : image->height;
    return run->options->three_sizes && fits && asj_size_px(shorter, 1) > 0 ? ASJ_SIZES : 1;
}

double asj_sizes_area(const asj_detection_run *run)
{
    return asj_sizes_of(run) > 1 ? 1 + ASJ_SQRT2 + 1 / ASJ_SQRT2 : 1;
}

/* Puts by what the look has found, in pixels of the image, and goes back to that. */
static void put_by(asj_detection_run *run)
{
    asj_size_found *list = &run->sizes.found[run->sizes.count++];
    *list = (asj_size_found){run->found, run->found_count};
    asj_suppress_sort(list->found, list->count);
    run->found = NULL;
    run->found_count = run->found_capacity = 0;
    if (run->size == 0)
        return;
    asj_size_map(list, run->image->width, run->image->height, run->whole->width, run->whole->height);
    asj_release(&run->context->memory, run->stretched);
    asj_release(&run->context->memory, run->places);
    run->stretched = NULL;
    run->places = NULL;
    run->image = run->whole;
    run->region = run->whole_region;
}

static asj_status mark_sizes(asj_detection_run *run, int32_t **cells)
{
    const int32_t width = run->image->width, height = run->image->height;
    const size_t count = asj_sizes_cells(&run->sizes, width, height);
    *cells = asj_allocate_list(&run->context->memory, count, sizeof **cells);
    if (!*cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    asj_sizes_mark(&run->sizes, width, height, *cells);
    return ASJ_OK;
}

static asj_status find_disputed(asj_detection_run *run)
{
    const size_t total = asj_sizes_total(&run->sizes), room = asj_detection_run_room(total);
    int32_t *cells;
    asj_status status = mark_sizes(run, &cells);
    if (status == ASJ_OK)
        run->places = asj_allocate_list(&run->context->memory, room, 2 * sizeof *run->places);
    if (run->places)
        run->place_count = asj_sizes_disputed(&run->sizes, run->places);
    else if (status == ASJ_OK)
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu places", total);
    asj_release(&run->context->memory, cells);
    return status;
}

/* The image becomes its copy of another size, everywhere: what a region leaves out goes at the end. */
static asj_status stretch(asj_detection_run *run)
{
    asj_context *context = run->context;
    const int32_t width = asj_size_px(run->whole->width, run->size), height = asj_size_px(run->whole->height, run->size);
    const asj_status status = asj_stretch_image(context, &context->memory, run->whole, width, height, &run->other, &run->stretched);
    if (status != ASJ_OK)
        return status;
    run->image = &run->other;
    run->region = NULL;
    asj_release(&context->memory, run->candidates); /* of another size */
    run->candidates = NULL;
    return asj_detection_run_start_plane(run);
}

asj_status asj_step_next_size(asj_detection_run *run)
{
    put_by(run);
    run->size++;
    asj_status status = run->size + 1 == ASJ_SIZES ? find_disputed(run) : ASJ_OK;
    return status == ASJ_OK ? stretch(run) : status;
}

asj_status asj_step_merge_sizes(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    int32_t *cells;
    put_by(run);
    const size_t total = asj_sizes_total(&run->sizes), room = asj_detection_run_room(total);
    const int32_t width = run->image->width, height = run->image->height;
    const size_t count = asj_octave_grid_cells(total, width, height);
    asj_status status = mark_sizes(run, &cells);
    int32_t *others = status == ASJ_OK ? asj_allocate_list(memory, count, sizeof *others) : NULL;
    run->found = others ? asj_allocate_list(memory, room, sizeof *run->found) : NULL;
    if (run->found) {
        run->found_count = asj_sizes_agreed(&run->sizes, width, height, others, run->found);
        run->found_capacity = room;
    } else if (status == ASJ_OK)
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", total);
    asj_release(memory, others);
    asj_release(memory, cells);
    asj_detection_run_clear_sizes(run);
    return status;
}

static void mark_around(const asj_detection_run *run, double x, double y, double reach)
{
    const asj_frame *frame = run->frame;
    const int32_t step = run->options->candidate_step;
    for (int32_t v = (int32_t)fmax(y - reach, 0); v <= y + reach && v < frame->height; v++)
        for (int32_t u = (int32_t)fmax(x - reach, 0); u <= x + reach && u < frame->width; u++)
            if (u % step == 0 && v % step == 0 && (u - x) * (u - x) + (v - y) * (v - y) <= reach * reach)
                run->candidates[(ptrdiff_t)v * frame->blocks + u / ASJ_LANES] |= (uint16_t)(1u << u % ASJ_LANES);
}

void asj_sizes_mark_candidates(asj_detection_run *run)
{
    const size_t runs = (size_t)run->frame->blocks * (size_t)run->frame->height;
    const double scale = asj_octave_scale(run->octave), reach = AROUND / scale + BESIDE;
    const double x_scale = (double)run->image->width / run->whole->width, y_scale = (double)run->image->height / run->whole->height;
    memset(run->candidates, 0, runs * sizeof *run->candidates);
    for (size_t i = 0; i < run->place_count; i++) {
        const double x = (run->places[2 * i] + 0.5) * x_scale, y = (run->places[2 * i + 1] + 0.5) * y_scale;
        mark_around(run, x / scale - 0.5, y / scale - 0.5, reach);
    }
}
