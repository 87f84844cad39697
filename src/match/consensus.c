/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, agreement between neighbouring matches.
 *
 * In rooms one corner looks like another, so appearance alone leaves several partners to choose from. But each candidate carries an
 * affine map, which says where its neighbours must be and how they must be distorted. True candidates agree with their true
 * neighbours; false ones agree with nothing, or with fewer. No epipolar geometry is estimated: agreement is asked for between
 * near neighbours only, where a surface is nearly flat, and along edges, and it has to be rough only (agreement.c).
 *
 * Relaxation labelling (Rosenfeld, Hummel and Zucker 1976), a few Jacobi steps. With a = (least distance among the competitors /
 * own distance)^2 x similarity, competitors being the candidates of the same location in either image:
 *
 *     support = half the sum, over the nearest locations in image 1 and in image 2, of the largest w x confidence
 *               of their candidates, w their agreement (support.c),
 *     score = a (0.2 + support),     confidence = score / max(score of the best competitor, needed support),
 *
 * so that a location counts once, and locations where nothing is sure hardly count. Support is needed in proportion to the
 * number of neighbours that can be asked, because so grows what chance supplies: minimum_support when all `neighbours` are
 * there, less in an image with fewer corners. */
#include "consensus.h"
#include "support.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define BASE 0.2f /* lets appearance lead the first step; between 0.1 and 0.4 it changes nothing */
#define STEPS 5   /* word travels that far from corner to corner; 4 or 8 change one match in two hundred */
#define LEAST_SIMILARITY 1e-3f /* keeps the sign of what the alignment found unlike */
#define LEAST_NEEDED 1e-6f     /* a divisor, where no support is needed */
#define LEAST_DISTANCE2 1e-12f /* a divisor, without neighbours */
#define LEAST_CANDIDATES 256   /* for a thread */

/* One image's half of the graph. */
typedef struct half {
    const asj_l_junctions *l_junctions;
    asj_location_index index;
    float *best; /* of each location */
} half;

static float best_at(const half *h, const asj_candidate *c, int32_t side)
{
    return h->best[h->l_junctions->location[asj_candidate_l(c, side)]];
}

static asj_status half_create(const asj_match_run *run, int32_t side, half *h)
{
    h->l_junctions = &run->image[side]->l_junctions;
    asj_status status = asj_location_index_create(run, side, 0, &h->index);
    if (status != ASJ_OK)
        return status;
    const uint32_t count = h->l_junctions->location_count;
    h->best = asj_allocate(&run->context->memory, count, sizeof *h->best);
    return h->best ? ASJ_OK : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %u locations", (unsigned)count);
}

static void half_free(asj_memory *memory, half *h)
{
    asj_location_index_free(memory, &h->index);
    asj_release(memory, h->best);
}

/* Sum over the neighbour locations of the largest weight x confidence. */
static float sum_up(const asj_supporters *h, uint32_t number, const float *confidence)
{
    const asj_supporter *v = h->list + h->offset[number - 1], *end = v + h->count[number - 1];
    float support = 0;
    while (v < end) {
        const uint16_t neighbour = v->neighbour;
        float largest = 0;
        for (; v < end && v->neighbour == neighbour; v++) {
            float value = (float)v->weight * confidence[v->number];
            largest = value > largest ? value : largest;
        }
        support += largest;
    }
    return support * (1 / ASJ_SUPPORT_ONE);
}

/* best[location] = the largest (sign 1) or smallest (sign -1) value of the location's candidates. */
static void best_of_locations(half *h, const float *value, float sign)
{
    for (uint32_t p = 0; p < h->l_junctions->location_count; p++) {
        float best = -HUGE_VALF;
        for (uint32_t m = h->index.start[p]; m < h->index.start[p + 1]; m++) {
            float v = sign * value[h->index.order[m]];
            best = v > best ? v : best;
        }
        h->best[p] = sign * best;
    }
}

/* a: how well the candidate looks, against its competitors. `scratch` holds one number for each candidate. */
static void rate(const asj_match_run *run, half halves[2], float *scratch, float *appearance)
{
    const asj_candidates *candidates = &run->candidates;
    const int aligned = run->options->align_iterations > 0;
    for (size_t k = 0; k < candidates->count; k++)
        scratch[k] = candidates->list[k].distance2;
    for (int s = 0; s < 2; s++)
        best_of_locations(&halves[s], scratch, -1);
    for (size_t k = 0; k < candidates->count; k++) {
        const asj_candidate *c = &candidates->list[k];
        const float b1 = best_at(&halves[0], c, 0), b2 = best_at(&halves[1], c, 1), least = b1 < b2 ? b1 : b2;
        const float similarity = !aligned ? 1 : c->similarity > LEAST_SIMILARITY ? c->similarity : LEAST_SIMILARITY;
        appearance[k] = least > 0 ? least / c->distance2 * similarity : c->distance2 > 0 ? 0 : similarity;
    }
}

