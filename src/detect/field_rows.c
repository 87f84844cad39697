/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 over rows of an image, by all threads: candidates tile by tile, the whole field pixel by pixel. */
#include "field.h"
#include "core/context.h"
#include "core/ops.h"
#include "core/threads.h"

#define LEAST_RUNS 128 /* for a thread: about 25 us */
#define BAND 128       /* rows of a tile where threads share them; each has 2 radii more to fill planes with */

typedef struct job {
    asj_context *context;
    const asj_field *field;
    const asj_frame *frame;
    int32_t top, bottom, band, per_tile, across; /* rows of a tile; `across` tiles beside each other */
    const asj_scratch *scratch;
    uint16_t *masks;
} job;

static void do_tiles(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t i = part->first; i < part->end; i++) {
        const int32_t run = (int32_t)(i % j->across) * j->per_tile, left = j->frame->blocks - run;
        const int32_t top = j->top + (int32_t)(i / j->across) * j->band, below = j->bottom - top;
        const asj_tile tile = {run, left < j->per_tile ? left : j->per_tile, top, top + (below < j->band ? below : j->band)};
        j->context->ops->field->tile(j->field, j->frame, &tile, asj_thread_scratch(j->scratch, part), j->masks);
    }
}

asj_status asj_field_rows(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                          const asj_scratch *scratch, uint16_t *masks)
{
    const int32_t threads = asj_threads_for(context, (int64_t)frame->blocks * (bottom - top), LEAST_RUNS);
    const int32_t rows = bottom - top, band = threads == 1 && rows > 0 ? rows : BAND;
    const int32_t bands = (rows + band - 1) / band, largest = field->step * ASJ_FIELD_TILE / ASJ_LANES;
    /* tiles are half as wide where there are so few that threads would wait for the last one */
    const int32_t many = 8 * threads * largest;
    const int32_t per_tile = threads == 1 || frame->blocks * bands >= many ? largest : largest / 2;
    const int32_t across = (frame->blocks + per_tile - 1) / per_tile;
    const job j = {context, field, frame, top, bottom, band, per_tile, across, scratch, masks};
    asj_parallel(context, threads, (int64_t)across * bands, 1, do_tiles, &j);
    return ASJ_OK;
}

typedef struct branches_job {
    asj_context *context;
    const asj_field *field;
    const asj_frame *frame;
    int32_t top;
    const asj_scratch *scratch;
    asj_field_branch (*branches)[ASJ_FIELD_BRANCHES];
} branches_job;

static void find_branches(const void *data, const asj_part *part)
{
    enum { AT_ONCE = 2 * ASJ_FIELD_BATCH };
    const branches_job *j = data;
    const int32_t width = j->frame->width;
    asj_pixel pixels[AT_ONCE];
    for (int64_t row = part->first; row < part->end; row++)
        for (int32_t first = 0; first < width; first += AT_ONCE) {
            const int32_t count = width - first < AT_ONCE ? width - first : AT_ONCE;
            for (int32_t i = 0; i < count; i++)
                pixels[i] = (asj_pixel){first + i, j->top + (int32_t)row};
            j->context->ops->field->pixels(j->field, j->frame, pixels, count, asj_thread_scratch(j->scratch, part),
                                           j->branches + (size_t)row * (size_t)width + first);
        }
}

asj_status asj_field_branches(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                              const asj_scratch *scratch, asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    const branches_job j = {context, field, frame, top, scratch, branches};
    asj_parallel(context, context->threads, bottom - top, 4, find_branches, &j);
    return ASJ_OK;
}

const asj_field_ops asj_field_reference = {
    .rows = asj_field_rows, .branches = asj_field_branches, .tile = asj_field_tile, .pixels = asj_field_pixels};
