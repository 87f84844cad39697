/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, distances of all pairs.
 *
 * Canonical patches: f and g are unit vectors, so |f - g|^2 = 2 - 2 <f, g>. Of an L-junction with several length hypotheses the
 * best pair of frames counts. The best partners of every L-junction are short-listed (rank.c); ties go to the smaller index, so the
 * list depends on nothing but the input.
 *
 * Scores are whole numbers, so that any device ranks alike: <f, g> of unit vectors; 2 <f, g> - <f, f> - <g, g> of others, both in
 * units of 1/ASJ_UNIT_ONE^2; of the paper's patches (induced.c) minus the distance in 2^-16. */
#include "distance.h"
#include "descriptor.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int32_t asj_patch_length(const asj_match_options *options)
{
    return options->descriptor == ASJ_DESCRIPTOR_SIFT ? ASJ_SIFT_LENGTH : options->patch_size * options->patch_size;
}

int32_t asj_patch_units(const asj_match_options *options)
{
    return options->descriptor == ASJ_DESCRIPTOR_SIFT || options->normalise;
}

static void describe(const asj_match_options *options, const asj_pyramid *pyramid, const uint16_t *grey, int16_t *unit)
{
    if (options->descriptor == ASJ_DESCRIPTOR_SIFT)
        asj_descriptor_sift(grey, options->patch_size, unit);
    else if (options->normalise)
        pyramid->ops->patch->normalise(grey, options->patch_size, unit);
    else
        asj_patch_scale(grey, options->patch_size, unit);
}

asj_status asj_describe_frames(asj_context *context, const asj_match_options *options, asj_view *view)
{
    const size_t length = (size_t)asj_patch_length(options);
    const int64_t count = view->corners.frame_count;
    (void)context; /* without OpenMP */
#pragma omp parallel for num_threads(context->threads) schedule(static)
    for (int64_t f = 0; f < count; f++) {
        uint16_t grey[ASJ_PATCH_SAMPLES];
        view->usable[f] = (uint8_t)asj_patch_sample(&view->pyramid, &view->corners.frames[f], options->patch_size,
                                                    options->window_start, options->window_end, grey);
        describe(options, &view->pyramid, grey, view->patches + (size_t)f * length);
    }
    return ASJ_OK;
}

asj_status asj_describe(asj_context *context, const asj_match_options *options, asj_view *view)
{
    const size_t length = (size_t)asj_patch_length(options), count = view->corners.frame_count;
    view->device_copy = 0;
    view->patches = asj_allocate(&context->memory, count * length, sizeof *view->patches);
    view->usable = asj_allocate(&context->memory, count, sizeof *view->usable);
    if (!view->patches || !view->usable)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu patches", count);
    return context->ops->describe->frames(context, options, view);
}

static int32_t affinity(const asj_match_options *options, const int16_t *f, const int16_t *g, int32_t length)
{
    const int32_t product = asj_patch_product(f, g, length);
    return asj_patch_units(options) ? product : 2 * product - asj_patch_product(f, f, length) - asj_patch_product(g, g, length);
}

/* |f - g|^2 of a score. */
static float squared_distance(const asj_match_options *options, int32_t score)
{
    const float one = 1.0f / ((float)ASJ_UNIT_ONE * (float)ASJ_UNIT_ONE);
    const float distance2 = asj_patch_units(options) ? 2 - 2 * ((float)score * one) : -(float)score * one;
    return distance2 > 0 ? distance2 : 0;
}

int32_t asj_best_frames(const asj_match_options *options, const asj_view *view1, const asj_view *view2, uint32_t i, uint32_t j,
                        uint32_t *frame1, uint32_t *frame2)
{
    const int32_t length = asj_patch_length(options);
    const asj_corners *c1 = &view1->corners, *c2 = &view2->corners;
    int32_t best = ASJ_NO_PARTNER;
    for (uint32_t f = c1->first_frame[i]; f < c1->first_frame[i + 1]; f++) {
        if (!view1->usable[f])
            continue;
        const int16_t *patch = view1->patches + (size_t)f * (size_t)length;
        for (uint32_t g = c2->first_frame[j]; g < c2->first_frame[j + 1]; g++) {
            if (!view2->usable[g])
                continue;
            const int32_t score = affinity(options, patch, view2->patches + (size_t)g * (size_t)length, length);
            if (score > best) {
                best = score;
                *frame1 = f;
                *frame2 = g;
            }
        }
    }
    return best;
}

