/* SPDX-License-Identifier: BSD-2-Clause */
/* Sizes over an image: its copies, and what each leaves behind. */
#include "sizes.h"
#include "steps.h"
#include "suppress.h"
#include "core/decade.h"

#include <math.h>
#include <string.h>

/* Around a place candidates lie so far: px of the image, in which it may move, and of the octave, in which a junction lies beside
 * its pixel. Farther takes longer and finds no more; nearer, fewer are found again (tests/accuracy/tried/detection.md). */
#define AROUND 3.0
#define BESIDE 1.0
#define BESIDE_COARSE 2.0 /* from octave 2 on: with 1 .637 of the corners blurred by 8 px are found for .66 */

/* From the place's octave to those that are looked at: with 0 1823 of 1874 stay, with all of them none more. */
#define OCTAVES 1.0

/* px of the octave: a hypothesis that is located may still move so far. With 0 .83 of the corners of 25 grey levels blurred by 5 px
 * are found for .89. */
#define MOVES 1.0

/* Natural logarithm of the NFA of the isotropic test: of what validation rejects in the image itself, places that may be junctions
 * all the same. Coarser octaves reject little, weak corners mostly, and all of that is looked at. With all of these places 2 % more
 * junctions stay, in 1.1 times the time. */
#define NEARLY (-12 * ASJ_LN_10)

/* A pixel of a copy takes about so much of the time of one of the image itself. */
#define COPY_TIME 0.25

int32_t asj_sizes_of(const asj_detection_run *run)
{
    const asj_image *image = run->whole;
    const double fine = run->options->first_octave < 0 ? 2 : 1;
    const double width = fine * asj_size_px(image->width, 2), height = fine * asj_size_px(image->height, 2);
    const int fits = width <= ASJ_MAX_SIDE && height <= ASJ_MAX_SIDE && width * height <= ASJ_MAX_PIXELS;
    const int32_t shorter = image->width < image->height ? image->width : image->height;
    return run->options->three_sizes && fits && asj_size_px(shorter, 1) > 0 ? ASJ_SIZES : 1;
}

double asj_sizes_time(const asj_detection_run *run)
{
    return asj_sizes_of(run) > 1 ? 1 + COPY_TIME * (ASJ_SQRT2 + 1 / ASJ_SQRT2) : 1;
}

double asj_size_time(const asj_detection_run *run)
{
    return run->size > 0 ? COPY_TIME : 1;
}

/* Puts by what the look has found, in pixels of the image, and goes back to that. */
static void put_by(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    asj_size_found *list = &run->sizes.found[run->sizes.count++];
    *list = (asj_size_found){run->found, run->found_count};
    asj_suppress_sort(list->found, list->count);
    run->found = NULL;
    run->found_count = run->found_capacity = 0;
    if (run->size == 0)
        return;
    asj_size_map(list, run->image->width, run->image->height, run->whole->width, run->whole->height);
    asj_release(memory, run->places);
    asj_release(memory, run->size_cells);
    run->places = NULL;
    run->size_cells = NULL;
    run->image = run->whole;
    run->region = run->whole_region;
}

