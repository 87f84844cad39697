/* SPDX-License-Identifier: BSD-2-Clause */
/* What an estimation says in the end.
 *
 * Which kind: the one with the larger evidence. Likelihood ratios of both kinds are taken against the same background, and the
 * volume of their parameters is paid for in the evidence, so a homography wins where a plane explains as much as parallax would,
 * although it has more parameters: it says where a match must lie along the line, too.
 *
 * A pose is one that is known to within POSE_SD, with all other motions counted as likely as their evidence says: all on one plane
 * there are two (Hartley and Zisserman, 13.4), and near that everything between. What is told is cautious
 * (tests/accuracy/tried/geometry.md, "Poses that are hardly known"). Cameras that are known, and fewer than FEW_WITHOUT_POSE
 * matches that leave the pose open, are degenerate: things that look alike hold together by so many. */
#include "answer.h"
#include "ambiguity.h"
#include "contradiction.h"
#include "core/angle.h"
#include "core/watch.h"
#include "evidence.h"
#include "likelihood.h"
#include "motions.h"
#include "other_motions.h"
#include "period.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define ALMOST 0.8
#define POSE_SD (10 * ASJ_DEGREE)
#define FEW_WITHOUT_POSE 15.0 /* of 67 accepted related pairs none without a pose has fewer than 17 */
#define SHIFTED_ROUNDS 3
#define LOOSE_DIRECTION (30 * ASJ_DEGREE) /* a translation known worse than this is none */

/* Covariance of rotation and translation, 6 x 6, from that of the five parameters of model.c; the largest standard deviation of a
 * combination of them. */
static double set_covariance(const asj_estimation *e, int32_t best, double covariance[36])
{
    double five[25], frame[6][5] = {{0}}, axis[3], other[3];
    const double sd = asj_motion_covariance(&e->set, e->finalists, e->count, best, five);
    asj_translation_axes(e->finalists[best].translation, axis, other);
    for (int32_t k = 0; k < 3; k++) {
        frame[k][k] = 1;
        frame[3 + k][3] = axis[k];
        frame[3 + k][4] = other[k];
    }
    for (int32_t i = 0; i < 6; i++)
        for (int32_t j = 0; j < 6; j++) {
            covariance[6 * i + j] = 0;
            for (int32_t p = 0; p < 5; p++)
                for (int32_t q = 0; q < 5; q++)
                    covariance[6 * i + j] += frame[i][p] * five[5 * p + q] * frame[j][q];
        }
    return sd;
}

/* What is not known of the focal length moves the motion, too: the covariance grows by d d' with d the motion's difference when the
 * focal length is a standard deviation longer. Its length, rad. */
static double add_focal(const asj_focal *focal, asj_geometry *result)
{
    const double *d = focal->along;
    for (int32_t i = 0; i < 36; i++)
        result->covariance[i] += d[i / 6] * d[i % 6];
    result->focal_sd = focal->sd;
    return sqrt(asj_dot3(d, d) + asj_dot3(d + 3, d + 3));
}

static void clear_pose(asj_geometry *result)
{
    result->has_pose = 0;
    result->focal_sd = 0;
    memset(result->cameras, 0, sizeof result->cameras);
    memset(result->rotation, 0, sizeof result->rotation);
    memset(result->translation, 0, sizeof result->translation);
    memset(result->covariance, 0, sizeof result->covariance);
}

/* Of an essential matrix, whose probabilities it fills in. 0 when nothing determines its translation. */
static int32_t find_motion(asj_estimation *e, asj_model *m, double *probability, double rotation[9], double translation[3])
{
    asj_probabilities(&e->set, &m->view, 1, &e->scratch.score, probability);
    if (m->view.plane_count == 0 && !(asj_choose_motion(&e->set, probability, m) > -HUGE_VAL))
        return 0;
    memcpy(rotation, m->rotation, 9 * sizeof *rotation);
    memcpy(translation, m->translation, 3 * sizeof *translation);
    return 1;
}

