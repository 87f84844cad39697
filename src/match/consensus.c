/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, agreement between neighbouring matches.
 *
 * In rooms one corner looks like another, so appearance alone leaves several partners to choose from. But each candidate carries an
 * affine map, which says where its neighbours must be and how they must be distorted. True candidates agree with their true
 * neighbours; false ones agree with nothing, or with fewer. No epipolar geometry is estimated: agreement is asked for between
 * near neighbours only, where a surface is nearly flat, and along edges, and it has to be rough only (agreement.c).
 *
 * Relaxation labelling (Rosenfeld, Hummel and Zucker 1976), a few Jacobi steps. With a = (least distance among the competitors /
 * own distance)^2 x similarity, competitors being the candidates of the same place in either image:
 *
 *     support = half the sum, over the nearest places in image 1 and in image 2, of the largest w x confidence of their candidates,
 *     score = a (0.2 + support),     confidence = score / max(score of the best competitor, needed support),
 *
 * so that a place counts once, and places where nothing is sure hardly count. Support is needed in proportion to the
 * number of neighbours that can be asked, because so grows what chance supplies: minimum_support when all `neighbours` are
 * there, less in an image with fewer corners. */
#include "consensus.h"

#include <math.h>
#include <string.h>

#define BASE 0.2f /* lets appearance lead the first step; between 0.1 and 0.4 it changes nothing */
#define STEPS 5   /* word travels that far from corner to corner; 4 or 8 change one match in two hundred */

/* One image's half of the graph. */
typedef struct half {
    const asj_corners *corners;
    asj_place_index index;
    float *best; /* of each place */
} half;

static uint32_t place_of(const half *h, const asj_candidate *c, int32_t side)
{
    return h->corners->place[side == 1 ? c->i : c->j];
}

static asj_status half_create(asj_context *context, const asj_corners *corners, const asj_candidates *candidates, int32_t side,
                              half *h)
{
    h->corners = corners;
    asj_status status = asj_place_index_create(context, corners, candidates, side, 0, &h->index);
    if (status != ASJ_OK)
        return status;
    h->best = asj_allocate(&context->memory, corners->place_count, sizeof *h->best);
    return h->best ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %u places", (unsigned)corners->place_count);
}

static void half_free(asj_memory *memory, half *h)
{
    asj_place_index_free(memory, &h->index);
    asj_release(memory, h->best);
}

/* Sum over the neighbour places of the largest weight x confidence. */
static float sum_up(const asj_supporters *h, uint32_t number, const float *confidence)
{
    const asj_supporter *v = h->list + h->offset[number - 1], *end = v + h->count[number - 1];
    float support = 0;
    while (v < end) {
        const uint16_t place = v->place;
        float largest = 0;
        for (; v < end && v->place == place; v++) {
            float value = (float)v->weight * confidence[v->number];
            largest = value > largest ? value : largest;
        }
        support += largest;
    }
    return support * (1 / ASJ_SUPPORT_ONE);
}

/* best[place] = the largest (sign 1) or smallest (sign -1) value of the place's candidates. */
static void best_of_places(half *h, const float *value, float sign)
{
    for (uint32_t p = 0; p < h->corners->place_count; p++) {
        float best = -HUGE_VALF;
        for (uint32_t m = h->index.start[p]; m < h->index.start[p + 1]; m++) {
            float v = sign * value[h->index.order[m]];
            best = v > best ? v : best;
        }
        h->best[p] = sign * best;
    }
}

/* a: how well the candidate looks, against its competitors. `scratch` holds one number for each candidate. */
static void rate(const asj_candidates *candidates, int32_t aligned, half halves[2], float *scratch, float *appearance)
{
    for (size_t k = 0; k < candidates->count; k++)
        scratch[k] = candidates->list[k].distance2;
    for (int s = 0; s < 2; s++)
        best_of_places(&halves[s], scratch, -1);
    for (size_t k = 0; k < candidates->count; k++) {
        const asj_candidate *c = &candidates->list[k];
        float b1 = halves[0].best[place_of(&halves[0], c, 1)], b2 = halves[1].best[place_of(&halves[1], c, 2)];
        float least = b1 < b2 ? b1 : b2;
        float similarity = !aligned ? 1 : c->similarity > 1e-3f ? c->similarity : 1e-3f;
        appearance[k] = least > 0 ? least / c->distance2 * similarity : c->distance2 > 0 ? 0 : similarity;
    }
}

