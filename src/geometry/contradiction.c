/* SPDX-License-Identifier: BSD-2-Clause */
/* What speaks against a geometry.
 *
 * Its matches give another partner to places that a better one has matched. Where both cannot be right, colours say which one is
 * wrong where images have some (colour_vote.c), and that may be the one with most evidence: a floor of tiles, turned by 90 degrees
 * or shifted so that more of it is seen twice, has up to three times the log evidence of the right geometry. So do the pictures
 * between the matches (picture_vote.c). Either may know too little to decide alone, so what they say is added; where colours speak
 * for the other side that is taken away from what pictures say, which are wrong more often, and not the other way round.
 *
 * A rival that turns the room over (upright.c) is contradicted where the best one leaves it upright and has UPRIGHT_AHEAD times its
 * log evidence. Frames and windows are matched with themselves upside down by two thirds of their corners; in pairs of unrelated
 * rooms, where neither is right, by nearly all of them. So the way that is up alone never overrules what has more evidence: some
 * cameras are turned. But what turns the room over is never preferred to what leaves it upright, whatever colours and pictures say.
 * Where it has most evidence a motion that excludes it, leaves the room upright and has 1 / UPRIGHT_AHEAD of that makes it doubtful
 * (ambiguity.c), and takes its place where pictures prefer it at all (strike_out.c): beside the right motion of a camera that is
 * turned there is no such one.
 *
 * Two motions that are OTHER_MOTION apart cannot both be right, even if their matches are of different places and contradict each
 * other in nothing. So of these pictures prefer one where they agree with it as usual, CLEARLY better than with the other one, and
 * say SURELY_MORE nats more for it. The nats, because what sees one plane through two motions agrees as well with either, and says
 * more for the one that has another plane as well; the share, because a plane that is large says much for any motion. Grey
 * pictures prefer none, and nothing that is not COMPARABLE in evidence is preferred. What comes of it: strike_out.c, ambiguity.c.
 *
 * And pictures disagree with a geometry by themselves where they agree (picture_agreement.c) by less than AGREEMENT, which goes
 * down where it has MUCH evidence.
 *
 * What was tried: tests/accuracy/tried/geometry.md, "Colours and pictures together", "Pictures that agree, or do not"
 * and "Motions that exclude each other". */
#include "contradiction.h"
#include "colour_vote.h"
#include "core/angle.h"
#include "likelihood.h"
#include "picture_vote.h"
#include "upright.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define CONTRARY_SEEN 0.3 /* where pictures decide: a motion beside the best one (.17, video frames) has its planes elsewhere */
#define SAME_THING 8.0 /* px */
#define HELD 3
#define LEAST_HELD 1e-3
#define OF_FEW 1.5 /* pictures count so much less beside few matches (131 rooms: without, 2 more accepted, one pose wrong) */
#define UPRIGHT_AHEAD 1.4 /* beside a right geometry such rivals have up to .71 of its evidence, in unrelated rooms .74 and more */
#define BETTER 4.0   /* what agrees better by another 1/BETTER than ASJ_AS_GOOD contradicts the other one */
#define OTHER_MOTION (15 * ASJ_DEGREE)
#define COMPARABLE 0.5    /* of the other one's log evidence: what has less is not preferred, whatever pictures say */
#define CLEARLY 0.2       /* of shares of agreement */
#define SURELY_MORE 10.0  /* nats; a few wrong motions have more than the right one, whose evidence outweighs that (strike_out.c) */
#define AGREEMENT 0.36 /* one right motion of 182 has less; a geometry of unrelated rooms has .29 in the median */
#define MUCH (-60.0) /* log10 NFA */
#define VERY_MUCH (-150.0)
#define AGREEMENT_GOES_DOWN 0.16 /* from one to the other */
#define LEAST_AGREEMENT 0.1
#define LEAST_TOLD 0.01          /* 0: nobody has looked */

/* Raises e->elsewhere[k] to how probable it is under the geometry of the probabilities `mine` that the place of candidate k in
 * image `side` is matched with something else: the mean of all else that it is matched with lies farther than SAME_THING from the
 * candidate's own point. */
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

/* How much of the other geometry's matches contradicts the first one's: it gives another partner to a place that the first one has
 * matched, in either image, and that the first one does not hold for nearly as likely. As a part of all of them. A partner within
 * SAME_THING is no other one: a corner of a frame has the frame's inner corner beside it, and a motion that is a little off takes
 * the one for the other. (Of 458 pairs 289 are accepted with 0 px, 309 with 8.) */
static double contradiction(const asj_estimation *e)
{
    const double *first = e->first.probability, *other = e->other.probability;
    double against = 0, all = 0;
    for (int32_t k = 0; k < e->set.count; k++) {
        against += other[k] * fmax(0, fmin(1, e->elsewhere[k]) - first[k]);
        all += other[k];
    }
    return all > 0 ? against / all : 0;
}

/* How much of them both have. */
static double share_of_both(const asj_estimation *e)
{
    const double *first = e->first.probability, *other = e->other.probability;
    double both = 0, all = 0;
    for (int32_t k = 0; k < e->set.count; k++) {
        both += fmin(first[k], other[k]);
        all += other[k];
    }
    return all > 0 ? both / all : 0;
}

/* How much better the pictures agree with `one` than with `two`, in colours. (Grey levels alone: of 24 grey facades of equal
 * windows with stains of 10 levels one was accepted shifted by a window.) */
static double better(const asj_estimation *e, asj_agreement one, asj_agreement two)
{
    if (e->pictures->of[0].channel_count < ASJ_MOST_CHANNELS)
        return 0;
    return BETTER * fmax(0, one.share - two.share - ASJ_AS_GOOD);
}