static asj_status mark_sizes(asj_detection_run *run)
{
    const int32_t width = run->image->width, height = run->image->height;
    const size_t count = asj_sizes_cells(&run->sizes, width, height);
    run->size_cells = asj_allocate_list(&run->context->memory, count, sizeof *run->size_cells);
    if (!run->size_cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    asj_sizes_mark(&run->sizes, width, height, run->size_cells);
    return ASJ_OK;
}

/* Of the first copy where the image itself has something or nearly has, of the second where these disagree. */
static asj_status find_places(asj_detection_run *run)
{
    const size_t total = asj_sizes_total(&run->sizes) + run->rejected_count;
    run->places = asj_allocate_list(&run->context->memory, asj_detection_run_room(total), sizeof *run->places);
    if (!run->places)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu places", total);
    run->place_count = asj_sizes_disputed(&run->sizes, run->places);
    if (run->size == 1) {
        if (run->rejected_count > 0)
            memcpy(run->places + run->place_count, run->rejected, run->rejected_count * sizeof *run->places);
        run->place_count += run->rejected_count;
    }
    return ASJ_OK;
}

/* The image becomes its copy of another size; what a region leaves out goes at the end. */
static asj_status resize(asj_detection_run *run)
{
    run->other = (asj_image){.format = run->whole->format,
                             .width = asj_size_px(run->whole->width, run->size),
                             .height = asj_size_px(run->whole->height, run->size)};
    run->image = &run->other;
    run->region = NULL;
    asj_release(&run->context->memory, run->candidates); /* of another size */
    run->candidates = NULL;
    return asj_detection_run_start_plane(run);
}

asj_status asj_step_next_size(asj_detection_run *run)
{
    put_by(run);
    run->size++;
    asj_status status = mark_sizes(run);
    if (status == ASJ_OK)
        status = find_places(run);
    return status == ASJ_OK ? resize(run) : status;
}

asj_status asj_step_merge_sizes(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    put_by(run);
    const size_t total = asj_sizes_total(&run->sizes), room = asj_detection_run_room(total);
    const int32_t width = run->image->width, height = run->image->height;
    const size_t count = asj_octave_grid_cells(total, width, height);
    asj_status status = mark_sizes(run);
    int32_t *others = status == ASJ_OK ? asj_allocate_list(memory, count, sizeof *others) : NULL;
    run->found = others ? asj_allocate_list(memory, room, sizeof *run->found) : NULL;
    if (run->found) {
        run->found_count = asj_sizes_agreed(&run->sizes, width, height, others, run->found);
        run->found_capacity = room;
    } else if (status == ASJ_OK)
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", total);
    asj_release(memory, others);
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
    const double scale = asj_octave_scale(run->octave), reach = AROUND / scale + (run->octave > 1 ? BESIDE_COARSE : BESIDE);
    const double x_scale = (double)run->image->width / run->whole->width, y_scale = (double)run->image->height / run->whole->height;
    memset(run->candidates, 0, runs * sizeof *run->candidates);
    for (size_t i = 0; i < run->place_count; i++) {
        const asj_size_place *place = &run->places[i];
        if (fabs(place->octave - run->octave) <= OCTAVES)
            mark_around(run, (place->x + 0.5) * x_scale / scale - 0.5, (place->y + 0.5) * y_scale / scale - 0.5, reach);
    }
}

/* Of a hypothesis in pixels of the octave at hand. */
static asj_size_place place_of(const asj_detection_run *run, const asj_hypothesis *hypothesis)
{
    const double scale = asj_octave_scale(run->octave);
    const double x_scale = (double)run->whole->width / run->image->width, y_scale = (double)run->whole->height / run->image->height;
    return (asj_size_place){(hypothesis->x + 0.5) * scale * x_scale - 0.5, (hypothesis->y + 0.5) * scale * y_scale - 0.5,
                            run->octave};
}

asj_status asj_sizes_put_rejected(asj_detection_run *run)
{
    if (run->size > 0 || asj_sizes_of(run) == 1)
        return ASJ_OK;
    const size_t most = run->rejected_count + run->hypothesis_count - run->validated;
    void *list = run->rejected;
    const asj_status status = asj_grow(&run->context->memory, &list, &run->rejected_capacity, asj_detection_run_room(most),
                                       sizeof *run->rejected, run->rejected_count);
    run->rejected = list;
    if (status != ASJ_OK)
        return asj_fail(run->context, status, "no memory for %zu places", most);
    for (size_t i = run->validated; i < run->hypothesis_count; i++)
        if (run->hypotheses[i].branch_count == 0 && (run->octave > 0 || run->hypotheses[i].log_nfa <= NEARLY))
            run->rejected[run->rejected_count++] = place_of(run, &run->hypotheses[i]);
    return ASJ_OK;
}

/* The last copy has votes alone. */
void asj_sizes_tell_votes(asj_detection_run *run)
{
    const double reach = ASJ_SIZES_NEAR + MOVES * asj_octave_scale(run->octave);
    size_t kept = run->validated;
    if (run->size == 0)
        return;
    for (size_t i = kept; i < run->hypothesis_count; i++) {
        const asj_size_place place = place_of(run, &run->hypotheses[i]);
        run->hypotheses[i].is_vote = asj_sizes_have(&run->sizes, &place, reach);
        if (run->hypotheses[i].is_vote || run->size + 1 < ASJ_SIZES)
            run->hypotheses[kept++] = run->hypotheses[i];
    }
    run->hypothesis_count = kept;
}

size_t asj_sizes_votes_last(asj_detection_run *run)
{
    size_t others = 0;
    for (size_t i = 0; i < run->hypothesis_count; i++) {
        if (run->hypotheses[i].is_vote)
            continue;
        const asj_hypothesis other = run->hypotheses[i];
        run->hypotheses[i] = run->hypotheses[others];
        run->hypotheses[others++] = other;
    }
    return run->hypothesis_count - others;
}