/* How many neighbours of one image are asked, but at least one: a match that stands alone has no support. */
static uint32_t asked(const asj_corners *corners, uint32_t limit)
{
    const uint32_t others = corners->place_count > 2 ? corners->place_count - 1 : 1;
    return others < limit ? others : limit;
}

float asj_needed_support(const asj_match_options *options, const asj_corners *corners1, const asj_corners *corners2)
{
    const uint32_t limit = (uint32_t)options->neighbours;
    const double share = limit > 0 ? (asked(corners1, limit) + asked(corners2, limit)) / (2.0 * limit) : 1;
    return (float)(options->minimum_support * share);
}

/* What the graph holds for each candidate: appearance and score in the order of the list, confidence by number. */
typedef struct ratings {
    float *appearance, *score, *confidence;
} ratings;

static void relax(asj_context *context, const asj_match_options *options, asj_candidates *candidates, half halves[2],
                  const asj_support *supporters, const ratings *r)
{
    const int64_t count = (int64_t)candidates->count;
    const float needed = asj_needed_support(options, halves[0].corners, halves[1].corners), least = needed > 1e-6f ? needed : 1e-6f;
    (void)context; /* without OpenMP */
    for (int64_t k = 0; k < count; k++)
        r->confidence[candidates->list[k].number - 1] = r->appearance[k];
    for (int step = 0; step < STEPS; step++) {
#pragma omp parallel for num_threads(context->threads) schedule(static)
        for (int64_t k = 0; k < count; k++) {
            asj_candidate *c = &candidates->list[k];
            const float in1 = sum_up(&supporters->side[0], c->number, r->confidence);
            const float in2 = sum_up(&supporters->side[1], c->number, r->confidence);
            c->support = (in1 + in2) * 0.5f;
            c->score = r->score[k] = r->appearance[k] * (BASE + c->support);
        }
        best_of_places(&halves[0], r->score, 1);
        best_of_places(&halves[1], r->score, 1);
        for (int64_t k = 0; k < count; k++) {
            const asj_candidate *c = &candidates->list[k];
            float b1 = halves[0].best[place_of(&halves[0], c, 1)], b2 = halves[1].best[place_of(&halves[1], c, 2)];
            float best = b1 > b2 ? b1 : b2;
            r->confidence[c->number - 1] = r->score[k] / (best > least ? best : least);
        }
    }
}

static asj_status agree(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                        asj_candidates *candidates, const asj_support *supporters)
{
    asj_memory *memory = &context->memory;
    const size_t count = candidates->count;
    half halves[2];
    memset(halves, 0, sizeof halves);
    float *block = asj_allocate(memory, count, 3 * sizeof *block);
    asj_status status = block ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    for (int32_t s = 0; s < 2 && status == ASJ_OK; s++)
        status = half_create(context, s == 0 ? &view1->corners : &view2->corners, candidates, s + 1, &halves[s]);
    if (status == ASJ_OK) {
        const ratings r = {block, block + count, block + 2 * count};
        rate(candidates, options->align_iterations > 0, halves, r.score, r.appearance);
        relax(context, options, candidates, halves, supporters, &r);
    }
    for (int s = 0; s < 2; s++)
        half_free(memory, &halves[s]);
    asj_release(memory, block);
    return status;
}

asj_status asj_consensus(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         asj_candidates *candidates, asj_support *supporters)
{
    if (options->neighbours == 0) {
        for (size_t k = 0; k < candidates->count; k++) {
            asj_candidate *c = &candidates->list[k];
            c->support = 0;
            c->score = 1 / sqrtf(c->distance2 > 1e-12f ? c->distance2 : 1e-12f);
        }
        return ASJ_OK;
    }
    const asj_status status = asj_support_extend(context, options, view1, view2, candidates, supporters);
    return status == ASJ_OK ? agree(context, options, view1, view2, candidates, supporters) : status;
}
