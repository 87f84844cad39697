/* SPDX-License-Identifier: BSD-2-Clause */
/* The colours of an image at half its size: colours are seldom finer than that (JPEG and video keep them so), and a byte for each
 * of them is all that features need to keep. colour_patch.c samples patches of it, and the geometry of a pair looks at all of it
 * (../geometry/picture_look.c). Whole numbers: the same on every machine. */
#include "small_picture.h"
#include "core/colour_plane.h"
#include "core/watch.h"

#include <string.h>

#define LEAST_ROWS 64 /* for a thread */

size_t asj_small_picture_bytes(const asj_small_picture *picture)
{
    return 3 * (size_t)picture->width * (size_t)picture->height;
}

asj_status asj_small_picture_allocate(asj_context *context, int32_t width, int32_t height, asj_small_picture *picture)
{
    *picture = (asj_small_picture){NULL, width / 2, height / 2};
    if (asj_small_picture_bytes(picture) == 0)
        return ASJ_OK;
    picture->level = asj_allocate(&context->memory, asj_small_picture_bytes(picture), sizeof *picture->level);
    return picture->level ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the colours of an image");
}

typedef struct halve_job {
    const asj_channels *channels;
    const asj_small_picture *picture;
    asj_watch *watch;
} halve_job;

static void halve_row(const asj_channels *c, const asj_small_picture *p, int32_t y)
{
    const int32_t at[3] = {c->red, 1, 2 - c->red};
    for (int32_t channel = 0; channel < 3; channel++) {
        const uint8_t *upper = c->first + 2 * y * c->stride + at[channel], *lower = upper + c->stride;
        uint8_t *to = p->level + ((size_t)channel * (size_t)p->height + (size_t)y) * (size_t)p->width;
        for (int32_t x = 0; x < p->width; x++, upper += 2 * c->step, lower += 2 * c->step)
            to[x] = (uint8_t)((upper[0] + upper[c->step] + lower[0] + lower[c->step] + 2) / 4);
    }
}

static void halve_rows(const void *data, const asj_part *part)
{
    const halve_job *j = data;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++)
        halve_row(j->channels, j->picture, (int32_t)y);
}

asj_status asj_small_picture_create(asj_context *context, const asj_image *image, asj_small_picture *picture)
{
    asj_channels channels;
    asj_watch watch;
    int32_t has_colours;
    memset(picture, 0, sizeof *picture);
    asj_status status = asj_image_has_colours(context, image, &has_colours);
    if (status != ASJ_OK || !has_colours || !asj_channels_of(image, &channels))
        return status;
    status = asj_small_picture_allocate(context, image->width, image->height, picture);
    if (status != ASJ_OK || !picture->level)
        return status;
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    const halve_job j = {&channels, picture, &watch};
    asj_parallel(context, asj_threads_for(context, picture->height, LEAST_ROWS), picture->height, 0, halve_rows, &j);
    return asj_watch_end(&watch);
}

/* Of one channel. */
typedef struct fill_job {
    const uint8_t *from;
    size_t stride, by; /* px: of a row, and of the square that makes a pixel */
    asj_pyramid *pyramid;
} fill_job;

static void copy_row(const uint8_t *row, size_t width, uint16_t *to)
{
    for (size_t x = 0; x < width; x++)
        to[x] = (uint16_t)(row[x] * ASJ_GRAY_ONE);
}

/* Means of squares of by x by pixels, of which `row` is the first row. */
static void reduce_row(const uint8_t *row, size_t stride, size_t by, size_t width, uint16_t *to)
{
    const uint32_t area = (uint32_t)(by * by);
    for (size_t x = 0; x < width; x++) {
        uint32_t sum = 0;
        for (size_t k = 0; k < by; k++)
            for (size_t n = 0; n < by; n++)
                sum += row[k * stride + x * by + n];
        to[x] = (uint16_t)((sum * ASJ_GRAY_ONE + area / 2) / area);
    }
}

static void fill_rows(const void *data, const asj_part *part)
{
    const fill_job *j = data;
    const size_t width = (size_t)j->pyramid->width[0];
    for (size_t y = (size_t)part->first; y < (size_t)part->end; y++) {
        const uint8_t *row = j->from + y * j->by * j->stride;
        uint16_t *to = j->pyramid->plane[0] + y * (width + 1);
        if (j->by == 1)
            copy_row(row, width, to);
        else
            reduce_row(row, j->stride, j->by, width, to);
    }
}

void asj_small_picture_fill(asj_context *context, const asj_small_picture *picture, int32_t channel, int32_t reduction,
                            asj_pyramid *pyramid)
{
    const size_t stride = (size_t)picture->width;
    const fill_job j = {picture->level + (size_t)channel * stride * (size_t)picture->height, stride, (size_t)reduction, pyramid};
    asj_parallel(context, asj_threads_for(context, pyramid->height[0], LEAST_ROWS), pyramid->height[0], 0, fill_rows, &j);
    asj_pyramid_complete(context, pyramid);
}
