/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_geometry_estimate(): two-view geometry from candidate matches with affine maps.
 *
 *   pairs.c       candidates -> places, priors
 *   search.c      samples (minimal.c, five_point.c), scores (score.c), refinement (adjust.c)
 *   motions.c     essential matrices with planes (planes.c), and what the candidates allow around them (posterior.c)
 *   pure_rotation.c  a camera that only turns
 *   focal_finalists.c  the same for a row of focal lengths (focal.c), where none is known and it is asked for
 *   rivals.c      what explains as much without the candidates of the best one
 *   tiled_motions.c  where a floor of tiles may have been matched with other tiles: motions that see these
 *   evidence.c    how often chance brings as much
 *   strike_out.c  what is contradicted (contradiction.c: by colour_vote.c, picture_vote.c, picture_agreement.c, upright.c)
 *   ambiguity.c   whether another one may be right as well
 *   period.c      whether all that is matched repeats
 *   answer.c      which kind, and what is told of it
 *   model.c       what moves when a geometry moves */
#include "answer.h"
#include "estimate.h"
#include "estimation.h"
#include "focal_finalists.h"
#include "geometry_options.h"
#include "motions.h"
#include "pairs.h"
#include "pure_rotation.h"
#include "rivals.h"
#include "stop.h"
#include "strike_out.h"
#include "tiled_motions.h"

#include <math.h>
#include <string.h>

static asj_status search_kind(asj_estimation *e, int32_t kind, int32_t again)
{
    const asj_search search = asj_estimation_plan(e, kind, again);
    int32_t count = 0;
    const asj_status status = asj_geometry_search(e->context, &e->set, &search, e->finalists + e->count, &count);
    e->count += count;
    return status;
}

static asj_status search_pure_rotation(asj_estimation *e, const asj_camera cameras[2])
{
    int32_t found = 0;
    asj_model *rotation = &e->finalists[e->count];
    asj_status status = asj_find_pure_rotation(e->context, &e->set, cameras, e->finalists, e->count, rotation, &found);
    if (status == ASJ_OK && found)
        status = asj_estimation_settle(e, rotation);
    if (status == ASJ_OK && found && rotation->settled && asj_estimation_is_outdone(e, rotation))
        e->count++;
    return status;
}

/* What is searched: the kind with epipolar lines, ASJ_GEOMETRY_NONE for none; and homographies? */
static int32_t epipolar_kind(const asj_geometry_options *o)
{
    const int32_t best = asj_cameras_are_known(o) ? ASJ_GEOMETRY_ESSENTIAL : ASJ_GEOMETRY_FUNDAMENTAL;
    if (o->model == ASJ_GEOMETRY_AUTO)
        return best;
    return o->model == ASJ_GEOMETRY_FUNDAMENTAL || o->model == best ? o->model : ASJ_GEOMETRY_NONE;
}

static int32_t is_chance(const asj_estimation *e, int32_t number)
{
    return number < 0 || asj_estimation_log10_nfa(e, &e->finalists[number]) > log10(e->options->epsilon);
}

static asj_status search_kinds(asj_estimation *e, int32_t again)
{
    const asj_geometry_options *o = e->options;
    const int32_t epipolar = epipolar_kind(o), motions = epipolar == ASJ_GEOMETRY_ESSENTIAL && !asj_finds_focal(o);
    asj_status status = ASJ_OK;
    e->again = again;
    e->count = 0;
    if (motions || epipolar == ASJ_GEOMETRY_FUNDAMENTAL)
        status = search_kind(e, epipolar, again);
    if (status == ASJ_OK && asj_asks_homographies(o))
        status = search_kind(e, ASJ_GEOMETRY_HOMOGRAPHY, again);
    if (status == ASJ_OK && motions)
        status = asj_refine_motions(e->context, &e->set, o->cameras, o->seed, ASJ_SETTLED, e->finalists, &e->count);
    return status == ASJ_OK && motions ? search_pure_rotation(e, o->cameras) : status;
}

/* Of a geometry that few candidates tell, a thousand samples may miss all that is near it: the order of the images, which decides
 * what is drawn, then decided whether there is one (scannet0744). So before it is called chance it is looked for once more. */
static asj_status search_all(asj_estimation *e, const asj_geometry_hints *hints)
{
    const int32_t finds_focal = asj_finds_focal(e->options);
    asj_status status = search_kinds(e, 0);
    if (status == ASJ_OK && !finds_focal && is_chance(e, asj_estimation_best(e, ASJ_GEOMETRY_AUTO)))
        status = search_kinds(e, 1);
    return status == ASJ_OK && finds_focal ? asj_find_focal_finalists(e, hints) : status;
}

/* `more` that stand behind the finalists become some of them. */
static void add_finalists(asj_estimation *e, int32_t more)
{
    for (int32_t k = e->count; k < e->count + more; k++)
        if (asj_has_found_focal(e, k)) {
            e->finalists[k].evidence += e->focal.log_share;
            e->finalists[k].peak += e->focal.log_share;
        }
    e->count += more;
}

