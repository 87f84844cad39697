/* SPDX-License-Identifier: BSD-2-Clause */
/* Ambiguous: another geometry, of whatever kind, whose log evidence is at least NEARLY of the best one's or within APART of it, and
 * whose matches contradict those of the best one: CONTRARY of them, or ASJ_CONTRARY_ALIKE where it has as much evidence and is
 * another motion, give another partner to a place that is matched. Things that repeat do that, shifted by a period or turned. The
 * evidence itself would be surer (odds of a hundred are 5 nats of a hundred or two), but what repeats is matched more or less well
 * for reasons that the model does not know, and all its places together: of rendered rooms with tiled floors, wrong geometries
 * have up to 1.6 times the log evidence of the best one that contradicts them, and with few matches more than that. And a rival
 * that is ASJ_SURE_RIVAL is one with SURE_SHARE of the best one's.
 *
 * So is a motion that cannot be right beside the best one (contradiction.c), whatever they have matched, where pictures prefer it
 * by more than it lacks of evidence. (By less, a right best motion with 71 nats more had a rival that pictures prefer by 18.)
 *
 * And so is a motion that excludes the best one and explains other matches nearly as well (is_other_witness()), or leaves the room
 * upright where the best one does not (contradiction.c).
 *
 * What is contradicted is no rival, nor is what pictures disagree with, unless it is ASJ_SURE_RIVAL. */
#include "ambiguity.h"
#include "contradiction.h"
#include "core/angle.h"
#include "geometry_options.h"
#include "manhattan.h"
#include "motions.h"
#include "small_matrix.h"
#include "stop.h"

#include <math.h>

#define NEARLY 0.6
#define APART 8.0 /* decades */
#define SURE_SHARE 0.4 /* a chessboard's right motion has -524 beside -103, a tile on; wrong ones have rivals of .45 and more */
#define NEARLY_OF_FEW 0.3
#define APART_OF_FEW 13.0
#define CONTRARY 0.4
#define SIMILAR_MOTION (6 * ASJ_DEGREE)
#define WITNESS 0.65    /* of the log evidence, .. */
#define MOST_SHARED 0.5 /* .. of its matches, .. */
#define LIKELY 7.0      /* .. and nats that directions say for its rotation */
#define SURE_DOUBT 0.8  /* by colours, votes and agreement together: against none of 1630 right ones, and 21 of 93 wrong ones */
#define DOUBT 0.6 /* .. votes alone. 229 pairs of rooms, two seeds: with .8 one more is accepted of 309, and its pose is wrong */

/* What a rival is compared with: of a motion that stands for a whole region (posterior.c) the best of it, as the rivals are. */
static double to_compare(const asj_estimation *e, const asj_model *m)
{
    asj_model peak = *m;
    peak.evidence = m->settled ? fmin(m->peak, m->evidence) : m->evidence;
    return asj_estimation_log10_nfa(e, &peak);
}

/* How much contradiction makes a rival: CONTRARY, and less where its evidence, `share` of the best one's, comes near: where things
 * repeat, a wrong geometry shares many matches with the right one. Nearly the same motion is no rival for that. */
static double least_contradiction(const asj_model *best, const asj_model *rival, double share)
{
    if (asj_model_has_rotation(best) && asj_model_has_rotation(rival)) {
        double turn[9];
        asj_multiply3_transposed(rival->rotation, best->rotation, turn);
        const int32_t moves = !asj_model_only_turns(best) && !asj_model_only_turns(rival);
        const double along = moves ? fabs(asj_dot3(rival->translation, best->translation)) : 1;
        if (asj_rotation_angle(turn) < SIMILAR_MOTION && along > cos(SIMILAR_MOTION))
            return CONTRARY;
    }
    const double nearness = fmin(1, fmax(0, (share - NEARLY) / (1 - NEARLY)));
    return CONTRARY + (ASJ_CONTRARY_ALIKE - CONTRARY) * nearness;
}

/* Does another motion, which cannot be right beside the best one, explain matches of its own nearly as well, with a rotation that
 * the directions of the room make likely, and the room upright? Then one of the two is made of what looks alike. It is the other
 * one if pictures agree better with the best one. */
static int32_t is_other_witness(asj_estimation *e, int32_t best, int32_t rival, double share, const asj_comparison *c)
{
    const asj_model *r = &e->finalists[rival];
    return share > WITNESS && c->shared < MOST_SHARED && asj_exclude_each_other(&e->finalists[best], r) &&
           asj_rotation_prior(&e->set, r->rotation) > LIKELY && !asj_finalist_turns_over(e, rival) &&
           e->first.agreement.share - asj_agreement_of_other(e)->share < ASJ_AS_GOOD;
}

int32_t asj_strongest_rival(asj_estimation *e, int32_t best, int32_t *doubt)
{
    int32_t second = -1;
    const asj_model *m = &e->finalists[best];
    asj_compare_from(e, best);
    for (int32_t n = 0; n < e->count && !asj_pairs_stop(&e->set, NULL); n++) {
        const asj_model *rival = &e->finalists[n];
        if (n == best || !asj_model_stands(rival) || (second >= 0 && rival->evidence <= e->finalists[second].evidence))
            continue;
        const asj_comparison c = asj_compare_with(e, rival);
        const double nfa = asj_estimation_log10_nfa(e, rival), share = nfa / to_compare(e, m);
        const int32_t doubtful = c.votes_against_first > DOUBT || c.against_first > SURE_DOUBT;
        const int32_t contrary = c.contrary > (doubtful ? ASJ_CONTRARY_ALIKE : least_contradiction(m, rival, share));
        const int32_t preferred = c.preference > fmax(0, m->evidence - rival->evidence); /* more than it lacks */
        const int32_t other = is_other_witness(e, best, n, share, &c) || asj_is_upright_instead(e, best, n);
        if ((contrary || preferred || other) &&
            !asj_is_contradicted(e, best, n, &c) &&
            !(nfa > ASJ_SURE_RIVAL && asj_pictures_disagree(e, *asj_agreement_of_other(e), nfa))) {
            second = n;
            *doubt = doubtful;
        }
    }
    return second;
}

int32_t asj_is_ambiguous(const asj_estimation *e, int32_t best, int32_t rival, int32_t doubt, double inliers)
{
    const double nfa = to_compare(e, &e->finalists[best]), second = asj_estimation_log10_nfa(e, &e->finalists[rival]);
    const int32_t few = doubt || inliers < ASJ_FEW_MATCHES;
    const double sure = fmin(ASJ_SURE_RIVAL, SURE_SHARE * nfa);
    return second <= fmax(sure, fmax((few ? NEARLY_OF_FEW : NEARLY) * nfa, nfa + (few ? APART_OF_FEW : APART)));
}
