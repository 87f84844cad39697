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
 * so that a place speaks with one voice, and places where nothing is sure hardly speak. Support is needed in proportion to the
 * number of neighbours that can be asked, because so grows what chance supplies: minimum_support when all `neighbours` are
 * there, less in an image with fewer corners. */
#include "consensus.h"

#include <math.h>
#include <string.h>

#define BASE 0.2f /* lets appearance lead the first step; between 0.1 and 0.4 it changes nothing */
#define STEPS 5   /* word travels that far from corner to corner; 4 or 8 change one match in two hundred */
#define WEIGHT_ONE 65535.0f /* agreement 1 in 16 bits */

asj_status asj_place_index_create(asj_context *context, const asj_corners *corners, const asj_candidates *candidates, int32_t side,
                                  asj_place_index *index)
{
    index->start = asj_allocate_zero(&context->memory, (size_t)corners->place_count + 2, sizeof *index->start);
    index->order = asj_allocate(&context->memory, candidates->count, sizeof *index->order);
    if (!index->start || !index->order)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for an index of %zu candidates", candidates->count);
    for (size_t k = 0; k < candidates->count; k++)
        index->start[corners->place[side == 1 ? candidates->list[k].i : candidates->list[k].j] + 2]++;
    for (uint32_t p = 2; p < corners->place_count + 2; p++)
        index->start[p] += index->start[p - 1];
    for (size_t k = 0; k < candidates->count; k++)
        index->order[index->start[corners->place[side == 1 ? candidates->list[k].i : candidates->list[k].j] + 1]++] = (uint32_t)k;
    return ASJ_OK;
}

void asj_place_index_free(asj_memory *memory, asj_place_index *index)
{
    asj_release(memory, index->start);
    asj_release(memory, index->order);
    index->start = index->order = NULL;
}

/* --- relaxation ------------------------------------------------------------------------------------------------------------- */

/* A neighbour that agrees. */
typedef struct voice {
    uint32_t position; /* in the order of the place index */
    uint16_t weight;   /* agreement in 1/65535; not 0 */
    uint16_t place;    /* which of the neighbour places it belongs to */
} voice;

/* Where a candidate stands, for a first look at many: x, y in image 1, x, y in image 2. */
typedef struct spot {
    double at[4];
} spot;

/* One image's half of the graph. Most pairs that are looked at do not agree at all: only the others are stored, candidate by
 * candidate, neighbour place by neighbour place, in the order of the place index. */
typedef struct half {
    const asj_corners *corners;
    asj_place_index index;
    size_t *offset;      /* candidate k hears voices[offset[k]] .. voices[offset[k] + heard[k] - 1] */
    uint32_t *heard;
    voice *voices;
    spot *spots;         /* in the order of the place index */
    float *confidence;   /* likewise */
    uint32_t *position;  /* of each candidate there */
    float *best;         /* of each place */
} half;

static uint32_t place_of(const half *h, const asj_candidate *c, int32_t side)
{
    return h->corners->place[side == 1 ? c->i : c->j];
}

static spot spot_of(const asj_view *view1, const asj_view *view2, const asj_candidate *c)
{
    const asj_l_junction *l1 = &view1->corners.l[c->i], *l2 = &view2->corners.l[c->j];
    return (spot){{(double)l1->x, (double)l1->y, (double)l2->x, (double)l2->y}};
}

/* What candidate k hears goes to `voices`; returns how many they are. */
static uint32_t hear_one(const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         const asj_candidates *candidates, int32_t side, const half *h, size_t k, voice *voices)
{
    const asj_candidate *c = &candidates->list[k];
    const spot here = spot_of(view1, view2, c);
    const uint32_t place = place_of(h, c, side);
    const uint32_t *neighbour = h->corners->neighbour + (size_t)place * h->corners->neighbour_limit;
    uint32_t count = 0;
    for (uint32_t n = 0; n < h->corners->neighbour_count[place]; n++) {
        const double x = h->corners->place_x[neighbour[n]] - here.at[2 * side - 2];
        const double y = h->corners->place_y[neighbour[n]] - here.at[2 * side - 1];
        const uint32_t edges = asj_edges_through(h->corners, side == 1 ? c->i : c->j, 3, x, y);
        for (uint32_t m = h->index.start[neighbour[n]]; m < h->index.start[neighbour[n] + 1]; m++) {
            const double *there = h->spots[m].at;
            const asj_way way = {there[0] - here.at[0], there[1] - here.at[1], there[2] - here.at[2], there[3] - here.at[3]};
            const uint32_t shared = side == 1 ? asj_edges_through(&view2->corners, c->j, edges, way.x2, way.y2)
                                              : asj_edges_through(&view1->corners, c->i, edges, way.x1, way.y1);
            const asj_candidate *d = &candidates->list[h->index.order[m]];
            float w = asj_way_misses(options, c, &way) ? 0 : asj_surface_agreement(options, view1, view2, c, d);
            const float v = shared ? asj_edge_agreement(options, view1, view2, c, d) : 0;
            w = v > w ? v : w;
            const uint16_t weight = (uint16_t)(w * WEIGHT_ONE);
            if (weight == 0)
                continue;
            voices[count++] = (voice){m, weight, (uint16_t)n};
        }
    }
    return count;
}