/* --- short lists ------------------------------------------------------------------------------------------------------------ */

static void clear(asj_partner *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        list[i] = (asj_partner){ASJ_NO_PARTNER, 0};
}

static int by_pair(const void *left, const void *right)
{
    const asj_candidate *p = left, *q = right;
    if (p->i != q->i)
        return p->i < q->i ? -1 : 1;
    return p->j < q->j ? -1 : p->j > q->j;
}

asj_status asj_candidates_sort(asj_candidates *candidates)
{
    if (candidates->count > 1)
        qsort(candidates->list, candidates->count, sizeof *candidates->list, by_pair);
    size_t kept = 0;
    for (size_t k = 0; k < candidates->count; k++)
        if (kept == 0 || by_pair(&candidates->list[k], &candidates->list[kept - 1]) != 0)
            candidates->list[kept++] = candidates->list[k];
    candidates->count = kept;
    return ASJ_OK;
}

/* The union of both lists as candidates. */
static asj_status collect(asj_context *context, size_t limit, const asj_partner *rows, uint32_t count1, const asj_partner *columns,
                          uint32_t count2, asj_candidates *candidates)
{
    const size_t most = ((size_t)count1 + count2) * limit;
    candidates->list = asj_allocate(&context->memory, most, sizeof *candidates->list);
    if (!candidates->list)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", most);
    candidates->capacity = most;
    candidates->count = 0;
    for (uint32_t n = 0; n < count1 + count2; n++) {
        const asj_partner *list = n < count1 ? rows + n * limit : columns + (n - count1) * limit;
        for (size_t k = 0; k < limit && list[k].score > ASJ_NO_PARTNER; k++) {
            asj_candidate *c = &candidates->list[candidates->count++];
            memset(c, 0, sizeof *c);
            c->i = n < count1 ? n : list[k].index;
            c->j = n < count1 ? list[k].index : n - count1;
        }
    }
    return asj_candidates_sort(candidates);
}

int32_t asj_compare(const asj_match_options *options, const asj_view *view1, const asj_view *view2, asj_candidate *candidate)
{
    const asj_corners *c1 = &view1->corners, *c2 = &view2->corners;
    uint32_t f = c1->first_frame[candidate->i], g = c2->first_frame[candidate->j];
    if (options->patches == ASJ_PATCHES_CANONICAL) {
        const int32_t score = asj_best_frames(options, view1, view2, candidate->i, candidate->j, &f, &g);
        if (score == ASJ_NO_PARTNER)
            return 0;
        candidate->distance2 = squared_distance(options, score);
    } else {
        float distance = asj_induced_distance(options, view1, view2, candidate->i, candidate->j);
        if (!(distance < HUGE_VALF))
            return 0;
        candidate->distance2 = distance * distance;
    }
    return asj_affine_between(&c1->frames[f], &c2->frames[g], &candidate->map);
}

asj_status asj_shortlist(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         asj_candidates *candidates)
{
    asj_memory *memory = &context->memory;
    const uint32_t count1 = view1->corners.count, count2 = view2->corners.count;
    const size_t limit = (size_t)options->shortlist;
    asj_partner *rows = asj_allocate(memory, count1 * limit, sizeof *rows);
    asj_partner *columns = asj_allocate(memory, count2 * limit, sizeof *columns);
    asj_status status;
    if (!rows || !columns) {
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the partners of %u and %u L-junctions", (unsigned)count1,
                          (unsigned)count2);
    } else {
        clear(rows, count1 * limit);
        clear(columns, count2 * limit);
        status = context->ops->rank->partners(context, options, view1, view2, rows, columns);
        if (status == ASJ_OK)
            status = collect(context, limit, rows, count1, columns, count2, candidates);
    }
    asj_release(memory, rows);
    asj_release(memory, columns);
    return status;
}

const asj_describe_ops asj_describe_reference = {.frames = asj_describe_frames};
