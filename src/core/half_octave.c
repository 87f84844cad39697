/* SPDX-License-Identifier: BSD-2-Clause */
/* The grey levels of a plane made 1 / sqrt 2 as large: half an octave. Pixel (i, j) is the mean of what lies between s i and
 * s (i + 1) along x, s = sqrt 2, and between s j and s (j + 1) along y, pixel k of the plane from k to k + 1. So it is centred at
 * (i + 1/2) s - 1/2, as pixels of whole octaves are for s = 2 (octaves.c). It meets three pixels of a row at most, whose shares are
 * rounded to 1/256; so a level is the sum of nine whole numbers, rounded once, in 1/128 of a grey level. What is left at the right
 * and at the bottom, less than a pixel, belongs to none.
 *
 * Unlike those of 2 x 2 pixels such means share pixels with their neighbours: of white noise they keep .29 of the variance (those
 * .25), and .15 of it is common to two of them side by side, which is what noise that is hardly blurred is like. */
#include "image.h"
#include "threads.h"
#include "watch.h"

#include <math.h>
#include <string.h>

#define ONE 256             /* all shares of a row together */
#define LEAST_PIXELS 32768  /* for a thread: 20 us */
#define LEAST_IN_PLACE 256  /* px */

/* The pixels of a row that a mean meets. */
typedef struct tap {
    int32_t at[3];
    uint32_t share[3]; /* 1/ONE */
} tap;

typedef struct job {
    const asj_gray_plane *from;
    const asj_frame *to;
    const tap *columns, *rows;
    uint32_t *sums; /* of three rows, for each thread */
    asj_watch *watch;
} job;

static void fill_taps(tap *taps, int32_t count, int32_t size)
{
    for (int32_t i = 0; i < count; i++) {
        const double from = i * ASJ_SQRT2, to = (i + 1) * ASJ_SQRT2;
        const int32_t first = (int32_t)from;
        const double before = first + 1 - from, after = fmax(0, to - (first + 2));
        for (int32_t k = 0; k < 3; k++)
            taps[i].at[k] = first + k < size ? first + k : size - 1;
        taps[i].share[0] = (uint32_t)(ONE * before / ASJ_SQRT2 + 0.5);
        taps[i].share[2] = (uint32_t)(ONE * after / ASJ_SQRT2 + 0.5);
        taps[i].share[1] = ONE - taps[i].share[0] - taps[i].share[2];
    }
}

static void shrink_row(const job *j, int64_t y, uint32_t *sums)
{
    const tap *row = &j->rows[y];
    const uint16_t *levels = j->from->levels, *a = levels + row->at[0] * j->from->stride;
    const uint16_t *b = levels + row->at[1] * j->from->stride, *c = levels + row->at[2] * j->from->stride;
    uint16_t *to = j->to->gray + y * j->to->stride;
    for (int32_t x = 0; x < j->from->width; x++)
        sums[x] = row->share[0] * a[x] + row->share[1] * b[x] + row->share[2] * c[x];
    for (int32_t x = 0; x < j->to->width; x++) { /* 255 * 128 * ONE * ONE is below 2^31 */
        const tap *t = &j->columns[x];
        const uint32_t sum = t->share[0] * sums[t->at[0]] + t->share[1] * sums[t->at[1]] + t->share[2] * sums[t->at[2]];
        to[x] = (uint16_t)((sum + ONE * ONE / 2) / (ONE * ONE));
    }
}

static void shrink_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++)
        shrink_row(j, y, j->sums + (size_t)part->thread * (size_t)j->from->width);
}

asj_status asj_gray_plane_keep(asj_context *context, const asj_frame *frame, asj_gray_plane *copy)
{
    const size_t width = (size_t)frame->width, height = (size_t)frame->height;
    *copy = asj_frame_gray(frame);
    copy->stride = frame->width;
    copy->levels = asj_allocate(&context->memory, width * height, sizeof *copy->levels);
    if (!copy->levels)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a plane of %d x %d", (int)frame->width, (int)frame->height);
    for (size_t y = 0; y < height; y++)
        memcpy(copy->levels + y * width, frame->gray + (ptrdiff_t)y * frame->stride, width * sizeof *copy->levels);
    return ASJ_OK;
}

/* Planes of the smaller image take, with their margins and rows of whole runs of pixels, 3 (w / sqrt 2 + 79) (h / sqrt 2 + 64)
 * levels at most, and the larger one's grey levels stand behind 2 (w + 64) (h + 64): more, from such sides on. */
int32_t asj_frame_shrinks_in_place(const asj_frame *frame)
{
    return frame->width >= LEAST_IN_PLACE && frame->height >= LEAST_IN_PLACE;
}

asj_status asj_frame_shrink(asj_context *context, asj_frame *frame, const asj_gray_plane *from)
{
    const int32_t width = (int32_t)(from->width / ASJ_SQRT2), height = (int32_t)(from->height / ASJ_SQRT2);
    const int32_t octaves = frame->octaves;
    asj_status status = asj_frame_prepare(context, frame, width, height);
    if (status != ASJ_OK)
        return status;
    frame->octave = from->octave + 0.5;
    frame->octaves = octaves;
    tap *taps = asj_allocate(&context->memory, (size_t)width + (size_t)height, sizeof *taps);
    uint32_t *sums = asj_allocate(&context->memory, (size_t)context->threads * (size_t)from->width, sizeof *sums);
    if (taps && sums) {
        asj_watch watch;
        asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
        const job j = {from, frame, taps, taps + width, sums, &watch};
        fill_taps(taps, width, from->width);
        fill_taps(taps + width, height, from->height);
        asj_parallel(context, asj_threads_for(context, (int64_t)width * height, LEAST_PIXELS), height, 0, shrink_rows, &j);
        asj_frame_repeat_border(frame);
        status = asj_watch_end(&watch);
    } else {
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory to make a plane of %d x %d smaller", (int)from->width,
                          (int)from->height);
    }
    asj_release(&context->memory, sums);
    asj_release(&context->memory, taps);
    return status;
}
