/* SPDX-License-Identifier: BSD-2-Clause */
/* Colours and pictures overrule evidence (contradiction.c).
 *
 * What pictures disagree with by themselves is struck out as long as it is the best. What they contradict in favour of another
 * geometry that is not chance either is struck out as well, and so is a motion where they prefer another one that excludes it, by
 * WEIGHT times what that lacks of evidence, or at all if it is upright instead (contradiction.c); that one is followed as the best
 * one would have been (motions.c). Rivals with less evidence are struck out, too: they would make the pose uncertain (answer.c). */
#include "strike_out.h"
#include "contradiction.h"
#include "core/angle.h"
#include "geometry_options.h"
#include "motions.h"
#include "stop.h"

#include <math.h>

#define OVERRULED 1.2 /* what speaks against the best one, where 1 contradicts another: it has the most evidence for it. (In 821
                       * pairs two right ones have more than that against them, the next 1.17; of 47 wrong ones in front 36.) */
#define WEIGHT 1.5  /* of evidence, beside the nats that pictures say more for a motion that they prefer */
#define SAME_MOTION (3 * ASJ_DEGREE)
#define MOST_STRUCK 4 /* times that the best one changes: in 198 pairs of rooms once in six, never twice */
#define MOST_TRIED 4  /* others, each time: of what is preferred to the best one something else may have more evidence still */

/* Do pictures prefer one of two motions so clearly that they outweigh the evidence which the other one has more? Nats. */
static int32_t outweighs(double preference, double evidence)
{
    return preference > fmax(0, WEIGHT * evidence);
}

/* .. finalist `other` to `best`? What is upright instead need not outweigh what turns the room over. */
static int32_t is_preferred(const asj_estimation *e, int32_t best, int32_t other, double preference)
{
    return outweighs(preference, e->finalists[best].evidence - e->finalists[other].evidence) ||
           (preference > 0 && asj_is_upright_instead(e, best, other));
}

/* How much colours and pictures speak for each finalist against number `best`; 0 where that is not enough, or is no matter. */
static void weigh(asj_estimation *e, int32_t best, double for_it[ASJ_MOST_MODELS])
{
    asj_compare_from(e, best);
    for (int32_t n = 0; n < e->count; n++) {
        const asj_model *m = &e->finalists[n];
        const double nfa = asj_estimation_log10_nfa(e, m);
        for_it[n] = 0;
        if (asj_pairs_stop(&e->set, NULL) || n == best || !asj_model_stands(m) || nfa > log10(e->options->epsilon) ||
            (asj_finalist_turns_over(e, n) && !asj_finalist_turns_over(e, best)))
            continue;
        const asj_comparison c = asj_compare_with(e, m);
        const int32_t preferred = is_preferred(e, best, n, c.preference);
        if ((preferred || c.against_first > OVERRULED) && !asj_pictures_disagree(e, *asj_agreement_of_other(e), nfa))
            for_it[n] = fmax(OVERRULED, c.against_first);
    }
}

/* All with more evidence than number `chosen` that colours or pictures contradict in its favour, or to which pictures prefer it by
 * more than that outweighs. */
static void strike(asj_estimation *e, int32_t chosen)
{
    const asj_model *c = &e->finalists[chosen];
    asj_compare_from(e, chosen);
    for (int32_t n = 0; n < e->count && !asj_pairs_stop(&e->set, NULL); n++) {
        asj_model *m = &e->finalists[n];
        if (!asj_model_stands(m) || !(m->evidence > c->evidence))
            continue;
        const asj_comparison between = asj_compare_with(e, m);
        if (between.against_other > 1 || is_preferred(e, n, chosen, -between.preference))
            m->struck = ASJ_STRUCK_FOR_ANOTHER;
    }
}

/* What is no other motion that the best one might be (answer.c): what contradicts it and is contradicted itself, by colours,
 * pictures or the way that is up, and a motion to which pictures prefer it. */
static void strike_rivals(asj_estimation *e)
{
    const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_AUTO);
    if (best < 0)
        return;
    asj_compare_from(e, best);
    for (int32_t n = 0; n < e->count && !asj_pairs_stop(&e->set, NULL); n++)
        if (n != best && n != e->focal_at && asj_model_stands(&e->finalists[n])) {
            const asj_comparison c = asj_compare_with(e, &e->finalists[n]);
            if (c.preference < 0 || (c.contrary > ASJ_CONTRARY_ALIKE && asj_is_contradicted(e, best, n, &c)))
                e->finalists[n].struck = ASJ_STRUCK_AS_RIVAL;
        }
}

/* As it was before number `chosen` told the focal length. */
static asj_status focus_back(asj_estimation *e, int32_t chosen, const asj_model *before, const asj_focal *focal, int32_t focal_at)
{
    e->focal = *focal;
    e->focal_at = focal_at;
    e->finalists[chosen] = *before;
    return asj_focal_search_turn(e->focal_search, focal);
}