/* Only what is about to be accepted needs them. */
static asj_status search_rivals(asj_estimation *e)
{
    const asj_camera *cameras = asj_estimation_cameras(e);
    const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_AUTO);
    const int32_t found = best >= 0 && cameras && e->focal_at >= 0 && asj_model_has_rotation(&e->finalists[best]);
    const int32_t epipolar = found ? ASJ_GEOMETRY_ESSENTIAL : epipolar_kind(e->options);
    asj_search kinds[2];
    int32_t kind_count = 0, more = 0;
    if (!asj_estimation_counts(e, best))
        return ASJ_OK;
    if (epipolar != ASJ_GEOMETRY_NONE)
        kinds[kind_count++] = asj_estimation_plan(e, epipolar, 0);
    if (asj_asks_homographies(e->options))
        kinds[kind_count++] = asj_estimation_plan(e, ASJ_GEOMETRY_HOMOGRAPHY, 0);
    if (epipolar != ASJ_GEOMETRY_ESSENTIAL)
        cameras = NULL;
    const asj_status status = asj_find_rivals(e->context, &e->set, kinds, kind_count, cameras, &e->finalists[best],
                                              e->finalists + e->count, &more);
    add_finalists(e, more);
    return status;
}

static asj_status search_tiled_motions(asj_estimation *e)
{
    const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_AUTO);
    int32_t more = 0;
    if (!asj_estimation_counts(e, best))
        return ASJ_OK;
    const asj_status status = asj_find_tiled_motions(e, best, e->finalists + e->count, &more);
    add_finalists(e, more);
    return status;
}

asj_status asj_geometry_estimate(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                                 const asj_geometry_options *options, double *probabilities, asj_geometry *result)
{
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    context->progress = 0; /* a call of its own */
    if (!options || !result || (!candidates && count > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the candidates, the options or the result is NULL");
    const asj_status status = asj_geometry_options_check(context, options);
    if (status != ASJ_OK)
        return status;
    return asj_estimate_with_hints(context, candidates, count, NULL, options, probabilities, NULL, result);
}

static asj_status make_scratch(asj_estimation *e, const asj_geometry_hints *hints)
{
    asj_memory *memory = &e->context->memory;
    const int32_t *count = e->set.place_count, shown = hints && hints->pictures[0].channel_count > 0;
    e->first.probability = asj_allocate(memory, (size_t)e->set.count, sizeof *e->first.probability);
    e->other.probability = asj_allocate(memory, (size_t)e->set.count, sizeof *e->other.probability);
    e->elsewhere = asj_allocate(memory, (size_t)e->set.count, sizeof *e->elsewhere);
    e->vote = asj_allocate(memory, (size_t)(count[0] > count[1] ? count[0] : count[1]), 4 * sizeof *e->vote);
    e->pictures = shown ? asj_pictures_create(memory, hints->pictures, e->set.count) : NULL;
    if (e->first.probability && e->other.probability && e->elsewhere && e->vote && (e->pictures || !shown) &&
        asj_adjust_scratch_create(memory, &e->set, &e->scratch))
        return ASJ_OK;
    return asj_fail(e->context, ASJ_ERROR_MEMORY, "no memory for the geometry");
}

static void free_estimation(asj_estimation *e)
{
    asj_memory *memory = &e->context->memory;
    asj_adjust_scratch_free(memory, &e->scratch);
    asj_release(memory, e->first.probability);
    asj_release(memory, e->other.probability);
    asj_release(memory, e->elsewhere);
    asj_release(memory, e->vote);
    asj_pictures_free(memory, e->pictures);
    asj_focal_search_free(memory, e->focal_search);
    asj_pairs_free(memory, &e->set);
    asj_release(memory, e);
}

/* The steps above. */
static asj_status search(asj_estimation *e, const asj_geometry_hints *hints)
{
    asj_status status = make_scratch(e, hints);
    if (status == ASJ_OK)
        status = search_all(e, hints);
    if (status == ASJ_OK)
        status = search_rivals(e);
    if (status == ASJ_OK)
        status = search_tiled_motions(e);
    if (status == ASJ_OK)
        status = asj_strike_out(e);
    return status == ASJ_OK ? asj_watch_end(e->set.watch) : status;
}

/* Those of candidates that a geometry which is not chance speaks of; 0 of all others. */
static void tell_probabilities(const asj_estimation *e, const asj_geometry *found, size_t count, double *probabilities)
{
    const int32_t told = found->status == ASJ_GEOMETRY_ACCEPTED || asj_geometry_is_open(found);
    for (size_t k = 0; k < count; k++)
        probabilities[k] = 0;
    for (int32_t k = 0; k < e->set.count && told; k++)
        probabilities[e->set.list[k].source] = e->first.probability[k];
}

/* Nothing is written unless it ends well. */
static asj_status estimate(asj_estimation *e, const asj_geometry_hints *hints, asj_judge *judge, asj_geometry *found)
{
    if (e->set.place_count[0] < 2 || e->set.place_count[1] < 2) {
        found->status = ASJ_GEOMETRY_TOO_FEW;
        return ASJ_OK;
    }
    const asj_status status = search(e, hints);
    return status == ASJ_OK ? asj_answer(e, judge, found) : status;
}

asj_status asj_estimate_with_hints(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                                   const asj_geometry_hints *hints, const asj_geometry_options *options, double *probabilities,
                                   asj_judge *judge, asj_geometry *result)
{
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    asj_geometry found;
    memset(&found, 0, sizeof found);
    asj_estimation *e = asj_allocate_zero(&context->memory, 1, sizeof *e);
    if (!e)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the geometry");
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_ASSIGN);
    e->context = context;
    e->options = options;
    e->focal_at = -1;
    asj_status status = asj_pairs_create(context, candidates, count, hints, options, &e->set);
    e->set.watch = &watch;
    if (status == ASJ_OK && options->model != ASJ_GEOMETRY_NONE)
        status = estimate(e, hints, judge, &found);
    if (status == ASJ_OK && probabilities)
        tell_probabilities(e, &found, count, probabilities);
    free_estimation(e);
    if (status == ASJ_OK)
        *result = found;
    return status;
}
