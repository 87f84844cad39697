/* SPDX-License-Identifier: BSD-2-Clause */
/* What else may explain the images. Things that repeat or look the same when they are turned (tiles, a window upside down) make
 * geometries that are wrong with dozens of exact matches, and the right one beside them may have no more. A search for the best
 * does not come upon its rivals: whatever it starts from slides back to the best, and its variants fill the list. So they are
 * looked for by themselves, as if the candidates that the best one explains were known to be wrong: their priors are reduced by
 * their probabilities. (Elsewhere inliers are taken away to find a second motion: sequential RANSAC.) Samples are drawn most from
 * the places that the best one has matched, since a rival gives them other partners. What is found is judged by all candidates
 * again, and the best of that becomes what the candidates allow around it (posterior.c). */
#include "rivals.h"
#include "core/threads.h"
#include "evidence.h"
#include "motions.h"
#include "posterior.h"
#include "stop.h"

#include <math.h>
#include <string.h>

#define FOLLOWED 0.2 /* of the evidence of the best one: less makes nothing ambiguous (ambiguity.c) */
#define ELSEWHERE 0.1 /* how much a place counts that is not matched */

/* Priors without what the best one explains (kept: the former ones), and how much each candidate is to be drawn. */
static void mask(asj_pairs *set, const asj_model *best, asj_adjust_scratch *scratch, double *kept, double *weights)
{
    double *const *matched = scratch->score.sum;
    asj_probabilities(set, &best->view, 1, &scratch->score, weights);
    for (int32_t k = 0; k < set->count; k++) {
        matched[0][set->list[k].place1] += weights[k];
        matched[1][set->list[k].place2] += weights[k];
    }
    for (int32_t k = 0; k < set->count; k++) {
        asj_pair *c = &set->list[k];
        kept[k] = c->prior;
        c->prior *= 1 - weights[k];
        weights[k] = (ELSEWHERE + fmin(1, matched[0][c->place1])) * (ELSEWHERE + fmin(1, matched[1][c->place2]));
    }
    for (int32_t v = 0; v < 2; v++)
        memset(matched[v], 0, (size_t)set->place_count[v] * sizeof *matched[v]);
}

static void unmask(asj_pairs *set, const double *kept)
{
    for (int32_t k = 0; k < set->count; k++)
        set->list[k].prior = kept[k];
}

/* What a loop over rivals works on. */
typedef struct job {
    const asj_pairs *set;
    asj_adjust_scratch *scratch; /* for each thread */
    asj_model *rivals;
} job;

static void judge_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++)
        j->rivals[n].evidence = asj_pairs_stop(j->set, part)
                                    ? -HUGE_VAL : asj_log_evidence(j->set, &j->rivals[n], &j->scratch[part->thread]);
}

/* Evidence from all candidates; the best one is followed unless it is far from being as good as `least`. scratch: one for each
 * thread. */
static void judge(asj_context *context, const asj_pairs *set, uint64_t seed, asj_adjust_scratch *scratch, double least,
                  asj_model *rivals, int32_t count)
{
    const job j = {set, scratch, rivals};
    int32_t best = 0;
    asj_parallel(context, context->threads, count, 1, judge_some, &j);
    for (int32_t k = 0; k < count; k++)
        best = rivals[k].evidence > rivals[best].evidence ? k : best;
    if (count > 0 && rivals[best].evidence > least)
        asj_settle(context, set, seed, scratch, &rivals[best]);
}

/* Rooms look alike when they are turned by 90 degrees (tiles do so exactly), and variants of one such turn fill the lists: so the
 * best geometry of every other rotation that the images' directions allow is looked for by itself. `search` is of essential
 * matrices. */
static asj_status find_turned(asj_context *context, const asj_pairs *set, const asj_search *search, const asj_camera *cameras,
                              const asj_model *best, asj_model *rivals, int32_t *count)
{
    *count = 0;
    if (set->rotation_count == 0)
        return ASJ_OK;
    const double *except = asj_model_has_rotation(best) ? best->rotation : NULL;
    const asj_status status = asj_geometry_search_turned(context, set, search, except, rivals, count);
    return status == ASJ_OK ? asj_refine_motions(context, set, cameras, search->seed, 0, rivals, count) : status;
}

asj_status asj_find_rivals(asj_context *context, asj_pairs *set, const asj_search *kinds, int32_t kind_count,
                           const asj_camera *cameras, const asj_model *best, asj_model *rivals, int32_t *count)
{
    asj_memory *memory = &context->memory;
    double *kept = asj_allocate(memory, 2 * (size_t)set->count, sizeof *kept);
    asj_adjust_scratch *scratch = asj_adjust_scratches_create(memory, set, context->threads);
    asj_status status = kept && scratch ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a second geometry");
    *count = 0;
    if (status == ASJ_OK) {
        mask(set, best, &scratch[0], kept, kept + set->count);
        for (int32_t k = 0; k < kind_count && status == ASJ_OK; k++) {
            asj_search search = kinds[k];
            int32_t more = 0;
            search.weights = kept + set->count;
            search.samples = (search.samples + 1) / 2;
            search.brief = 1;
            status = asj_geometry_search(context, set, &search, rivals + *count, &more);
            *count += more;
        }
        if (status == ASJ_OK && cameras)
            status = asj_refine_motions(context, set, cameras, kinds[0].seed, 0, rivals, count);
        unmask(set, kept);
    }
    if (status == ASJ_OK && cameras) {
        int32_t more = 0;
        status = find_turned(context, set, &kinds[0], cameras, best, rivals + *count, &more);
        *count += more;
    }
    if (status == ASJ_OK)
        judge(context, set, kinds[0].seed, scratch, FOLLOWED * best->evidence, rivals, *count);
    asj_adjust_scratches_free(memory, scratch, context->threads);
    asj_release(memory, kept);
    return status;
}
