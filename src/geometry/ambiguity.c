/* SPDX-License-Identifier: BSD-2-Clause */
/* Ambiguous: another geometry, of whatever kind, whose log evidence is at least NEARLY of the best one's or within APART of it, and
 * whose matches contradict those of the best one: CONTRARY of them, or CONTRARY_ALIKE where it has as much evidence and is another
 * motion, give another partner to a place that is matched. Things that repeat do that, shifted by a period or turned. The evidence
 * itself would be surer (odds of a hundred are 5 nats of a hundred or two), but what repeats is matched more or less well for
 * reasons that the model does not know, and all its places together: of rendered rooms with tiled floors, wrong geometries have up
 * to 1.6 times the log evidence of the best one that contradicts them, and with fewer than FEW matches more than that. And a rival
 * that is ASJ_SURE_RIVAL is one with SURE_SHARE of the best one's. (Of rooms 0 to 330 and 1000 to 1399 none is answered otherwise
 * without that share; of pairs of a stereo camera that looks at a chessboard one has -524 beside -103, a tile on.)
 *
 * Where images have colours, these say of rivals which one is wrong (colour_vote.c), and that may be the one with most evidence: a
 * floor of tiles, turned by 90 degrees or shifted so that more of it is seen twice, has up to three times the log evidence of the
 * right geometry. So do the grey levels between the matches (picture_vote.c), in images with and without colours. Either may know
 * too little to decide alone, so what they say is added; where colours speak for the other side that is taken away from what
 * pictures say, which are wrong more often, and not the other way round. (Rooms 0 to 330 and 1000 to 1711 as they are: 847 of 1035
 * pairs accepted, with the stronger of the two 823; what is new is right.) What they contradict in favour of another geometry that
 * is not chance either is struck out, and that one is followed as the best one would have been (motions.c). So are rivals with less
 * evidence: they would make the pose uncertain (answer.c).
 *
 * A rival that turns the room over (upright.c) is struck out where the best one leaves it upright and has UPRIGHT_AHEAD times its
 * log evidence. Frames and windows are matched with themselves upside down by two thirds of their corners (.37, .46, .57, .58 and
 * .71 of the evidence in five pairs of rooms whose best geometry is right); in pairs of unrelated rooms, where neither is right,
 * by nearly all of them (.74, .80, .84, .92). So the way that is up never overrules what has more evidence: some cameras are
 * turned. But what turns the room over is never preferred to what leaves it upright, whatever colours and pictures say. */
#include "ambiguity.h"
#include "core/angle.h"
#include "colour_vote.h"
#include "geometry_options.h"
#include "likelihood.h"
#include "motions.h"
#include "small_matrix.h"
#include "stop.h"
#include "upright.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define NEARLY 0.6
#define APART 8.0 /* decades */
#define SURE_SHARE 0.4
#define FEW 17.0 /* matches (497 rooms: with 15, 2 more have a wrong pose, by 34 and 92 degrees, and 5 a right one) */
#define NEARLY_OF_FEW 0.3
#define APART_OF_FEW 13.0
#define CONTRARY 0.4
#define CONTRARY_ALIKE 0.15 /* of a rival with as much evidence */
#define CONTRARY_SEEN 0.3 /* where pictures decide: a motion beside the best one (.17, video frames) has its planes elsewhere */
#define SAME_THING 8.0 /* px */
#define HELD 3
#define LEAST_HELD 1e-3
#define SIMILAR_MOTION (6 * ASJ_DEGREE)
#define DOUBT 0.6 /* 229 pairs of rooms, two seeds: with .8 one more is accepted of 309, and its pose is wrong */
#define OF_FEW 1.5 /* pictures count so much less beside few matches (131 rooms: without, 2 more accepted, one pose wrong) */
#define UPRIGHT_AHEAD 1.4
#define OVERRULED 1.2 /* what speaks against the best one, where 1 contradicts another: it has the most evidence for it. (821 of
                       * those pairs: two right ones have more than that against them, the next 1.17; of 47 wrong ones, which have
                       * more evidence than a right one that something speaks for, 36.) */
#define MOST_STRUCK 4 /* times that the best one changes: in 198 pairs of rooms once in six, never twice */

/* Raises e->elsewhere[k] to how probable it is under the geometry of the probabilities `mine` that the place of candidate k in
 * image `side` is matched with something else: the mean of all else that it is matched with
 * lies farther than SAME_THING from the candidate's own point. */
static void find_elsewhere(const asj_estimation *e, int32_t side, const double *mine)
{
    double *const held = e->vote; /* of a place: probability, and the same times x and y of what it is matched with */
    memset(held, 0, HELD * (size_t)e->set.place_count[side] * sizeof *held);
    for (int32_t pass = 0; pass < 2; pass++)
        for (int32_t k = 0; k < e->set.count; k++) {
            const asj_pair *c = &e->set.list[k];
            double *at = held + HELD * (ptrdiff_t)(side == 0 ? c->place1 : c->place2);
            const double x = side == 0 ? c->x2 : c->x1, y = side == 0 ? c->y2 : c->y1;
            if (pass == 0) {
                at[0] += mine[k];
                at[1] += mine[k] * x;
                at[2] += mine[k] * y;
            } else if (at[0] - mine[k] > LEAST_HELD) {
                const double rest = at[0] - mine[k], dx = (at[1] - mine[k] * x) / rest - x, dy = (at[2] - mine[k] * y) / rest - y;
                if (dx * dx + dy * dy > SAME_THING * SAME_THING)
                    e->elsewhere[k] = fmax(e->elsewhere[k], rest);
            }
        }
}

