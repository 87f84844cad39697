/* SPDX-License-Identifier: BSD-2-Clause */
/* What is small or seen at a glancing angle has too few pixels for junctions, where it is foreshortened and in between as well:
 * stretched along one axis, or upsampled, it has enough (the views of ASIFT, Morel and Yu 2009, are made so that descriptors agree;
 * here patches follow their junctions' affine maps anyway, and it is the detector that gains). Of an upsampled image the octaves
 * that are no smaller than the image are matched as one: matches of guests (match/guests.c) are fewer, and less sure. */
#include "look.h"
#include "core/image.h"
#include "core/sort.h"
#include "core/stretch.h"
#include "match/upsampled.h"
#include "match/result_changes.h"

#include <math.h>
#include <string.h>

#define DETECTION 0.3 /* of the progress, for each image */
#define BAND 64.0     /* px: height of the bands of rows in which junctions are sorted */

static void stretched_size(const asj_image *image, const asj_stretch *wanted, double *width, double *height)
{
    *width = floor(image->width * wanted->x + 0.5);
    *height = floor(image->height * wanted->y + 0.5);
}

int32_t asj_look_fits(const asj_image *image, const asj_stretch *wanted)
{
    double width, height;
    stretched_size(image, wanted, &width, &height);
    return width <= ASJ_MAX_SIDE && height <= ASJ_MAX_SIDE && width * height <= ASJ_MAX_PIXELS;
}

static int32_t at_least_half(int32_t side, int32_t wanted)
{
    return side > 2 * wanted ? side - side / 2 : wanted;
}

/* The view's image, which is halved until no less than half of it is left. */
static asj_status resize(asj_context *context, int32_t width, int32_t height, asj_view *v)
{
    asj_status status = ASJ_OK;
    do {
        const asj_image larger = v->stretched;
        void *const before = v->pixels;
        v->pixels = NULL;
        status = asj_stretch_image(context, &context->memory, &larger, at_least_half(larger.width, width),
                                   at_least_half(larger.height, height), &v->stretched, &v->pixels);
        asj_release(&context->memory, before);
    } while (status == ASJ_OK && (v->stretched.width != width || v->stretched.height != height));
    return status;
}

static asj_status stretch(asj_context *context, const asj_image *image, const asj_stretch *wanted, asj_view *v)
{
    v->stretched = *image;
    v->by = (asj_stretch){1, 1};
    const asj_status status = asj_image_check(context, image);
    if (status != ASJ_OK || (wanted->x == 1 && wanted->y == 1))
        return status;
    double width, height;
    stretched_size(image, wanted, &width, &height);
    if (!asj_look_fits(image, wanted))
        return asj_fail(context, ASJ_ERROR_LIMIT, "an image of %d x %d pixels cannot be stretched to %.0f x %.0f",
                        (int)image->width, (int)image->height, width, height);
    v->by = (asj_stretch){width / image->width, height / image->height};
    return resize(context, (int32_t)width, (int32_t)height, v);
}

static asj_status detect(asj_context *context, const asj_detect_options *options, asj_luma_found *luma, asj_view *v)
{
    const asj_status status = asj_detect_with_luma(context, &v->stretched, options, luma, &v->found);
    if (status != ASJ_OK)
        return status;
    const size_t count = v->found->junction_count;
    v->junctions = asj_allocate(&context->memory, count, sizeof *v->junctions);
    if (!v->junctions)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", count);
    if (count > 0)
        memcpy(v->junctions, v->found->junctions, count * sizeof *v->junctions);
    const int32_t finer = (int32_t)floor(log2(fmax(1, fmin(v->by.x, v->by.y))) + 1e-6);
    for (size_t k = 0; k < count; k++)
        if (v->junctions[k].octave > 0) /* octave -1 stays what it is: match/upsampled.c asks whether it holds */
            v->junctions[k].octave = v->junctions[k].octave > finer ? v->junctions[k].octave - finer : 0;
    return ASJ_OK;
}

/* The call that follows is a part of what the look is. */
static void begin_part(const asj_look *look, double from, double part)
{
    look->context->progress_from = look->progress_from + from * look->progress_part;
    look->context->progress_part = part * look->progress_part;
}

static void end_part(asj_context *context)
{
    context->progress_from = context->progress_part = 0;
}

asj_status asj_look_open(asj_context *context, const asj_image *const images[2], const asj_stretch *wanted,
                         const asj_detect_options *options, asj_luma_found *luma, double progress_from, double progress_part,
                         asj_look *look)
{
    memset(look, 0, sizeof *look);
    look->context = context;
    look->stretch = *wanted;
    look->progress_from = progress_from;
    look->progress_part = progress_part;
    asj_status status = ASJ_OK;
    for (int32_t n = 0; n < 2 && status == ASJ_OK; n++)
        status = stretch(context, images[n], wanted, &look->views[n]);
    for (int32_t n = 0; n < 2 && status == ASJ_OK; n++) {
        begin_part(look, n * DETECTION, DETECTION);
        status = detect(context, options, luma ? &luma[n] : NULL, &look->views[n]);
    }
    end_part(context);
    return status;
}