/* Room for all that candidates may hear, then what they do hear. */
static asj_status hear(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                       const asj_candidates *candidates, int32_t side, half *h)
{
    const size_t count = candidates->count;
    size_t total = 0;
    for (size_t k = 0; k < count; k++) {
        const uint32_t place = place_of(h, &candidates->list[k], side);
        const uint32_t *neighbour = h->corners->neighbour + (size_t)place * h->corners->neighbour_limit;
        h->offset[k] = total;
        for (uint32_t n = 0; n < h->corners->neighbour_count[place]; n++)
            total += h->index.start[neighbour[n] + 1] - h->index.start[neighbour[n]];
    }
    h->voices = asj_allocate(&context->memory, total, sizeof *h->voices);
    if (!h->voices)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu pairs of candidates", total);
#pragma omp parallel for num_threads(context->threads) schedule(dynamic, 64)
    for (int64_t k = 0; k < (int64_t)count; k++)
        h->heard[k] = hear_one(options, view1, view2, candidates, side, h, (size_t)k, h->voices + h->offset[k]);
    return ASJ_OK;
}

static asj_status half_create(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                              const asj_candidates *candidates, int32_t side, half *h)
{
    asj_memory *memory = &context->memory;
    const size_t count = candidates->count;
    h->corners = side == 1 ? &view1->corners : &view2->corners;
    asj_status status = asj_place_index_create(context, h->corners, candidates, side, &h->index);
    if (status != ASJ_OK)
        return status;
    h->offset = asj_allocate(memory, count, sizeof *h->offset);
    h->heard = asj_allocate(memory, count, sizeof *h->heard);
    h->spots = asj_allocate(memory, count, sizeof *h->spots);
    h->confidence = asj_allocate(memory, count, sizeof *h->confidence);
    h->position = asj_allocate(memory, count, sizeof *h->position);
    h->best = asj_allocate(memory, h->corners->place_count, sizeof *h->best);
    if (!h->offset || !h->heard || !h->spots || !h->confidence || !h->position || !h->best)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    for (size_t k = 0; k < count; k++) {
        h->position[h->index.order[k]] = (uint32_t)k;
        h->spots[k] = spot_of(view1, view2, &candidates->list[h->index.order[k]]);
    }
    return hear(context, options, view1, view2, candidates, side, h);
}

static void half_free(asj_memory *memory, half *h)
{
    asj_place_index_free(memory, &h->index);
    asj_release(memory, h->offset);
    asj_release(memory, h->heard);
    asj_release(memory, h->spots);
    asj_release(memory, h->voices);
    asj_release(memory, h->confidence);
    asj_release(memory, h->position);
    asj_release(memory, h->best);
}

/* Sum over the neighbour places of the largest weight x confidence. */
static float ask(const half *h, size_t k)
{
    const voice *v = h->voices + h->offset[k], *end = v + h->heard[k];
    float support = 0;
    while (v < end) {
        const uint16_t place = v->place;
        float largest = 0;
        for (; v < end && v->place == place; v++) {
            float loud = (float)v->weight * h->confidence[v->position];
            largest = loud > largest ? loud : largest;
        }
        support += largest;
    }
    return support * (1 / WEIGHT_ONE);
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

static void set_confidence(const asj_candidates *candidates, half halves[2], const float *confidence)
{
    for (size_t k = 0; k < candidates->count; k++)
        for (int s = 0; s < 2; s++)
            halves[s].confidence[halves[s].position[k]] = confidence[k];
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

static void relax(asj_context *context, const asj_match_options *options, asj_candidates *candidates, half halves[2],
                  const float *appearance, float *score)
{
    const int64_t count = (int64_t)candidates->count;
    const float needed = asj_needed_support(options, halves[0].corners, halves[1].corners), least = needed > 1e-6f ? needed : 1e-6f;
    (void)context; /* without OpenMP */
    set_confidence(candidates, halves, appearance);
    for (int step = 0; step < STEPS; step++) {
#pragma omp parallel for num_threads(context->threads) schedule(static)
        for (int64_t k = 0; k < count; k++) {
            asj_candidate *c = &candidates->list[k];
            c->support = (ask(&halves[0], (size_t)k) + ask(&halves[1], (size_t)k)) * 0.5f;
            c->score = appearance[k] * (BASE + c->support);
        }
        for (int64_t k = 0; k < count; k++)
            score[k] = candidates->list[k].score;
        best_of_places(&halves[0], score, 1);
        best_of_places(&halves[1], score, 1);
        for (int64_t k = 0; k < count; k++) {
            const asj_candidate *c = &candidates->list[k];
            float b1 = halves[0].best[place_of(&halves[0], c, 1)], b2 = halves[1].best[place_of(&halves[1], c, 2)];
            float best = b1 > b2 ? b1 : b2;
            score[k] /= best > least ? best : least;
        }
        set_confidence(candidates, halves, score);
    }
}

asj_status asj_consensus(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         asj_candidates *candidates)
{
    asj_memory *memory = &context->memory;
    if (options->neighbours == 0) {
        for (size_t k = 0; k < candidates->count; k++) {
            asj_candidate *c = &candidates->list[k];
            c->support = 0;
            c->score = 1 / sqrtf(c->distance2 > 1e-12f ? c->distance2 : 1e-12f);
        }
        return ASJ_OK;
    }
    half halves[2];
    memset(halves, 0, sizeof halves);
    float *appearance = asj_allocate(memory, candidates->count, sizeof *appearance);
    float *scratch = asj_allocate(memory, candidates->count, sizeof *scratch);
    asj_status status = appearance && scratch ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates",
                                                                  candidates->count);
    for (int32_t s = 0; s < 2 && status == ASJ_OK; s++)
        status = half_create(context, options, view1, view2, candidates, s + 1, &halves[s]);
    if (status == ASJ_OK) {
        rate(candidates, options->align_iterations > 0, halves, scratch, appearance);
        relax(context, options, candidates, halves, appearance, scratch);
    }
    for (int s = 0; s < 2; s++)
        half_free(memory, &halves[s]);
    asj_release(memory, appearance);
    asj_release(memory, scratch);
    return status;
}