/* Looks at the pictures through a geometry that is compared; look: 0 of the first one, 1 of the other. */
static void see(asj_estimation *e, int32_t look, asj_compared *as)
{
    if (!e->pictures || as->is_seen)
        return;
    asj_pictures_look(e->context, e->pictures, &e->set, &as->model->view, as->probability, &e->pictures->looks[look]);
    as->agreement = asj_pictures_agreement(&e->pictures->looks[look]);
    as->is_seen = 1;
}

const asj_agreement *asj_agreement_of_other(asj_estimation *e)
{
    see(e, 1, &e->other);
    return &e->other.agreement;
}

/* Adds what the pictures say. Of two that have matched nearly the same they only tell which has its planes where they are. */
static void add_pictures(asj_estimation *e, asj_comparison *c)
{
    if (!e->pictures || !(c->contrary > CONTRARY_SEEN))
        return;
    see(e, 1, &e->other);
    const asj_picture_look *first = &e->pictures->looks[0], *other = &e->pictures->looks[1];
    const double beside = asj_inliers(&e->set, e->first.probability) < ASJ_FEW_MATCHES ? OF_FEW : 1;
    const double against_first = asj_pictures_against(other, first);
    c->against_other += (asj_pictures_against(first, other) + better(e, e->first.agreement, e->other.agreement)) / beside;
    c->against_first += (against_first + better(e, e->other.agreement, e->first.agreement)) / beside;
    c->votes_against_first += against_first / beside;
}

int32_t asj_exclude_each_other(const asj_model *a, const asj_model *b)
{
    return a->kind == ASJ_GEOMETRY_ESSENTIAL && b->kind == ASJ_GEOMETRY_ESSENTIAL && asj_motions_apart(a, b) > OTHER_MOTION;
}

/* Of two such motions, may pictures in colours prefer one? */
static int32_t may_prefer(const asj_estimation *e)
{
    const double first = e->first.model->evidence, other = e->other.model->evidence;
    return e->pictures && e->pictures->of[0].channel_count == ASJ_MOST_CHANNELS &&
           fmin(first, other) > COMPARABLE * fmax(first, other) && asj_exclude_each_other(e->first.model, e->other.model);
}

/* How many nats more the pictures say for the other one, where they prefer that; negative where they prefer the first one. */
static double preference(asj_estimation *e)
{
    if (!may_prefer(e))
        return 0;
    const asj_agreement *first = &e->first.agreement, *other = asj_agreement_of_other(e);
    if (fmin(first->known, other->known) < ASJ_LEAST_KNOWN)
        return 0;
    const double closer = other->share - first->share, more = asj_agreement_said(*other) - asj_agreement_said(*first);
    const int32_t agrees = fmax(first->share, other->share) > ASJ_USUAL_AGREEMENT;
    return agrees && fabs(closer) > CLEARLY && fabs(more) > SURELY_MORE && closer * more > 0 ? more : 0;
}

static void take(asj_estimation *e, const asj_model *m, asj_compared *as)
{
    as->model = m;
    as->is_seen = 0;
    as->agreement = (asj_agreement){0, 0};
    asj_probabilities(&e->set, &m->view, 1, &e->scratch.score, as->probability);
}

void asj_compare_from(asj_estimation *e, int32_t number)
{
    take(e, &e->finalists[number], &e->first);
    see(e, 0, &e->first);
    memset(e->elsewhere, 0, (size_t)e->set.count * sizeof *e->elsewhere);
    for (int32_t side = 0; side < 2; side++)
        find_elsewhere(e, side, e->first.probability);
}

asj_comparison asj_compare_with(asj_estimation *e, const asj_model *other)
{
    take(e, other, &e->other);
    const double colours = e->set.has_colours
                               ? asj_colours_against(&e->set, e->first.probability, e->other.probability, e->vote) : 0;
    asj_comparison c = {contradiction(e), share_of_both(e), colours, -colours, -colours, preference(e)};
    add_pictures(e, &c);
    return c;
}

int32_t asj_finalist_turns_over(const asj_estimation *e, int32_t number)
{
    return asj_turns_over(&e->set, &e->finalists[number], asj_estimation_cameras(e));
}

static int32_t is_overturned(const asj_estimation *e, int32_t best, int32_t rival)
{
    const asj_model *m = &e->finalists[best], *r = &e->finalists[rival];
    return m->evidence > fmax(0, UPRIGHT_AHEAD * r->evidence) && asj_finalist_turns_over(e, rival) &&
           !asj_finalist_turns_over(e, best);
}

int32_t asj_is_upright_instead(const asj_estimation *e, int32_t best, int32_t rival)
{
    const asj_model *m = &e->finalists[best], *r = &e->finalists[rival];
    return UPRIGHT_AHEAD * r->evidence > m->evidence && asj_exclude_each_other(m, r) && asj_finalist_turns_over(e, best) &&
           !asj_finalist_turns_over(e, rival);
}

int32_t asj_is_contradicted(const asj_estimation *e, int32_t best, int32_t rival, const asj_comparison *comparison)
{
    return comparison->against_other > 1 || is_overturned(e, best, rival);
}

int32_t asj_pictures_disagree(const asj_estimation *e, asj_agreement agreement, double log10_nfa)
{
    const double beyond = fmax(0, MUCH - log10_nfa) / (MUCH - VERY_MUCH);
    return e->pictures && agreement.share < fmax(LEAST_AGREEMENT, AGREEMENT - beyond * AGREEMENT_GOES_DOWN);
}

asj_agreement asj_told_agreement(const asj_estimation *e, const asj_model *first)
{
    if (!e->pictures || first->kind == ASJ_GEOMETRY_FUNDAMENTAL)
        return (asj_agreement){0, 0};
    return (asj_agreement){fmax(LEAST_TOLD, e->first.agreement.share), e->first.agreement.known};
}
