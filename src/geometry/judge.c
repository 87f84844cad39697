/* SPDX-License-Identifier: BSD-2-Clause */
/* With p the probability before and LR the likelihood ratio under the geometry (likelihood.c), Bayes' rule says
 *
 *     p LR / (p LR + 1 - p).
 *
 * Rivals of the match are in p: who asks has chosen it before them. */
#include "judge.h"

asj_judge asj_judge_create(const asj_two_view *view, const asj_pairs *set)
{
    return (asj_judge){*view, {.location_sd = set->location_sd, .angle_sd = set->angle_sd, .scale_sd = set->scale_sd,
                               .spread = set->spread, .area = set->area}};
}

double asj_judge_probability(const asj_judge *judge, const asj_geometry_candidate *m)
{
    const asj_pair pair = {m->x1, m->y1, m->x2, m->y2, {m->affine[0], m->affine[1], m->affine[2], m->affine[3]}, m->probability,
                           0, 0, 0, 0, {{{0}}}};
    const asj_peaks peaks = asj_likelihood_peaks(&judge->scales, &judge->view, 1);
    const double right = m->probability * asj_likelihood_ratio(&judge->view, &judge->scales, &pair, &peaks, NULL);
    const double wrong = 1 - m->probability;
    return right > 0 ? right / (right + wrong) : 0;
}
