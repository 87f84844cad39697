/* SPDX-License-Identifier: BSD-2-Clause */
/* A plane of an image at another size: grey levels between those of the four pixels around (bilinear), as stretch.c has samples.
 * Pixel X of the frame is centred at u = (X + 1/2) w / W - 1/2 of the image: between pixel i = floor(u) and the next one, whose
 * weights are 1 - f and f with f = u - i in 1/256. Outside, where the grey plane repeats its border, i may be -1. Sums of whole
 * numbers, rounded once. */
#include "image.h"
#include "threads.h"
#include "watch.h"

#include <math.h>

#define ONE 256             /* both weights together */
#define LEAST_PIXELS 32768  /* for a thread: about 50 us */

/* Between which two pixels one of the frame lies: number `before`, from -1 on, and the next one. */
typedef struct tap {
    int32_t before;
    uint32_t weight; /* of the next one, in 1/ONE */
} tap;

typedef struct job {
    const asj_frame *from, *to;
    const tap *columns, *rows;
    uint32_t *sums; /* of two rows and a pixel on either side, for each thread */
    asj_watch *watch;
} job;

static void fill_taps(tap *taps, int32_t wanted, int32_t there)
{
    for (int32_t x = 0; x < wanted; x++) {
        const double u = (x + 0.5) * there / wanted - 0.5, f = u - floor(u);
        taps[x] = (tap){(int32_t)floor(u), (uint32_t)floor(f * ONE + 0.5)};
    }
}

static void resize_row(const job *j, int64_t y, uint32_t *sums)
{
    const tap *row = &j->rows[y], *columns = j->columns;
    const int32_t there = j->from->width + 2, wanted = j->to->width;
    const uint16_t *upper = j->from->gray + row->before * j->from->stride - 1, *lower = upper + j->from->stride;
    const uint16_t down = (uint16_t)row->weight, up = (uint16_t)(ONE - down);
    uint16_t *to = j->to->gray + y * j->to->stride;
    for (int32_t x = 0; x < there; x++)
        sums[x] = (uint32_t)up * upper[x] + (uint32_t)down * lower[x];
    for (int32_t x = 0; x < wanted; x++) { /* 255 * 128 * ONE * ONE is below 2^31 */
        const uint32_t *sum = sums + columns[x].before + 1;
        to[x] = (uint16_t)((ONE * sum[0] + columns[x].weight * (sum[1] - sum[0]) + ONE * ONE / 2) / (ONE * ONE));
    }
}

static void resize_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++)
        resize_row(j, y, j->sums + (size_t)part->thread * ((size_t)j->from->width + 2));
}

static asj_status resize(asj_context *context, const asj_frame *from, const asj_frame *to)
{
    const size_t width = (size_t)to->width, height = (size_t)to->height;
    tap *taps = asj_allocate(&context->memory, width + height, sizeof *taps);
    uint32_t *sums = asj_allocate(&context->memory, (size_t)context->threads * ((size_t)from->width + 2), sizeof *sums);
    asj_status status;
    if (taps && sums) {
        asj_watch watch;
        asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
        const job j = {from, to, taps, taps + width, sums, &watch};
        fill_taps(taps, to->width, from->width);
        fill_taps(taps + width, to->height, from->height);
        asj_parallel(context, asj_threads_for(context, (int64_t)to->width * to->height, LEAST_PIXELS), to->height, 0, resize_rows,
                     &j);
        asj_frame_repeat_border(to);
        status = asj_watch_end(&watch);
    } else
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a plane of %d x %d pixels", (int)to->width, (int)to->height);
    asj_release(&context->memory, sums);
    asj_release(&context->memory, taps);
    return status;
}

/* The image itself stands where the gradient will: planes of W x H with their margins have room for 2 (W + 64) (H + 64) levels, and
 * it takes at most (w + 79) (h + 16) + 64, which is less where W and H are at least .75 of w and h. */
asj_status asj_frame_load_resized(asj_context *context, asj_frame *frame, const asj_image *image, int32_t plane, int32_t width,
                                  int32_t height)
{
    const int32_t octaves = frame->octaves;
    const double octave = frame->octave;
    asj_status status = asj_frame_prepare_gray(context, frame, width, height);
    if (status != ASJ_OK)
        return status;
    asj_frame own = *frame;
    own.width = image->width;
    own.height = image->height;
    own.stride = (ptrdiff_t)((image->width + ASJ_LANES - 1) / ASJ_LANES) * ASJ_LANES + 2 * ASJ_MARGIN;
    own.gray = (uint16_t *)frame->memory + ASJ_GRAY_MARGIN + ASJ_GRAY_BORDER * own.stride;
    status = asj_frame_load(context, &own, image, plane);
    if (status == ASJ_OK)
        status = resize(context, &own, frame);
    if (status == ASJ_OK)
        status = asj_frame_prepare(context, frame, width, height);
    frame->octave = octave;
    frame->octaves = octaves;
    return status;
}