/* Junctions of one image that are matched. */
typedef struct junction_list {
    const asj_junction *list;
    size_t count;
} junction_list;

/* own: of the upsampled images alone, with their own matches as a witness; NULL: as they are. */
static asj_status match_lists(const asj_look *look, const junction_list lists[2], const asj_match_options *options,
                              const asj_match_result *own, asj_match_result **result)
{
    const asj_view *v = look->views;
    const asj_known_matches known = {own, {v[0].by, v[1].by}};
    asj_match_options stretched = *options;
    for (int32_t n = 0; n < 2; n++) {
        stretched.geometry.aspects[n] *= v[n].by.y / v[n].by.x;
        if (options->geometry.cameras[n].fx > 0)
            stretched.geometry.cameras[n] = asj_stretch_camera(&options->geometry.cameras[n], &v[n].by);
    }
    begin_part(look, 2 * DETECTION, 1 - 2 * DETECTION);
    const asj_match_source sources[2] = {{&v[0].stretched, lists[0].list, lists[0].count},
                                         {&v[1].stretched, lists[1].list, lists[1].count}};
    const asj_status status = asj_match_look(look->context, sources, &stretched, own != NULL, own ? &known : NULL,
                                             look->alignments, result);
    end_part(look->context);
    if (status != ASJ_OK)
        return status;
    if (v[0].pixels || v[1].pixels)
        asj_match_result_unstretch(*result, known.by);
    (*result)->stretch[0] = look->stretch.x;
    (*result)->stretch[1] = look->stretch.y;
    return ASJ_OK;
}

asj_status asj_look_match(const asj_look *look, const asj_match_options *options, asj_match_result **result)
{
    const asj_view *v = look->views;
    const junction_list lists[2] = {{v[0].junctions, v[0].found->junction_count}, {v[1].junctions, v[1].found->junction_count}};
    return match_lists(look, lists, options, NULL, result);
}

/* --- upsampled ---------------------------------------------------------------------------------------------------------------- */

/* Where the junction of this number stands. */
typedef struct stand {
    int32_t band; /* of rows */
    float x;
    uint32_t number;
} stand;

static int by_place(const void *left, const void *right)
{
    const stand *a = left, *b = right;
    if (a->band != b->band)
        return a->band < b->band ? -1 : 1;
    return a->x != b->x ? (a->x < b->x ? -1 : 1) : (a->number > b->number) - (a->number < b->number);
}

/* The `most` most meaningful ones (0 = all), which stand first, by place: neighbours lie near each other (match/rank.c). */
static asj_status sort_by_place(const asj_look *look, int32_t n, int32_t most, asj_junction **sorted, junction_list *list)
{
    const asj_view *v = &look->views[n];
    asj_memory *memory = &look->context->memory;
    const size_t all = v->found->junction_count, count = most > 0 && all > (size_t)most ? (size_t)most : all;
    stand *stands = asj_allocate(memory, count, sizeof *stands);
    *sorted = asj_allocate(memory, count, sizeof **sorted);
    if (!stands || !*sorted) {
        asj_release(memory, stands);
        return asj_fail(look->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", count);
    }
    for (size_t k = 0; k < count; k++)
        stands[k] = (stand){(int32_t)floor((double)v->junctions[k].y / BAND), v->junctions[k].x, (uint32_t)k};
    asj_sort(stands, count, sizeof *stands, by_place);
    for (size_t k = 0; k < count; k++)
        (*sorted)[k] = v->junctions[stands[k].number];
    asj_release(memory, stands);
    *list = (junction_list){*sorted, count};
    return ASJ_OK;
}

asj_status asj_look_match_upsampled(const asj_look *look, const asj_match_options *options, const asj_match_result *own,
                                    asj_match_result **result)
{
    asj_junction *sorted[2] = {NULL, NULL};
    junction_list lists[2];
    asj_status status = ASJ_OK;
    for (int32_t n = 0; n < 2 && status == ASJ_OK; n++)
        status = sort_by_place(look, n, options->upsampled_max_junctions, &sorted[n], &lists[n]);
    if (status == ASJ_OK)
        status = match_lists(look, lists, options, own, result);
    asj_release(&look->context->memory, sorted[0]);
    asj_release(&look->context->memory, sorted[1]);
    return status;
}

void asj_look_add_times(const asj_look *look, double *stage_ms)
{
    for (int32_t s = 0; s < ASJ_STAGE_COUNT; s++)
        stage_ms[s] += look->views[0].found->stage_ms[s] + look->views[1].found->stage_ms[s];
}

void asj_look_close(asj_look *look)
{
    for (int32_t n = 0; n < 2; n++) {
        asj_release(&look->context->memory, look->views[n].pixels);
        asj_release(&look->context->memory, look->views[n].junctions);
        asj_detection_free(&look->views[n].found);
    }
}
