/* SPDX-License-Identifier: BSD-2-Clause */
/* What is small or seen at a glancing angle has too few pixels for junctions, where it is foreshortened and in between as well:
 * stretched along one axis, or enlarged, it has enough (the views of ASIFT, Morel and Yu 2009, are made so that descriptors agree;
 * here patches follow their junctions' affine maps anyway, and it is the detector that gains). Of an enlarged image the octaves
 * that are no smaller than the image are matched as one: matches of guests (match/guests.c) are fewer, and less sure. */
#include "look.h"
#include "core/image.h"
#include "core/stretch.h"
#include "match/finer.h"
#include "match/result_changes.h"

#include <math.h>
#include <string.h>

#define DETECTION 0.3 /* of the progress, for each image */

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
    return asj_stretch_image(context, &context->memory, image, (int32_t)width, (int32_t)height, &v->stretched, &v->pixels);
}

static asj_status detect(asj_context *context, const asj_detect_options *options, asj_view *v)
{
    const asj_status status = asj_detect(context, &v->stretched, options, &v->found);
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
        if (v->junctions[k].octave > 0) /* octave -1 stays what it is: match/finer.c asks whether it holds */
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
                         const asj_detect_options *options, double progress_from, double progress_part, asj_look *look)
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
        status = detect(context, options, &look->views[n]);
    }
    end_part(context);
    return status;
}

typedef asj_status (*matcher)(asj_context *context, const asj_image *image1, const asj_junction *junctions1, size_t count1,
                              const asj_image *image2, const asj_junction *junctions2, size_t count2,
                              const asj_match_options *options, asj_match_result **result);

/* The most meaningful ones stand first. most: 0 = all. */
static size_t count_of(const asj_view *v, int32_t most)
{
    const size_t count = v->found->junction_count;
    return most > 0 && count > (size_t)most ? (size_t)most : count;
}

/* Of each image so many junctions at most (0 = all). */
static asj_status match_by(const asj_look *look, matcher match, int32_t most, const asj_match_options *options,
                           asj_match_result **result)
{
    const asj_view *v = look->views;
    const asj_stretch by[2] = {v[0].by, v[1].by};
    asj_match_options stretched = *options;
    for (int32_t n = 0; n < 2; n++)
        if (options->geometry.cameras[n].fx > 0)
            stretched.geometry.cameras[n] = asj_stretch_camera(&options->geometry.cameras[n], &by[n]);
    begin_part(look, 2 * DETECTION, 1 - 2 * DETECTION);
    const asj_status status = match(look->context, &v[0].stretched, v[0].junctions, count_of(&v[0], most), &v[1].stretched,
                                    v[1].junctions, count_of(&v[1], most), &stretched, result);
    end_part(look->context);
    if (status != ASJ_OK)
        return status;
    if (v[0].pixels || v[1].pixels)
        asj_match_result_unstretch(*result, by);
    (*result)->stretch[0] = look->stretch.x;
    (*result)->stretch[1] = look->stretch.y;
    return ASJ_OK;
}

asj_status asj_look_match(const asj_look *look, const asj_match_options *options, asj_match_result **result)
{
    return match_by(look, asj_match, 0, options, result);
}

asj_status asj_look_match_enlarged(const asj_look *look, const asj_match_options *options, asj_match_result **result)
{
    return match_by(look, asj_match_enlarged, options->enlarged_most, options, result);
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