/* How much of the second geometry's matches contradicts the first one's: it gives another partner to a place that the first one has
 * matched, in either image, and that the first one does not hold for nearly as likely. As a part of all of them. A partner within
 * SAME_THING is no other one: a corner of a frame has the frame's inner corner beside it, and a motion that is a little off takes
 * the one for the other. (229 pairs of rendered rooms, two seeds: 289 accepted with 0 px, 309 with 8, 315 with 10; of 97 unrelated
 * pairs, four seeds, none with 10 and 5 of 388 with 12.) */
static double contradiction(asj_estimation *e, const asj_model *second)
{
    const double *mine = e->scratch.probability;
    double against = 0, all = 0;
    asj_probabilities(&e->set, &second->view, 1, &e->scratch.score, e->other);
    for (int32_t k = 0; k < e->set.count; k++) {
        against += e->other[k] * fmax(0, fmin(1, e->elsewhere[k]) - mine[k]);
        all += e->other[k];
    }
    return all > 0 ? against / all : 0;
}

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
    return CONTRARY + (CONTRARY_ALIKE - CONTRARY) * nearness;
}

/* How much colours and pictures (picture_vote.c) speak against the second of two geometries, with these probabilities: above 1 they
 * contradict it. first_look: of the first one. contrary: how much of the matches contradicts the other one. Of two that have
 * matched nearly the same, pictures only tell which has its planes where they are. */
static double against(const asj_estimation *e, const double *first, const double *second, int32_t first_look, double contrary)
{
    const double colours = e->set.has_colours ? asj_colours_against(&e->set, first, second, e->vote) : 0;
    if (!e->pictures || !(contrary > CONTRARY_SEEN))
        return colours;
    const double seen = asj_pictures_against(&e->pictures->looks[first_look], &e->pictures->looks[1 - first_look]);
    return colours + (asj_inliers(&e->set, e->scratch.probability) < FEW ? seen / OF_FEW : seen);
}

/* Look 0 is of the geometry that others are compared with, 1 of the other. */
static void look_at(const asj_estimation *e, const asj_model *m, const double *probability, int32_t look)
{
    if (e->pictures)
        asj_pictures_look(e->pictures, &e->set, &m->view, probability, &e->pictures->looks[look]);
}

/* What the geometry that others are compared with says of places and pictures. */
static void look_at_best(asj_estimation *e, int32_t best)
{
    asj_probabilities(&e->set, &e->finalists[best].view, 1, &e->scratch.score, e->scratch.probability);
    memset(e->elsewhere, 0, (size_t)e->set.count * sizeof *e->elsewhere);
    for (int32_t side = 0; side < 2; side++)
        find_elsewhere(e, side, e->scratch.probability);
    look_at(e, &e->finalists[best], e->scratch.probability, 0);
}

/* How much of the matches contradicts the other geometry; where pictures decide, they are looked at. */
static double compare_with(asj_estimation *e, const asj_model *other)
{
    const double contrary = contradiction(e, other);
    if (contrary > CONTRARY_SEEN)
        look_at(e, other, e->other, 1);
    return contrary;
}

static int32_t turns_over(const asj_estimation *e, int32_t number)
{
    return asj_turns_over(&e->set, &e->finalists[number], asj_estimation_cameras(e));
}

static int32_t is_overturned(const asj_estimation *e, int32_t best, int32_t rival)
{
    const asj_model *m = &e->finalists[best], *r = &e->finalists[rival];
    return m->evidence > fmax(0, UPRIGHT_AHEAD * r->evidence) && turns_over(e, rival) && !turns_over(e, best);
}

/* By colours, by pictures or by the way that is up, in favour of what others are compared with. */
static int32_t is_contradicted(const asj_estimation *e, int32_t best, int32_t rival, double contrary)
{
    return against(e, e->scratch.probability, e->other, 0, contrary) > 1 || is_overturned(e, best, rival);
}

int32_t asj_contradicts(asj_estimation *e, const asj_model *other)
{
    const double contrary = compare_with(e, other);
    return against(e, e->scratch.probability, e->other, 0, contrary) > 1;
}