/* Rotation and translation of an essential matrix. 0 when nothing determines its translation. */
static int32_t set_pose(asj_estimation *e, int32_t number, asj_geometry *result)
{
    asj_model *m = &e->finalists[number];
    if (!find_motion(e, m, e->scratch.probability, result->rotation, result->translation))
        return 0;
    double sd = set_covariance(e, number, result->covariance);
    if (asj_has_found_focal(e, number) && e->focal.is_known)
        sd = hypot(sd, add_focal(&e->focal, result));
    memcpy(result->cameras, m->cameras, sizeof result->cameras);
    result->has_pose = sd < POSE_SD;
    if (asj_has_found_focal(e, number) && ((sd >= LOOSE_DIRECTION && e->options->focal_sd == 0) || !e->focal.is_known))
        clear_pose(result); /* a motion that is none tells no focal length */
    return sd < LOOSE_DIRECTION;
}

static void set_matrix(const asj_model *m, asj_geometry *result)
{
    double sum = 0;
    for (int32_t k = 0; k < 9; k++)
        sum += m->view.matrix[k] * m->view.matrix[k];
    for (int32_t k = 0; k < 9; k++)
        result->matrix[k] = m->view.matrix[k] / sqrt(sum);
}

/* Where the motion is not known well enough to be told, the homography says what there is to say. */
static int32_t instead_of(const asj_estimation *e, int32_t best)
{
    const int32_t flat = asj_estimation_best(e, ASJ_GEOMETRY_HOMOGRAPHY);
    const int32_t instead = flat >= 0 && !asj_model_only_turns(&e->finalists[flat]);
    return instead && e->finalists[flat].evidence > ALMOST * e->finalists[best].evidence ? flat : best;
}

/* A plane, or a camera that only turns, explains as much with any focal length: one that was found, and of which nothing
 * was known before, is believed where the motion explains about as much as anything else. */
static int32_t is_believed(const asj_estimation *e, int32_t essential, int32_t best)
{
    const int32_t was_known = !asj_has_found_focal(e, essential) || e->options->focal_sd > 0;
    return was_known || e->finalists[essential].evidence > ALMOST * e->finalists[best].evidence;
}

/* Where a camera that only turns explains more than any motion with a translation (pure_rotation.c), that translation suits errors
 * of locations. */
static int32_t only_turns(const asj_estimation *e, int32_t essential, int32_t turned)
{
    return turned >= 0 && e->finalists[turned].evidence > e->finalists[essential].evidence;
}

/* In place of what there is of a pose. */
static void set_rotation(const asj_estimation *e, int32_t turned, asj_geometry *result)
{
    const asj_model *m = &e->finalists[turned];
    result->only_turns = 1;
    memcpy(result->cameras, m->cameras, sizeof result->cameras);
    memcpy(result->rotation, m->rotation, sizeof result->rotation);
    for (int32_t k = 0; k < 9; k++)
        result->covariance[6 * (k / 3) + k % 3] = m->covariance[k];
    if (e->rotation_focal.is_known)
        add_focal(&e->rotation_focal, result);
}

/* Which finalist is told, -1 = there is none, with its pose. *determined: 0 when nothing determines its motion. */
static int32_t choose(asj_estimation *e, asj_geometry *result, int32_t *determined)
{
    const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_AUTO);
    const int32_t essential = asj_estimation_best(e, ASJ_GEOMETRY_ESSENTIAL); /* a plane's pose comes from here, too */
    const int32_t turned = asj_estimation_best_rotation(e);
    int32_t chosen = best;
    *determined = 1;
    if (best >= 0 && essential >= 0 && !only_turns(e, essential, turned) && is_believed(e, essential, best) &&
        asj_estimation_counts(e, essential))
        *determined = set_pose(e, essential, result);
    if (best >= 0 && best == essential && !result->has_pose)
        chosen = instead_of(e, best);
    if (chosen != essential)
        *determined = 1;
    if (best >= 0 && best == turned && e->options->model == ASJ_GEOMETRY_ESSENTIAL) {
        chosen = essential;
        *determined = 0;
    }
    if (chosen >= 0 && best == turned)
        set_rotation(e, turned, result);
    return chosen;
}

static int32_t has_open_focal(const asj_estimation *e, int32_t number)
{
    return asj_has_found_focal(e, number) && !e->focal.is_known;
}

/* All but its pose. */
static void describe(asj_estimation *e, int32_t number, asj_geometry *result)
{
    const asj_model *m = &e->finalists[number];
    result->model = has_open_focal(e, number) ? ASJ_GEOMETRY_FUNDAMENTAL : m->kind;
    result->log10_nfa = asj_estimation_log10_nfa(e, m);
    set_matrix(m, result);
    result->inliers = asj_explained(&e->set, m, &e->scratch);
}

