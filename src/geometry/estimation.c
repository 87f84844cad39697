/* SPDX-License-Identifier: BSD-2-Clause */
/* The best finalist, and how often chance brings one: NFA = kinds that were tried x exp(-evidence). */
#include "estimation.h"
#include "geometry_options.h"

#include <math.h>

int32_t asj_estimation_best(const asj_estimation *e, int32_t kind)
{
    int32_t best = -1;
    for (int32_t k = 0; k < e->count; k++)
        if ((kind == ASJ_GEOMETRY_AUTO || e->finalists[k].kind == kind) && e->finalists[k].evidence > -HUGE_VAL &&
            (best < 0 || e->finalists[k].evidence > e->finalists[best].evidence))
            best = k;
    return best;
}

const asj_camera *asj_estimation_cameras(const asj_estimation *e)
{
    if (asj_cameras_are_known(e->options))
        return e->options->cameras;
    return e->focal_at >= 0 && e->focal.is_known ? e->focal.model.cameras : NULL;
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

int32_t asj_has_found_focal(const asj_estimation *e, int32_t number)
{
    return e->focal_at >= 0 && e->finalists[number].kind == ASJ_GEOMETRY_ESSENTIAL;
}

double asj_estimation_log10_nfa(const asj_estimation *e, const asj_model *m)
{
    const double tried = e->options->model != ASJ_GEOMETRY_AUTO ? 1 : e->options->find_focal ? ASJ_MOST_KINDS : ASJ_MOST_KINDS - 1;
    return (log(tried) - m->evidence) / log(10);
}
