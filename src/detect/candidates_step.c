/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 over an image: one bit for each pixel that may be a junction. Another source of candidates sets bits of its own in the
 * same plane. */
#include "region.h"
#include "seeds.h"
#include "steps.h"

#include <string.h>

#define AT_ONCE (1 << 20) /* px */

#define AT_A_TIME 4 /* masks in a word */

/* Bits of four masks: added up in pairs, in fours, .. */
static size_t count_word(uint64_t four)
{
    const uint64_t pairs = 0x5555555555555555, fours = 0x3333333333333333, eights = 0x0f0f0f0f0f0f0f0f;
    four -= four >> 1 & pairs;
    four = (four & fours) + (four >> 2 & fours);
    four = (four + (four >> 4)) & eights;
    return (size_t)((four * 0x0101010101010101) >> 56);
}

size_t asj_candidates_count(const uint16_t *masks, size_t count)
{
    const size_t whole = count - count % AT_A_TIME;
    size_t bits = 0;
    uint64_t four = 0;
    for (size_t i = 0; i < whole; i += AT_A_TIME) {
        memcpy(&four, masks + i, sizeof four);
        bits += count_word(four);
    }
    four = 0;
    memcpy(&four, masks + whole, (count - whole) * sizeof *masks);
    return bits + count_word(four);
}

static asj_status dump(const asj_detection_run *run)
{
    const size_t blocks = (size_t)run->frame->blocks, runs = blocks * (size_t)run->frame->height;
    const size_t count = asj_candidates_count(run->candidates, runs);
    int32_t *points = asj_allocate_list(&run->context->memory, count, 2 * sizeof *points), *next = points;
    if (!points)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to dump %zu points", count);
    for (size_t i = 0; i < runs; i++)
        for (int32_t bit = 0; bit < ASJ_LANES; bit++)
            if (run->candidates[i] >> bit & 1) {
                *next++ = (int32_t)(i % blocks) * ASJ_LANES + bit;
                *next++ = (int32_t)(i / blocks);
            }
    asj_detection_run_dump_points(run, ASJ_STAGE_CANDIDATES, "candidates", count, points);
    asj_release(&run->context->memory, points);
    return ASJ_OK;
}

/* Rows between which progress is reported: whole groups, of about a megapixel, so that threads seldom wait for each other. */
static int32_t rows_at_once(const asj_frame *frame)
{
    const int32_t groups = AT_ONCE / (ASJ_ROW_GROUP * frame->width);
    return (groups > 1 ? groups : 1) * ASJ_ROW_GROUP;
}

/* Where the local field has two strong branches. Rows outside of a region are cleared by asj_region_clear_candidates(). */
static asj_status find_in_field(asj_detection_run *run)
{
    asj_context *context = run->context;
    const int32_t height = run->frame->height, rows = rows_at_once(run->frame);
    int32_t first, end;
    asj_status status = ASJ_OK;
    asj_region_rows(run, &first, &end);
    for (int32_t top = first - first % ASJ_ROW_GROUP; top < end && status == ASJ_OK; top += rows) {
        const int32_t bottom = end - top < rows ? end : top + rows;
        status = context->ops->field->rows(context, run->field, run->frame, top, bottom, &run->scratch, run->candidates);
        if (status == ASJ_OK)
            status = asj_detection_run_progress(run, ASJ_STAGE_CANDIDATES, 0.05 + 0.45 * bottom / height);
    }
    return status;
}

asj_status asj_step_candidates(asj_detection_run *run)
{
    asj_context *context = run->context;
    const size_t runs = (size_t)run->frame->blocks * (size_t)run->frame->height;
    if (!run->candidates) /* the first octave is the largest */
        run->candidates = asj_allocate(&context->memory, runs, sizeof *run->candidates);
    if (!run->candidates)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the candidates");
    if (run->size > 0) {
        asj_sizes_mark_candidates(run);
        return ASJ_OK;
    }
    asj_status status = run->options->seeds == ASJ_SEEDS_SEGMENTS
                            ? asj_seeds_mark(context, run->frame, run->options, run->candidates)
                            : find_in_field(run);
    if (status == ASJ_OK && run->region)
        status = asj_region_clear_candidates(run);
    return status == ASJ_OK && context->options.dump ? dump(run) : status;
}
