/* SPDX-License-Identifier: BSD-2-Clause */
/* Finalists whose focal length is found with them (focal.c): the motion that tells it, the others that there are with it, and a
 * camera that only turns, where that outdoes them, with a focal length of its own. */
#include "focal_finalists.h"
#include "geometry_options.h"

#include <math.h>

#define WORTH_A_LOOK 0.6 /* of a motion's evidence, that of a homography which may be a rotation */

/* A camera that only turns: where homographies explain anything like as much as the motion that was found. */
static asj_status search_focal_of_rotation(asj_estimation *e, const asj_model *flat, int32_t count)
{
    const asj_model *rotation = &e->rotation_focal.model;
    double most = -HUGE_VAL;
    for (int32_t k = 0; k < count; k++)
        most = fmax(most, flat[k].evidence);
    if (!(most > WORTH_A_LOOK * e->focal.model.evidence))
        return ASJ_OK;
    asj_status status = asj_find_focal_of_rotation(e->focal_search, flat, count, &e->focal.model, &e->rotation_focal);
    if (status == ASJ_OK)
        status = asj_focal_search_turn(e->focal_search, &e->focal); /* back */
    if (status != ASJ_OK || !e->rotation_focal.is_known || !rotation->settled || !asj_estimation_is_outdone(e, rotation))
        return status;
    e->finalists[e->count++] = *rotation;
    return asj_focal_search_turn(e->focal_search, &e->rotation_focal);
}

/* Homographies that are no finalists themselves, where only motions are asked for. */
static asj_status search_flat(asj_estimation *e, asj_model flat[ASJ_FINALISTS], int32_t *count)
{
    const asj_search search = asj_estimation_plan(e, ASJ_GEOMETRY_HOMOGRAPHY, 0);
    return asj_geometry_search(e->context, &e->set, &search, flat, count);
}

asj_status asj_find_focal_finalists(asj_estimation *e, const asj_geometry_hints *hints)
{
    const asj_search search = asj_estimation_plan(e, ASJ_GEOMETRY_ESSENTIAL, 0);
    const double sd = e->options->focal_sd;
    asj_model flat[ASJ_FINALISTS];
    int32_t count = 0, more = 0;
    for (int32_t k = 0; k < e->count && count < ASJ_FINALISTS; k++)
        if (e->finalists[k].kind == ASJ_GEOMETRY_HOMOGRAPHY)
            flat[count++] = e->finalists[k];
    const int32_t starts = count;
    asj_status status = asj_focal_search_create(e->context, &e->set, hints, &search, sd, &e->focal_search);
    if (status == ASJ_OK && !asj_asks_homographies(e->options))
        status = search_flat(e, flat, &count);
    if (status == ASJ_OK) {
        asj_focal_search_flat(e->focal_search, flat, count);
        status = asj_find_focal(e->focal_search, flat, starts, &e->focal);
    }
    if (status != ASJ_OK || !(e->focal.model.evidence > -HUGE_VAL))
        return status;
    e->focal_at = e->count;
    e->finalists[e->count++] = e->focal.model;
    if (e->focal.is_known)
        status = asj_find_with_focal(e->focal_search, &e->focal, flat, starts, e->finalists + e->count, &more);
    e->count += more;
    return status == ASJ_OK ? search_focal_of_rotation(e, flat, count) : status;
}