static int32_t are_the_same(const asj_model *a, const asj_model *b)
{
    return a->kind == ASJ_GEOMETRY_ESSENTIAL && b->kind == ASJ_GEOMETRY_ESSENTIAL && asj_motions_apart(a, b) < SAME_MOTION;
}

/* Of the same motion the one that has been followed is the answer. */
static void strike_twins(asj_estimation *e, int32_t chosen)
{
    const asj_model *c = &e->finalists[chosen];
    for (int32_t n = 0; n < e->count; n++) {
        asj_model *m = &e->finalists[n];
        if (asj_model_stands(m) && m->evidence > c->evidence && are_the_same(m, c))
            m->struck = ASJ_STRUCK_FOR_ANOTHER;
    }
}

/* Number `chosen` instead of the best one, and of all others that it contradicts. *stands: 0 when something else would be the best
 * then: what is not believed itself contradicts nothing. */
static asj_status put_in_front(asj_estimation *e, int32_t chosen, int32_t *stands)
{
    asj_struck struck[ASJ_MOST_MODELS];
    asj_status status = ASJ_OK;
    for (int32_t n = 0; n < e->count; n++)
        struck[n] = e->finalists[n].struck;
    const asj_focal focal = e->focal;
    const asj_model before = e->finalists[chosen];
    const int32_t focal_at = e->focal_at;
    asj_model followed = before;
    int32_t count = 1;
    strike(e, chosen);
    if (asj_has_found_focal(e, chosen) && chosen != e->focal_at)
        status = asj_estimation_refocus(e, chosen);
    else if (followed.kind == ASJ_GEOMETRY_ESSENTIAL && chosen != e->focal_at) {
        status = asj_refine_motions(e->context, &e->set, followed.cameras, e->options->seed, 1, &followed, &count);
        if (status == ASJ_OK && count == 1 && followed.evidence > e->finalists[chosen].evidence)
            e->finalists[chosen] = followed;
        else if (status == ASJ_OK && !e->finalists[chosen].settled)
            status = asj_estimation_settle(e, &e->finalists[chosen]);
    }
    strike_twins(e, chosen);
    *stands = asj_estimation_best(e, ASJ_GEOMETRY_AUTO) == chosen;
    for (int32_t n = 0; n < e->count && !*stands; n++)
        e->finalists[n].struck = struck[n];
    return status == ASJ_OK && !*stands && e->focal_at != focal_at ? focus_back(e, chosen, &before, &focal, focal_at) : status;
}

/* Those first that colours and pictures speak for most, until one stands. */
static asj_status put_preferred_in_front(asj_estimation *e, int32_t best, int32_t *stands)
{
    double for_it[ASJ_MOST_MODELS];
    asj_status status = ASJ_OK;
    *stands = 0;
    weigh(e, best, for_it);
    for (int32_t k = 0; k < MOST_TRIED && !*stands && status == ASJ_OK; k++) {
        int32_t chosen = 0;
        for (int32_t n = 1; n < e->count; n++)
            chosen = for_it[n] > for_it[chosen] ? n : chosen;
        if (!(for_it[chosen] > 0))
            break;
        for_it[chosen] = 0;
        status = put_in_front(e, chosen, stands);
    }
    return status;
}

/* The best one of a kind that may not be chance; -1: there is none. */
static int32_t best_that_counts(const asj_estimation *e, int32_t kind)
{
    const int32_t best = asj_estimation_best(e, kind);
    return asj_estimation_counts(e, best) ? best : -1;
}

/* As long as the pictures disagree with the best one of a kind. */
static void strike_best(asj_estimation *e, int32_t kind)
{
    for (int32_t n = best_that_counts(e, kind); n >= 0 && !asj_pairs_stop(&e->set, NULL); n = best_that_counts(e, kind)) {
        asj_model *m = &e->finalists[n];
        asj_compare_from(e, n);
        if (!asj_pictures_disagree(e, e->first.agreement, asj_estimation_log10_nfa(e, m)))
            return;
        m->struck = ASJ_STRUCK_BY_PICTURES;
    }
}

/* Whatever may be the answer (answer.c). */
static void strike_what_disagrees(asj_estimation *e)
{
    if (!e->pictures)
        return;
    strike_best(e, ASJ_GEOMETRY_AUTO);
    strike_best(e, ASJ_GEOMETRY_HOMOGRAPHY);
}

asj_status asj_strike_out(asj_estimation *e)
{
    asj_status status = ASJ_OK;
    int32_t stands = 1;
    strike_what_disagrees(e);
    for (int32_t round = 0; round < MOST_STRUCK && stands && status == ASJ_OK && (e->set.has_colours || e->pictures); round++) {
        const int32_t best = best_that_counts(e, ASJ_GEOMETRY_AUTO);
        if (best < 0)
            break;
        status = put_preferred_in_front(e, best, &stands);
    }
    if (status == ASJ_OK)
        strike_rivals(e);
    if (status == ASJ_OK)
        strike_what_disagrees(e);
    return status;
}
