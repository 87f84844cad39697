/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_match_images(): from two images to their matches, if wanted stretched before.
 *
 * What is small or seen at a glancing angle has too few pixels for junctions, where it is foreshortened and in between as well:
 * stretched along one axis, or enlarged, it has enough (the views of ASIFT, Morel and Yu 2009, are made so that descriptors agree;
 * here patches follow their junctions' affine maps anyway, and it is the detector that gains). Of an enlarged image the octaves
 * that are no smaller than the image are matched as one: matches of guests (match/guests.c) are fewer, and less sure. */
#include "core/image.h"
#include "core/stretch.h"
#include "match/match_result.h"

#include <asj/detect.h>
#include <asj/match.h>

#include <math.h>
#include <string.h>

#define DETECTION 0.3 /* of the progress, for each image */

/* One of the images. */
typedef struct view {
    const asj_image *image;
    asj_image stretched;
    void *pixels;
    asj_stretch by;
    asj_detection *found;
    asj_junction *junctions; /* with octaves that begin at the image's size */
} view;

static asj_status stretch(asj_context *context, asj_memory *memory, const asj_stretch *wanted, view *v)
{
    v->stretched = *v->image;
    v->by = (asj_stretch){1, 1};
    const asj_status status = asj_image_check(context, v->image);
    if (status != ASJ_OK || (wanted->x == 1 && wanted->y == 1))
        return status;
    const double width = floor(v->image->width * wanted->x + 0.5), height = floor(v->image->height * wanted->y + 0.5);
    if (width > ASJ_MAX_SIDE || height > ASJ_MAX_SIDE || width * height > ASJ_MAX_PIXELS)
        return asj_fail(context, ASJ_ERROR_LIMIT, "an image of %d x %d pixels cannot be stretched to %.0f x %.0f",
                        (int)v->image->width, (int)v->image->height, width, height);
    v->by = (asj_stretch){width / v->image->width, height / v->image->height};
    return asj_stretch_image(context, memory, v->image, (int32_t)width, (int32_t)height, &v->stretched, &v->pixels);
}

static asj_status detect(asj_context *context, asj_memory *memory, const asj_detect_options *options, view *v)
{
    const asj_status status = asj_detect(context, &v->stretched, options, &v->found);
    if (status != ASJ_OK)
        return status;
    const size_t count = v->found->junction_count;
    v->junctions = asj_allocate(memory, count, sizeof *v->junctions);
    if (!v->junctions)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", count);
    if (count > 0)
        memcpy(v->junctions, v->found->junctions, count * sizeof *v->junctions);
    const int32_t finer = (int32_t)floor(log2(fmin(v->by.x, v->by.y)) + 1e-6);
    for (size_t k = 0; k < count; k++)
        v->junctions[k].octave = v->junctions[k].octave > finer ? v->junctions[k].octave - finer : 0;
    return ASJ_OK;
}

static asj_status match(asj_context *context, const view v[2], const asj_match_options *options, asj_match_result **result)
{
    const asj_stretch by[2] = {v[0].by, v[1].by};
    asj_match_options stretched = *options;
    for (int32_t n = 0; n < 2; n++)
        if (options->geometry.cameras[n].fx > 0)
            stretched.geometry.cameras[n] = asj_stretch_camera(&options->geometry.cameras[n], &by[n]);
    const asj_status status = asj_match(context, &v[0].stretched, v[0].junctions, v[0].found->junction_count, &v[1].stretched,
                                        v[1].junctions, v[1].found->junction_count, &stretched, result);
    if (status == ASJ_OK && (v[0].pixels || v[1].pixels))
        asj_match_result_unstretch(*result, by);
    return status;
}

static void begin_part(asj_context *context, double from, double part)
{
    context->progress_from = from;
    context->progress_part = part;
}

/* Those of the detections, too. */
static void add_times(asj_match_result *result, const view v[2], double start)
{
    for (int32_t s = 0; s < ASJ_STAGE_COUNT; s++)
        result->stage_ms[s] += v[0].found->stage_ms[s] + v[1].found->stage_ms[s];
    result->total_ms = asj_clock_ms() - start;
}

static asj_status check(asj_context *context, const asj_stretch *stretch, const asj_match_options *options)
{
    if (!(stretch->x >= 1 && stretch->x <= ASJ_MOST_STRETCH && stretch->y >= 1 && stretch->y <= ASJ_MOST_STRETCH))
        return asj_fail(context, ASJ_ERROR_OPTION, "a stretch of %g, %g is outside 1 .. %d", stretch->x, stretch->y,
                        ASJ_MOST_STRETCH);
    if (options->geometry.model != ASJ_GEOMETRY_NONE && options->geometry.find_focal && stretch->x != stretch->y)
        return asj_fail(context, ASJ_ERROR_OPTION, "a focal length is found for square pixels only, not for a stretch of %g, %g",
                        stretch->x, stretch->y);
    return ASJ_OK;
}

asj_status asj_match_images(asj_context *context, const asj_image *image1, const asj_image *image2, const asj_stretch *wanted,
                            const asj_detect_options *detect_options, const asj_match_options *options, asj_match_result **result)
{
    const asj_stretch as_it_is = {1, 1};
    asj_detect_options for_matching;
    asj_match_options defaults;
    if (result)
        *result = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!image1 || !image2 || !result)
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "an image or the result is NULL");
    asj_detect_options_preset(&for_matching, ASJ_PRESET_MATCH);
    asj_match_options_init(&defaults);
    wanted = wanted ? wanted : &as_it_is;
    options = options ? options : &defaults;
    detect_options = detect_options ? detect_options : &for_matching;
    asj_memory *memory = &context->memory;
    const double start = asj_clock_ms();
    view views[2] = {{.image = image1}, {.image = image2}};
    asj_status status = check(context, wanted, options);
    for (int32_t n = 0; n < 2 && status == ASJ_OK; n++)
        status = stretch(context, memory, wanted, &views[n]);
    for (int32_t n = 0; n < 2 && status == ASJ_OK; n++) {
        begin_part(context, n * DETECTION, DETECTION);
        status = detect(context, memory, detect_options, &views[n]);
    }
    begin_part(context, 2 * DETECTION, 1 - 2 * DETECTION);
    if (status == ASJ_OK)
        status = match(context, views, options, result);
    begin_part(context, 0, 0);
    if (status == ASJ_OK)
        add_times(*result, views, start);
    for (int32_t n = 0; n < 2; n++) {
        asj_release(memory, views[n].pixels);
        asj_release(memory, views[n].junctions);
        asj_detection_free(&views[n].found);
    }
    return status;
}
