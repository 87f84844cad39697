/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, the distance of a pair.
 *
 * Canonical patches: f and g are unit vectors, so |f - g|^2 = 2 - 2 <f, g>. Of an L-junction with several length hypotheses the
 * best pair of frames counts.
 *
 * For a geometry colours have a say where there are any (colour_patch.c).
 *
 * Scores are whole numbers, so that any device ranks alike: <f, g> of unit vectors; 2 <f, g> - <f, f> - <g, g> of others, both in
 * units of 1/ASJ_UNIT_ONE^2; of the paper's patches minus the distance (patch_induced.c). */
#include "compare.h"
#include "describe.h"
#include "patch_induced.h"
#include "core/watch.h"

#include <math.h>

static int32_t score_patches(const asj_match_options *options, const int16_t *f, const int16_t *g, int32_t length)
{
    const int32_t product = asj_patch_product(f, g, length);
    return asj_patch_units(options) ? product : 2 * product - asj_patch_product(f, f, length) - asj_patch_product(g, g, length);
}

/* |f - g|^2 of a score. */
static float squared_distance(const asj_match_options *options, int32_t score)
{
    const float one = 1.0f / ((float)ASJ_UNIT_ONE * (float)ASJ_UNIT_ONE);
    const float distance2 = asj_patch_units(options) ? 2 - 2 * ((float)score * one) : -(float)score * one;
    return distance2 > 0 ? distance2 : 0;
}

/* The product of grey levels and, as far as the more colourful one of both frames has a hue, of colours. */
static int32_t with_colours(const asj_match_run *run, uint32_t f, uint32_t g, int32_t score)
{
    const asj_colour_patches *in1 = &run->colours[0], *in2 = &run->colours[1];
    const int32_t weight = in1->hue[f] > in2->hue[g] ? in1->hue[f] : in2->hue[g];
    const int32_t product = asj_patch_product(in1->patch + (size_t)f * ASJ_COLOUR_PATCH_LENGTH,
                                              in2->patch + (size_t)g * ASJ_COLOUR_PATCH_LENGTH, ASJ_COLOUR_PATCH_LENGTH);
    return (int32_t)(((int64_t)ASJ_HUE_ONE * score + (int64_t)weight * product) / (ASJ_HUE_ONE + weight));
}

static asj_pair_score score_frames(const asj_match_run *run, uint32_t i, uint32_t j)
{
    const int32_t length = asj_patch_length(run->options);
    const asj_image_features *features1 = run->image[0], *features2 = run->image[1];
    const uint32_t *first1 = features1->l_junctions.first_frame, *first2 = features2->l_junctions.first_frame;
    asj_pair_score best = {ASJ_NO_PARTNER, first1[i], first2[j]};
    for (uint32_t f = first1[i]; f < first1[i + 1]; f++) {
        if (!features1->usable[f])
            continue;
        const int16_t *patch = asj_patch_at(features1, f, length);
        for (uint32_t g = first2[j]; g < first2[j + 1]; g++) {
            if (!features2->usable[g])
                continue;
            int32_t score = score_patches(run->options, patch, asj_patch_at(features2, g, length), length);
            if (run->colours[0].patch)
                score = with_colours(run, f, g, score);
            if (score > best.score)
                best = (asj_pair_score){score, f, g};
        }
    }
    return best;
}

asj_pair_score asj_score_pair(const asj_match_run *run, uint32_t i, uint32_t j)
{
    if (run->options->patches == ASJ_PATCHES_CANONICAL)
        return score_frames(run, i, j);
    return (asj_pair_score){asj_patch_induced_to_score(asj_patch_induced_distance(run, i, j)),
                            run->image[0]->l_junctions.first_frame[i], run->image[1]->l_junctions.first_frame[j]};
}

/* Fills distance2 and map; 0 when the pair gives no map. */
static int32_t compare(const asj_match_run *run, asj_candidate *c)
{
    const asj_l_junctions *l_junctions1 = &run->image[0]->l_junctions, *l_junctions2 = &run->image[1]->l_junctions;
    uint32_t f = l_junctions1->first_frame[c->i], g = l_junctions2->first_frame[c->j];
    if (run->options->patches == ASJ_PATCHES_CANONICAL) {
        const asj_pair_score best = score_frames(run, c->i, c->j);
        if (best.score == ASJ_NO_PARTNER)
            return 0;
        f = best.frame1;
        g = best.frame2;
        c->distance2 = squared_distance(run->options, best.score);
    } else {
        const float distance = asj_patch_induced_distance(run, c->i, c->j);
        if (!(distance < HUGE_VALF))
            return 0;
        c->distance2 = distance * distance;
    }
    return asj_affine_between(&l_junctions1->frames[f], &l_junctions2->frames[g], &c->map);
}

typedef struct job {
    const asj_match_run *run;
    asj_candidate *list;
    asj_watch *watch;
} job;

static void compare_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t k = part->first; k < part->end && !asj_watch_stops(j->watch, part); k++)
        if (!compare(j->run, &j->list[k]))
            j->list[k].distance2 = -1;
}

asj_status asj_compare_and_drop(const asj_match_run *run, asj_candidates *candidates)
{
    asj_watch watch;
    asj_candidate *list = candidates->list;
    const int64_t count = (int64_t)candidates->count;
    const job j = {run, list, &watch};
    size_t kept = 0;
    asj_watch_start(&watch, run->context, ASJ_STAGE_DISTANCES);
    asj_parallel(run->context, run->context->threads, count, 0, compare_some, &j);
    for (int64_t k = 0; k < count; k++)
        if (list[k].distance2 >= 0)
            list[kept++] = list[k];
    candidates->count = kept;
    return asj_watch_end(&watch);
}
