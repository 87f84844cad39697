/* SPDX-License-Identifier: BSD-2-Clause */
/* One geometry judges the matches of both looks (looks.c): that of the upsampled images, or, where they have none or lose the pose,
 * that of the images. */
#include "upsampled_geometry.h"
#include "geometry_candidate.h"
#include "result_changes.h"

#include <math.h>
#include <string.h>

/* px from an epipolar line that may be: as far as either result has it for its own matches, which are of half a pixel or of one. */
static double farthest_of(const asj_match_result *by, const asj_match_result *judged)
{
    return fmax(asj_match_result_farthest(by), asj_match_result_farthest(judged));
}

/* Negative: contradicted. The rules are those of verdict.c for matches that were no candidates of the geometry. */
static float probability_of(const asj_match_result *by, double farthest, const asj_junction_match *m)
{
    const asj_known_geometry *known = asj_match_result_geometry(by);
    const double x1 = (double)m->x1, y1 = (double)m->y1, x2 = (double)m->x2, y2 = (double)m->y2, *h = m->affine;
    asj_geometry_candidate g = {0, 0, x1, y1, x2, y2, {h[0], h[1], h[3], h[4]}, ASJ_MATCH_RIGHT};
    if (known->lines_hold && asj_distance_from_line(&by->geometry, x1, y1, x2, y2) > farthest)
        return -1;
    if (!asj_keeps_area(g.affine))
        return 0;
    asj_stretch_candidate(&g, known->by);
    return (float)asj_judge_probability(&known->judge, &g);
}

/* keep_rejected: whatever it says of those that are rejected. */
static asj_status judge_by(asj_context *context, const asj_match_result *by, asj_match_result *judged, int32_t keep_rejected)
{
    const size_t count = judged->match_count, rejected_count = judged->rejected_count;
    if (!asj_match_result_geometry(by))
        return ASJ_OK;
    const double farthest = farthest_of(by, judged);
    float *probability = asj_allocate(&context->memory, count + rejected_count, sizeof *probability);
    if (!probability)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu matches", count + rejected_count);
    for (size_t k = 0; k < count; k++)
        probability[k] = probability_of(by, farthest, &judged->matches[k]);
    for (size_t k = 0; k < rejected_count; k++)
        probability[count + k] = keep_rejected ? -1 : probability_of(by, farthest, &judged->rejected[k]);
    const asj_status status = asj_match_result_judge(context, judged, probability, probability + count);
    asj_release(&context->memory, probability);
    return status;
}

asj_status asj_looks_judge(asj_context *context, const asj_match_result *by, asj_match_result *judged)
{
    const asj_known_geometry *known = asj_match_result_geometry(by);
    asj_own_result *r = (asj_own_result *)judged;
    const asj_status status = judge_by(context, by, judged, 0);
    judged->geometry = by->geometry;
    r->is_known = known != NULL;
    if (known)
        r->known = *known;
    return status;
}

/* A probability is one under a geometry that is accepted. */
static void forget_probabilities(asj_own_result *r)
{
    for (uint32_t k = 0; k < r->shown.match_count; k++)
        r->matches[k].probability = 0;
    for (size_t k = 0; k < r->shown.rejected_count; k++)
        r->rejected[k].probability = 0;
}

asj_status asj_looks_filter(asj_context *context, const asj_match_result *by, asj_match_result *judged)
{
    return judge_by(context, by, judged, 1);
}

void asj_looks_leave_open(const asj_geometry *own, const asj_geometry *upsampled, asj_match_result *result)
{
    forget_probabilities((asj_own_result *)result);
    ((asj_own_result *)result)->is_known = 0;
    result->geometry = *upsampled;
    result->geometry.status = ASJ_GEOMETRY_AMBIGUOUS;
    result->geometry.has_rival = 1;
    result->geometry.rival_log10_nfa = own->log10_nfa;
    memcpy(result->geometry.rival_rotation, own->rotation, sizeof own->rotation);
    memcpy(result->geometry.rival_translation, own->translation, sizeof own->translation);
}

/* Rivals of the matches of the upsampled images are many weak corners around them, of which the matcher has chosen one. As for
 * those that another geometry judges, what it has chosen has none. */
static void judge_without_rivals(asj_match_result *upsampled)
{
    asj_junction_match *matches = ((asj_own_result *)upsampled)->matches;
    for (uint32_t k = 0; k < upsampled->match_count; k++)
        matches[k].probability = fmaxf(matches[k].probability,
                                       probability_of(upsampled, farthest_of(upsampled, upsampled), &matches[k]));
}

asj_status asj_looks_judge_by_upsampled(asj_context *context, asj_match_result *own, asj_match_result *upsampled)
{
    const asj_geometry *a = &own->geometry, *b = &upsampled->geometry;
    if (b->status == ASJ_GEOMETRY_NOT_ASKED || (!asj_looks_is_answer(b) && asj_looks_is_answer(a)))
        upsampled->geometry = own->geometry;
    if (!asj_match_result_geometry(upsampled))
        return ASJ_OK;
    judge_without_rivals(upsampled);
    return asj_looks_judge(context, upsampled, own);
}