/* Whether the motion that was asked for stays open. */
static int32_t is_open(const asj_estimation *e, int32_t number, const asj_geometry *result)
{
    const int32_t motion = number == asj_estimation_best(e, ASJ_GEOMETRY_ESSENTIAL) && !has_open_focal(e, number);
    return (motion && !result->has_pose && result->inliers < FEW_WITHOUT_POSE) ||
           (has_open_focal(e, number) && e->options->model == ASJ_GEOMETRY_ESSENTIAL);
}

static void describe_rival(asj_estimation *e, int32_t number, asj_geometry *result)
{
    asj_model *m = &e->finalists[number];
    result->has_rival = 1;
    result->rival_log10_nfa = asj_estimation_log10_nfa(e, m);
    if (m->kind == ASJ_GEOMETRY_ESSENTIAL)
        find_motion(e, m, e->other.probability, result->rival_rotation, result->rival_translation);
    else if (asj_model_only_turns(m))
        memcpy(result->rival_rotation, m->rotation, sizeof result->rival_rotation);
}

/* Where all that a motion has matched repeats, another one explains it as well (period.c), whatever evidence that has. The best one
 * is e->first, and stays it. */
static asj_status doubt_what_repeats(asj_estimation *e, int32_t best, asj_geometry *result)
{
    const asj_model *m = &e->finalists[best];
    asj_model shifted;
    const int32_t found = m->kind == ASJ_GEOMETRY_ESSENTIAL
                              ? asj_find_period(&e->context->memory, &e->set, m, e->first.probability, &shifted) : 0;
    if (found < 0)
        return asj_fail(e->context, ASJ_ERROR_MEMORY, "no memory for what repeats");
    if (found == 0)
        return ASJ_OK;
    asj_adjust(&e->set, &shifted, SHIFTED_ROUNDS, &e->scratch);
    shifted.evidence = asj_log_evidence(&e->set, &shifted, &e->scratch);
    if (shifted.evidence > -HUGE_VAL && asj_compare_with(e, &shifted).against_other > 1)
        return ASJ_OK;
    result->status = ASJ_GEOMETRY_AMBIGUOUS;
    if (shifted.evidence > -HUGE_VAL) {
        result->has_rival = 1;
        result->rival_log10_nfa = asj_estimation_log10_nfa(e, &shifted);
        memcpy(result->rival_rotation, shifted.rotation, sizeof result->rival_rotation);
        memcpy(result->rival_translation, shifted.translation, sizeof result->rival_translation);
    }
    return ASJ_OK;
}

asj_status asj_answer(asj_estimation *e, asj_judge *judge, asj_geometry *result)
{
    int32_t determined, doubt = 0;
    const int32_t best = choose(e, result, &determined);
    result->status = ASJ_GEOMETRY_CHANCE;
    if (best < 0)
        return ASJ_OK;
    describe(e, best, result);
    const int32_t second = asj_strongest_rival(e, best, &doubt);
    if (asj_watch_end(e->set.watch) != ASJ_OK)
        return ASJ_ERROR_CANCELLED; /* rivals that nobody has looked at */
    const asj_agreement agreement = asj_told_agreement(e, &e->finalists[best]);
    result->picture_agreement = agreement.share;
    result->picture_knowledge = agreement.known;
    if (second >= 0)
        describe_rival(e, second, result);
    if (result->log10_nfa > log10(e->options->epsilon))
        result->log10_nfa += asj_estimation_log10_agreement(e->first.agreement);
    if (result->log10_nfa > log10(e->options->epsilon) || asj_pictures_disagree(e, e->first.agreement, result->log10_nfa))
        return ASJ_OK;
    result->status = determined && !is_open(e, best, result) ? ASJ_GEOMETRY_ACCEPTED : ASJ_GEOMETRY_DEGENERATE;
    if (second >= 0 && asj_is_ambiguous(e, best, second, doubt, result->inliers))
        result->status = ASJ_GEOMETRY_AMBIGUOUS;
    const asj_status status = result->status == ASJ_GEOMETRY_ACCEPTED ? doubt_what_repeats(e, best, result) : ASJ_OK;
    if (status == ASJ_OK && judge && result->status == ASJ_GEOMETRY_ACCEPTED)
        *judge = asj_judge_create(&e->finalists[best].view, &e->set);
    return status;
}