/* How many neighbours of one image are asked, but at least one: a match that stands alone has no support. */
static uint32_t asked(const asj_l_junctions *l_junctions, uint32_t limit)
{
    const uint32_t others = l_junctions->home_locations > 2 ? l_junctions->home_locations - 1 : 1;
    return others < limit ? others : limit;
}

float asj_needed_support(const asj_match_run *run)
{
    const uint32_t limit = (uint32_t)run->options->neighbours;
    const uint32_t all = asked(&run->image[0]->l_junctions, limit) + asked(&run->image[1]->l_junctions, limit);
    return limit > 0 ? (float)(run->options->minimum_support * (all / (2.0 * limit))) : 0;
}

/* What the graph holds for each candidate: appearance and score in the order of the list, confidence by number. */
typedef struct ratings {
    float *appearance, *score, *confidence;
} ratings;

typedef struct job {
    const asj_match_run *run;
    const ratings *r;
    asj_watch *watch;
} job;

static void rate_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t k = part->first; k < part->end && !asj_watch_stops(j->watch, part); k++) {
        asj_candidate *c = &j->run->candidates.list[k];
        const float in1 = sum_up(&j->run->support.side[0], c->number, j->r->confidence);
        const float in2 = sum_up(&j->run->support.side[1], c->number, j->r->confidence);
        c->support = (in1 + in2) * 0.5f;
        c->score = j->r->score[k] = j->r->appearance[k] * (BASE + c->support);
    }
}

static asj_status relax(asj_match_run *run, half halves[2], const ratings *r)
{
    asj_candidate *list = run->candidates.list;
    const int64_t count = (int64_t)run->candidates.count;
    asj_watch watch;
    const job j = {run, r, &watch};
    const float needed = asj_needed_support(run), least = needed > LEAST_NEEDED ? needed : LEAST_NEEDED;
    for (int64_t k = 0; k < count; k++)
        r->confidence[list[k].number - 1] = r->appearance[k];
    asj_watch_start(&watch, run->context, ASJ_STAGE_ASSIGN);
    for (int step = 0; step < STEPS && !watch.stopped; step++) {
        asj_parallel(run->context, asj_threads_for(run->context, count, LEAST_CANDIDATES), count, 0, rate_some, &j);
        best_of_locations(&halves[0], r->score, 1);
        best_of_locations(&halves[1], r->score, 1);
        for (int64_t k = 0; k < count; k++) {
            const float b1 = best_at(&halves[0], &list[k], 0), b2 = best_at(&halves[1], &list[k], 1), best = b1 > b2 ? b1 : b2;
            r->confidence[list[k].number - 1] = r->score[k] / (best > least ? best : least);
        }
    }
    return asj_watch_end(&watch);
}

static void score_alone(asj_candidates *candidates)
{
    for (size_t k = 0; k < candidates->count; k++) {
        asj_candidate *c = &candidates->list[k];
        c->support = 0;
        c->score = 1 / sqrtf(c->distance2 > LEAST_DISTANCE2 ? c->distance2 : LEAST_DISTANCE2);
    }
}

asj_status asj_consensus(asj_match_run *run)
{
    if (run->options->neighbours == 0) {
        score_alone(&run->candidates);
        return ASJ_OK;
    }
    asj_memory *memory = &run->context->memory;
    const size_t count = run->candidates.count;
    half halves[2];
    memset(halves, 0, sizeof halves);
    float *block = asj_allocate(memory, count, 3 * sizeof *block);
    asj_status status = block ? ASJ_OK : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++)
        status = half_create(run, side, &halves[side]);
    if (status == ASJ_OK) {
        const ratings r = {block, block + count, block + 2 * count};
        rate(run, halves, r.score, r.appearance);
        status = relax(run, halves, &r);
    }
    for (int side = 0; side < 2; side++)
        half_free(memory, &halves[side]);
    asj_release(memory, block);
    return status;
}
