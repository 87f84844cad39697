/* SPDX-License-Identifier: BSD-2-Clause */
/* The grey levels of an image upsampled by two. Pixel (i, j) is centred at x = (i + 0.5) / 2 - 0.5 of the image, a quarter of a
 * pixel beside one of its own, y likewise. So along a line
 *     e(2 k) = (g(k - 1) + 3 g(k)) / 4,    e(2 k + 1) = (3 g(k) + g(k + 1)) / 4,
 * and in both directions the weights are 9, 3, 3 and 1 sixteenths: whole numbers in, whole numbers out, rounded once, in 1/128 of a
 * grey level. Beyond its border the image goes on as its border.
 *
 * Interpolation makes no detail. It makes room: sectors, bands and strips have a least size in pixels, and more short edges fill
 * it. Neighbouring pixels of noise are alike then, which is what blurred noise is (octaves.c). */
#include "image.h"
#include "watch.h"

#define LEAST_PIXELS 65536 /* for a thread: 20 us */

typedef struct job {
    const asj_frame *from, *to;
    asj_watch *watch;
} job;

/* One row of two: `near` weighs three times as much as `far`; both go on for a pixel on either side. */
static void upsample_row(const uint16_t *near, const uint16_t *far, int32_t width, uint16_t *to)
{
    for (int32_t x = 0; x < width; x++) {
        const int32_t before = 3 * near[x - 1] + far[x - 1], at = 3 * near[x] + far[x], after = 3 * near[x + 1] + far[x + 1];
        to[2 * x] = (uint16_t)((before + 3 * at + 8) >> 4);
        to[2 * x + 1] = (uint16_t)((3 * at + after + 8) >> 4);
    }
}

static void upsample_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_frame *from = j->from, *to = j->to;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++) {
        const uint16_t *row = from->gray + y * from->stride;
        upsample_row(row, row - from->stride, from->width, to->gray + 2 * y * to->stride);
        upsample_row(row, row + from->stride, from->width, to->gray + (2 * y + 1) * to->stride);
    }
}

asj_status asj_upsample_check(asj_context *context, const asj_image *image)
{
    if (2 * image->width > ASJ_MAX_SIDE || 2 * image->height > ASJ_MAX_SIDE ||
        4 * (int64_t)image->width * image->height > ASJ_MAX_PIXELS)
        return asj_fail(context, ASJ_ERROR_LIMIT, "an image of %d x %d pixels is too large for octave -1", (int)image->width,
                        (int)image->height);
    return ASJ_OK;
}

/* The image itself stands where the gradient will, which has nothing to say before. */
asj_status asj_frame_upsample(asj_context *context, asj_frame *frame, const asj_image *image, int32_t plane)
{
    const int32_t width = 2 * image->width, height = 2 * image->height, octaves = frame->octaves;
    asj_status status = asj_frame_prepare_gray(context, frame, width, height);
    if (status != ASJ_OK)
        return status;
    asj_frame own = *frame;
    own.width = image->width;
    own.height = image->height;
    own.gray = (uint16_t *)frame->gradient_x + ASJ_GRAY_BORDER * (frame->stride + 1);
    status = asj_frame_load(context, &own, image, plane);
    if (status != ASJ_OK)
        return status;
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
    const job j = {&own, frame, &watch};
    const int64_t pixels = (int64_t)width * height;
    asj_parallel(context, asj_threads_for(context, pixels, LEAST_PIXELS), image->height, 0, upsample_rows, &j);
    asj_frame_repeat_border(frame);
    status = asj_frame_prepare(context, frame, width, height);
    frame->octave = -1;
    frame->octaves = octaves;
    return status == ASJ_OK ? asj_watch_end(&watch) : status;
}