int32_t asj_strongest_rival(asj_estimation *e, int32_t best, int32_t *doubt)
{
    int32_t second = -1;
    const asj_model *m = &e->finalists[best];
    look_at_best(e, best);
    for (int32_t n = 0; n < e->count && !asj_pairs_stop(&e->set, NULL); n++) {
        const asj_model *rival = &e->finalists[n];
        if (n == best || !(rival->evidence > -HUGE_VAL) || (second >= 0 && rival->evidence <= e->finalists[second].evidence))
            continue;
        const double contrary = compare_with(e, rival), share = asj_estimation_log10_nfa(e, rival) / to_compare(e, m);
        const int32_t doubtful = against(e, e->other, e->scratch.probability, 1, contrary) > DOUBT;
        if (contrary > (doubtful ? CONTRARY_ALIKE : least_contradiction(m, rival, share)) &&
            !is_contradicted(e, best, n, contrary)) {
            second = n;
            *doubt = doubtful;
        }
    }
    return second;
}

int32_t asj_is_ambiguous(const asj_estimation *e, int32_t best, int32_t rival, int32_t doubt, double inliers)
{
    const double nfa = to_compare(e, &e->finalists[best]), second = asj_estimation_log10_nfa(e, &e->finalists[rival]);
    const int32_t few = doubt || inliers < FEW;
    const double sure = fmin(ASJ_SURE_RIVAL, SURE_SHARE * nfa);
    return second <= fmax(sure, fmax((few ? NEARLY_OF_FEW : NEARLY) * nfa, nfa + (few ? APART_OF_FEW : APART)));
}

/* The one with most evidence in favour of which colours or pictures contradict number `best`; -1: none. */
static int32_t preferred_to(asj_estimation *e, int32_t best)
{
    const double least = log10(e->options->epsilon);
    int32_t found = -1;
    look_at_best(e, best);
    for (int32_t n = 0; n < e->count && !asj_pairs_stop(&e->set, NULL); n++) {
        const asj_model *m = &e->finalists[n];
        if (n == best || (found >= 0 && m->evidence <= e->finalists[found].evidence) || asj_estimation_log10_nfa(e, m) > least)
            continue;
        if (turns_over(e, n) && !turns_over(e, best))
            continue;
        const double contrary = compare_with(e, m);
        if (against(e, e->other, e->scratch.probability, 1, contrary) > OVERRULED)
            found = n;
    }
    return found;
}

/* All with more evidence than number `chosen` that colours or pictures contradict in its favour. */
static void strike(asj_estimation *e, int32_t chosen)
{
    const asj_model *c = &e->finalists[chosen];
    look_at_best(e, chosen);
    for (int32_t n = 0; n < e->count && !asj_pairs_stop(&e->set, NULL); n++) {
        asj_model *m = &e->finalists[n];
        if (!(m->evidence > c->evidence))
            continue;
        const double contrary = compare_with(e, m);
        if (against(e, e->scratch.probability, e->other, 0, contrary) > 1)
            m->evidence = m->peak = -HUGE_VAL;
    }
}

/* What contradicts the best one and is contradicted by colours or pictures is no other motion that it might be (answer.c). */
static void strike_rivals(asj_estimation *e)
{
    const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_AUTO);
    if (best < 0)
        return;
    look_at_best(e, best);
    for (int32_t n = 0; n < e->count && !asj_pairs_stop(&e->set, NULL); n++)
        if (n != best && n != e->focal_at && e->finalists[n].evidence > -HUGE_VAL) {
            const double contrary = compare_with(e, &e->finalists[n]);
            if (contrary > CONTRARY_ALIKE && is_contradicted(e, best, n, contrary))
                e->finalists[n].evidence = e->finalists[n].peak = -HUGE_VAL;
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

/* Number `chosen` instead of the best one, and of all others that it contradicts. *stands: 0 when something else would be the best
 * then: what is not believed itself contradicts nothing. */
static asj_status put_in_front(asj_estimation *e, int32_t chosen, int32_t *stands)
{
    double evidence[ASJ_MOST_MODELS], peak[ASJ_MOST_MODELS];
    asj_status status = ASJ_OK;
    for (int32_t n = 0; n < e->count; n++) {
        evidence[n] = e->finalists[n].evidence;
        peak[n] = e->finalists[n].peak;
    }
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
    *stands = asj_estimation_best(e, ASJ_GEOMETRY_AUTO) == chosen;
    for (int32_t n = 0; n < e->count && !*stands; n++)
        if (n != chosen) {
            e->finalists[n].evidence = evidence[n];
            e->finalists[n].peak = peak[n];
        }
    return status == ASJ_OK && !*stands && e->focal_at != focal_at ? focus_back(e, chosen, &before, &focal, focal_at) : status;
}

asj_status asj_strike_out(asj_estimation *e)
{
    asj_status status = ASJ_OK;
    int32_t stands = 1;
    for (int32_t round = 0; round < MOST_STRUCK && stands && status == ASJ_OK && (e->set.has_colours || e->pictures); round++) {
        const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_AUTO);
        if (best < 0 || asj_estimation_log10_nfa(e, &e->finalists[best]) > log10(e->options->epsilon))
            break;
        const int32_t chosen = preferred_to(e, best);
        if (chosen < 0)
            break;
        status = put_in_front(e, chosen, &stands);
    }
    if (status == ASJ_OK)
        strike_rivals(e);
    return status;
}
