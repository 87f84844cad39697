/* SPDX-License-Identifier: BSD-2-Clause */
/* What is searched, the best finalist, and how often chance brings one: NFA = kinds that were tried x searches x exp(-evidence).
 *
 * Where that leaves it open, it counts how well the pictures agree (picture_agreement.c), since few geometries of unrelated rooms
 * have pictures that agree with them: of 114 with a log10 NFA from -1 to -130 of which pictures know something 4 have a share
 * above .6 and none above .65, with a mean of .3 and a standard deviation of .13. So chance brings a share above s, of
 * ASJ_LEAST_KNOWN nats or more, once in 10^(BY_SHARE (s - UNUSUAL)), as far as that was seen: once in 10^ASJ_MOST_BY_PICTURES at
 * most. */
#include "estimation.h"
#include "geometry_options.h"
#include "posterior.h"
#include "pure_rotation.h"
#include "core/decade.h"

#include <math.h>

/* Nats that a score loses at least on the way to an evidence: volume of the parameters, near places. Of 69 pairs of unrelated
 * images 46 stay below; of 46 accepted ones none is within 8 nats of it. */
#define GIVE_UP 17.0

#define MORE_SAMPLES 2 /* of the second search over the first */
#define UNUSUAL 0.5
#define BY_SHARE 15.0

int32_t asj_estimation_best(const asj_estimation *e, int32_t kind)
{
    int32_t best = -1;
    for (int32_t k = 0; k < e->count; k++)
        if ((kind == ASJ_GEOMETRY_AUTO || e->finalists[k].kind == kind) && asj_model_stands(&e->finalists[k]) &&
            (best < 0 || e->finalists[k].evidence > e->finalists[best].evidence))
            best = k;
    return best;
}

int32_t asj_estimation_best_rotation(const asj_estimation *e)
{
    for (int32_t k = 0; k < e->count; k++)
        if (asj_model_only_turns(&e->finalists[k]) && asj_model_stands(&e->finalists[k]))
            return k; /* there is one */
    return -1;
}

const asj_camera *asj_estimation_cameras(const asj_estimation *e)
{
    if (e->focal_at >= 0 && e->focal.is_known)
        return e->focal.model.cameras;
    return asj_cameras_are_known(e->options) ? e->options->cameras : NULL;
}

asj_search asj_estimation_plan(const asj_estimation *e, int32_t kind, int32_t again)
{
    const asj_geometry_options *o = e->options;
    const asj_camera *known = asj_estimation_cameras(e), *cameras = known ? known : o->cameras;
    asj_search search = {kind, again ? MORE_SAMPLES * o->samples : o->samples, again ? ~o->seed : o->seed, {cameras[0], cameras[1]},
                         GIVE_UP - log(o->epsilon), NULL, 0};
    for (int32_t v = 0; v < 2; v++)
        if (!asj_camera_is_known(&search.cameras[v])) {
            const double aspect = o->aspects[v], longer = fmax(o->widths[v], o->heights[v] / aspect);
            search.cameras[v] = (asj_camera){longer, longer * aspect, 0.5 * (o->widths[v] - 1), 0.5 * (o->heights[v] - 1)};
        }
    return search;
}

asj_status asj_estimation_refocus(asj_estimation *e, int32_t number)
{
    asj_focal found;
    const asj_status status = asj_find_focal_of(e->focal_search, &e->finalists[number], &found);
    if (status != ASJ_OK)
        return status;
    e->focal = found;
    e->focal_at = number;
    e->finalists[number] = found.model;
    return ASJ_OK;
}

int32_t asj_estimation_is_outdone(asj_estimation *e, const asj_model *rotation)
{
    const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_ESSENTIAL);
    return best < 0 || asj_rotation_outdoes(&e->set, rotation, &e->finalists[best], &e->scratch);
}

asj_status asj_estimation_settle(const asj_estimation *e, asj_model *model)
{
    asj_context *context = e->context;
    asj_adjust_scratch *scratch = asj_adjust_scratches_create(&context->memory, &e->set, context->threads);
    if (!scratch)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the spread of a motion");
    asj_settle(context, &e->set, e->options->seed, scratch, model);
    asj_adjust_scratches_free(&context->memory, scratch, context->threads);
    return ASJ_OK;
}

int32_t asj_has_found_focal(const asj_estimation *e, int32_t number)
{
    return e->focal_at >= 0 && e->finalists[number].kind == ASJ_GEOMETRY_ESSENTIAL;
}

double asj_estimation_log10_nfa(const asj_estimation *e, const asj_model *m)
{
    const int32_t blind = !e->options->find_focal && !asj_cameras_are_known(e->options); /* no motions, no turns */
    const double tried = e->options->model != ASJ_GEOMETRY_AUTO ? 1 : blind ? ASJ_MOST_KINDS - 1 : ASJ_MOST_KINDS;
    return (log(tried * (1 + e->again)) - m->evidence) / ASJ_LN_10;
}

int32_t asj_estimation_counts(const asj_estimation *e, int32_t number)
{
    const double most = log10(e->options->epsilon) + (e->pictures ? ASJ_MOST_BY_PICTURES : 0);
    return number >= 0 && asj_estimation_log10_nfa(e, &e->finalists[number]) <= most;
}

double asj_estimation_log10_agreement(asj_agreement agreement)
{
    if (!(agreement.known > ASJ_LEAST_KNOWN))
        return 0;
    return -fmin(ASJ_MOST_BY_PICTURES, fmax(0, BY_SHARE * (agreement.share - UNUSUAL)));
}
