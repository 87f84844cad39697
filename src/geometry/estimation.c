/* SPDX-License-Identifier: BSD-2-Clause */
/* The best finalist, and how often chance brings one: NFA = kinds that were tried x exp(-evidence). */
#include "estimation.h"

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

double asj_estimation_log10_nfa(const asj_estimation *e, const asj_model *m)
{
    const double tried = e->options->model != ASJ_GEOMETRY_AUTO ? 1 : e->options->find_focal ? ASJ_MOST_KINDS : ASJ_MOST_KINDS - 1;
    return (log(tried) - m->evidence) / log(10);
}
