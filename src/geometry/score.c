/* SPDX-License-Identifier: BSD-2-Clause */
/* What all candidates together say of a geometry.
 *
 * A place has rivals, at most one of which is right; p_c the priors, LR_c the ratios:
 *
 *     score = sum over the places of log(1 - sum p_c + sum p_c LR_c),
 *
 * over those of image 1 and over those of image 2, and the smaller counts (a match is one to one). When partners are wrong and
 * independent, each LR has mean 1, so exp(score) has mean 1 for every fixed geometry: that is what evidence.c rests on. */
#include "score.h"
#include "elementary.h"
#include "near.h"
#include "ratios.h"

#include <string.h>

double asj_score(const asj_pairs *set, int32_t count, const asj_two_view *view, double loose, asj_score_scratch *scratch)
{
    const asj_peaks peaks = asj_likelihood_peaks(set, view, loose);
    const double limit = asj_far_limit(set, view, loose);
    int32_t touched[2] = {0, 0};
    double score[2] = {0, 0};
    const int32_t near = asj_near(set, count, view, limit, scratch->near);
    asj_likelihood_ratios(view, set, scratch->near, near, &peaks, scratch->ratio);
    for (int32_t k = 0; k < near; k++) {
        const asj_pair *c = &set->list[scratch->near[k]];
        const double ratio = scratch->ratio[k];
        if (!(ratio > 0))
            continue;
        for (int32_t v = 0; v < 2; v++) {
            const uint32_t place = v == 0 ? c->place1 : c->place2;
            if (scratch->sum[v][place] == 0)
                scratch->touched[v][touched[v]++] = place;
            scratch->sum[v][place] += c->prior * ratio;
        }
    }
    for (int32_t v = 0; v < 2; v++)
        for (int32_t k = 0; k < touched[v]; k++) {
            const uint32_t place = scratch->touched[v][k];
            score[v] += asj_log_normal(1 - set->prior[v][place] + scratch->sum[v][place]) - set->log_rest[v][place];
            scratch->sum[v][place] = 0;
        }
    for (int32_t v = 0; v < 2; v++)
        score[v] += set->empty[v];
    return score[0] < score[1] ? score[0] : score[1];
}

void asj_probabilities(const asj_pairs *set, const asj_two_view *view, double loose, asj_score_scratch *scratch,
                       double *probability)
{
    const asj_peaks peaks = asj_likelihood_peaks(set, view, loose);
    const double limit = asj_far_limit(set, view, loose);
    const int32_t near = asj_near(set, set->count, view, limit, scratch->near);
    asj_likelihood_ratios(view, set, scratch->near, near, &peaks, scratch->ratio);
    memset(probability, 0, (size_t)set->count * sizeof *probability);
    for (int32_t n = 0; n < near; n++) {
        const uint32_t k = scratch->near[n];
        const asj_pair *c = &set->list[k];
        probability[k] = c->prior * scratch->ratio[n];
        scratch->sum[0][c->place1] += probability[k];
        scratch->sum[1][c->place2] += probability[k];
    }
    for (int32_t n = 0; n < near; n++) {
        const uint32_t k = scratch->near[n];
        const asj_pair *c = &set->list[k];
        if (probability[k] > 0) {
            /* all that competes: the rivals at either place, and no match at all */
            const double rest1 = 1 - set->prior[0][c->place1] + scratch->sum[0][c->place1] - probability[k];
            const double rest2 = 1 - set->prior[1][c->place2] + scratch->sum[1][c->place2] - probability[k];
            const double rest = rest1 > rest2 ? rest1 : rest2;
            probability[k] = probability[k] / (probability[k] + rest);
        }
    }
    for (int32_t v = 0; v < 2; v++)
        memset(scratch->sum[v], 0, (size_t)set->place_count[v] * sizeof *scratch->sum[v]);
}

double asj_inliers(const asj_pairs *set, const double *probability)
{
    double sum = 0;
    for (int32_t k = 0; k < set->count; k++)
        sum += probability[k];
    return sum;
}
