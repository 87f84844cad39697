/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_geometry_estimate(): two-view geometry from candidate matches with affine maps.
 *
 *   pairs.c       candidates -> places, priors
 *   search.c      samples (minimal.c, five_point.c), scores (likelihood.c), refinement (adjust.c)
 *   motions.c     essential matrices with planes (planes.c), and what the candidates allow around them (posterior.c)
 *   focal.c       the same for a row of focal lengths, where none is known and it is asked for
 *   rivals.c      what explains as much without the candidates of the best one
 *   evidence.c    how often chance brings as much
 *   model.c       what moves when a geometry moves
 *
 * Which kind: the one with the larger evidence. Likelihood ratios of both kinds are taken against the same background, and the
 * volume of their parameters is paid for in the evidence, so a homography wins where a plane explains as much as parallax would,
 * although it has more parameters: it says where a match must lie along the line, too.
 *
 * Ambiguous: another geometry, of whatever kind, whose log evidence is at least NEARLY of the best one's or within APART of it, and
 * whose matches contradict those of the best one: CONTRARY of them, or CONTRARY_ALIKE where it has as much evidence and is another
 * motion, give another partner to a place that is matched. Things that repeat do that, shifted by a period or turned. The evidence
 * itself would be surer (odds of a hundred are 5 nats of a hundred or two), but what repeats is matched more or less well for
 * reasons that the model does not know, and all its places together: of rendered rooms with tiled floors, wrong geometries have up
 * to 1.6 times the log evidence of the best one that contradicts them, and with fewer than FEW matches more than that.
 *
 * Where images have colours, these say of rivals which one is wrong (colour_vote.c).
 *
 * A pose is one that is known to within POSE_SD, with all other motions counted as likely as their evidence says: all on one plane
 * there are two (Hartley and Zisserman, 13.4), and near that everything between. */
#include "core/angle.h"
#include "colour_vote.h"
#include "estimate.h"
#include "evidence.h"
#include "focal.h"
#include "motions.h"
#include "pairs.h"
#include "posterior.h"
#include "rivals.h"
#include "search.h"
#include "small_matrix.h"
#include "stop.h"

#include <math.h>
#include <string.h>

#define MOST_KINDS 3
#define NEARLY 0.6
#define APART 8.0 /* decades */
#define FEW 15.0 /* matches */
#define NEARLY_OF_FEW 0.3
#define APART_OF_FEW 13.0
#define CONTRARY 0.4
#define CONTRARY_ALIKE 0.15 /* of a rival with as much evidence */
#define SIMILAR_MOTION (6 * ASJ_DEGREE)
/* Nats that a score loses at least on the way to an evidence: volume of the parameters, near places. Of 69 pairs of unrelated
 * images 46 stay below; of 46 accepted ones none is within 8 nats of it. */
#define GIVE_UP 17.0
#define ALMOST 0.8
#define POSE_SD (4 * ASJ_DEGREE)
#define LOOSE_DIRECTION (30 * ASJ_DEGREE) /* a translation known worse than this is none */

/* One call. */
typedef struct estimation {
    asj_context *context;
    const asj_geometry_options *options;
    asj_pairs set;
    asj_model finalists[2 * MOST_KINDS * ASJ_FINALISTS]; /* and their rivals */
    int32_t count;
    asj_adjust_scratch scratch;
    double *other; /* probabilities under a second geometry */
    double *vote;  /* colour_vote.c */
    asj_focal focal;
    int32_t focal_at; /* where the finalist with the found focal length stands; -1 = there is none */
} estimation;

/* --- options ----------------------------------------------------------------------------------------------------------------- */

void asj_geometry_options_init(asj_geometry_options *options)
{
    if (!options)
        return;
    memset(options, 0, sizeof *options);
    options->model = ASJ_GEOMETRY_AUTO;
    options->samples = 1000;
    options->seed = 1;
    options->epsilon = 1e-7;
    options->location_sd = 1.5;
    options->angle_sd = 9;
    options->scale_sd = 0.22;
}

static int32_t within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static int32_t known(const asj_camera *c)
{
    return c->fx > 0;
}

static asj_status check_camera(asj_context *context, const asj_camera *c, int32_t number)
{
    if (c->fx == 0 && c->fy == 0 && isfinite(c->cx) && isfinite(c->cy))
        return ASJ_OK;
    if (!within(c->fx, 1, 1e7) || !within(c->fy, 1, 1e7) || !within(fabs(c->cx), 0, 1e7) || !within(fabs(c->cy), 0, 1e7))
        return asj_fail(context, ASJ_ERROR_OPTION, "camera %d cannot be: fx %g, fy %g, cx %g, cy %g", (int)number,
                        c->fx, c->fy, c->cx, c->cy);
    return ASJ_OK;
}

static asj_status check(asj_context *context, const asj_geometry_options *o)
{
    for (int32_t v = 0; v < 2; v++) {
        const asj_status status = check_camera(context, &o->cameras[v], v + 1);
        if (status != ASJ_OK)
            return status;
        if (o->widths[v] < 1 || o->heights[v] < 1)
            return asj_fail(context, ASJ_ERROR_OPTION, "image %d has no size", (int)v + 1);
    }
    if (o->model < ASJ_GEOMETRY_NONE || o->model > ASJ_GEOMETRY_HOMOGRAPHY)
        return asj_fail(context, ASJ_ERROR_OPTION, "no such geometry: %d", (int)o->model);
    if (o->find_focal < 0 || o->find_focal > 1)
        return asj_fail(context, ASJ_ERROR_OPTION, "find_focal is %d, not 0 or 1", (int)o->find_focal);
    if (o->find_focal && (known(&o->cameras[0]) || known(&o->cameras[1])))
        return asj_fail(context, ASJ_ERROR_OPTION, "find_focal: the focal length of a camera is given");
    if (o->find_focal && o->model > ASJ_GEOMETRY_ESSENTIAL)
        return asj_fail(context, ASJ_ERROR_OPTION, "find_focal: only model auto and essential have a focal length");
    if (o->model == ASJ_GEOMETRY_ESSENTIAL && !o->find_focal && !(known(&o->cameras[0]) && known(&o->cameras[1])))
        return asj_fail(context, ASJ_ERROR_OPTION, "an essential matrix needs both cameras");
    if (o->samples < 1 || o->samples > 100000 || !within(o->epsilon, 1e-12, 1) || !within(o->location_sd, 0.1, 10) ||
        !within(o->angle_sd, 1, 45) || !within(o->scale_sd, 0.02, 1))
        return asj_fail(context, ASJ_ERROR_OPTION, "samples, epsilon or a standard deviation of the geometry is out of range");
    return ASJ_OK;
}

/* --- search ------------------------------------------------------------------------------------------------------------------ */

/* Cameras that are not known have the longer side as focal length. */
static asj_search plan(const estimation *e, int32_t kind)
{
    const asj_geometry_options *o = e->options;
    asj_search search = {kind, o->samples, o->seed, {o->cameras[0], o->cameras[1]}, GIVE_UP - log(o->epsilon), NULL};
    for (int32_t v = 0; v < 2; v++)
        if (!known(&search.cameras[v])) {
            const double longer = o->widths[v] > o->heights[v] ? o->widths[v] : o->heights[v];
            search.cameras[v] = (asj_camera){longer, longer, 0.5 * (o->widths[v] - 1), 0.5 * (o->heights[v] - 1)};
        }
    return search;
}

static asj_status search_kind(estimation *e, int32_t kind)
{
    const asj_search search = plan(e, kind);
    int32_t count = 0;
    const asj_status status = asj_geometry_search(e->context, &e->set, &search, e->finalists + e->count, &count);
    e->count += count;
    return status;
}

/* The one with the largest evidence, of a kind or of any (ASJ_GEOMETRY_AUTO); -1 when there is none. */
static int32_t best_of(const estimation *e, int32_t kind)
{
    int32_t best = -1;
    for (int32_t k = 0; k < e->count; k++)
        if ((kind == ASJ_GEOMETRY_AUTO || e->finalists[k].kind == kind) && e->finalists[k].evidence > -HUGE_VAL &&
            (best < 0 || e->finalists[k].evidence > e->finalists[best].evidence))
            best = k;
    return best;
}

/* One focal length for both, in place of cameras. */
static asj_status search_focal(estimation *e)
{
    const asj_search search = plan(e, ASJ_GEOMETRY_ESSENTIAL);
    asj_model flat[ASJ_FINALISTS];
    int32_t count = 0;
    for (int32_t k = 0; k < e->count && count < ASJ_FINALISTS; k++)
        if (e->finalists[k].kind == ASJ_GEOMETRY_HOMOGRAPHY)
            flat[count++] = e->finalists[k];
    const asj_status status = asj_find_focal(e->context, &e->set, &search, flat, count, &e->focal);
    if (status == ASJ_OK && e->focal.model.evidence > -HUGE_VAL) {
        e->focal_at = e->count;
        e->finalists[e->count++] = e->focal.model;
    }
    return status;
}

/* What is searched: the kind with epipolar lines, ASJ_GEOMETRY_NONE for none; and homographies? */
static int32_t epipolar_kind(const asj_geometry_options *o)
{
    const int32_t best = known(&o->cameras[0]) && known(&o->cameras[1]) ? ASJ_GEOMETRY_ESSENTIAL : ASJ_GEOMETRY_FUNDAMENTAL;
    if (o->model == ASJ_GEOMETRY_AUTO)
        return best;
    return o->model == ASJ_GEOMETRY_FUNDAMENTAL || o->model == best ? o->model : ASJ_GEOMETRY_NONE;
}

static int32_t with_homographies(const asj_geometry_options *o)
{
    return o->model == ASJ_GEOMETRY_AUTO || o->model == ASJ_GEOMETRY_HOMOGRAPHY;
}

static asj_status search_all(estimation *e)
{
    const asj_geometry_options *o = e->options;
    const int32_t epipolar = epipolar_kind(o);
    asj_status status = ASJ_OK;
    if (epipolar != ASJ_GEOMETRY_NONE)
        status = search_kind(e, epipolar);
    if (status == ASJ_OK && with_homographies(o))
        status = search_kind(e, ASJ_GEOMETRY_HOMOGRAPHY);
    if (status == ASJ_OK && epipolar == ASJ_GEOMETRY_ESSENTIAL)
        status = asj_refine_motions(e->context, &e->set, o->cameras, o->seed, ASJ_SETTLED, e->finalists, &e->count);
    return status == ASJ_OK && o->find_focal ? search_focal(e) : status;
}

static double log10_nfa(const estimation *e, const asj_model *m)
{
    const double tried = e->options->model != ASJ_GEOMETRY_AUTO ? 1 : e->options->find_focal ? MOST_KINDS : MOST_KINDS - 1;
    return (log(tried) - m->evidence) / log(10);
}

static int32_t is_chance(const estimation *e, int32_t number)
{
    return number < 0 || log10_nfa(e, &e->finalists[number]) > log10(e->options->epsilon);
}

/* Only what is about to be accepted needs them. */
static asj_status search_rivals(estimation *e)
{
    const int32_t best = best_of(e, ASJ_GEOMETRY_AUTO), epipolar = epipolar_kind(e->options);
    asj_search kinds[2];
    int32_t kind_count = 0, more = 0;
    if (is_chance(e, best))
        return ASJ_OK;
    if (epipolar != ASJ_GEOMETRY_NONE)
        kinds[kind_count++] = plan(e, epipolar);
    if (with_homographies(e->options))
        kinds[kind_count++] = plan(e, ASJ_GEOMETRY_HOMOGRAPHY);
    const asj_camera *cameras = epipolar == ASJ_GEOMETRY_ESSENTIAL ? e->options->cameras : NULL;
    const asj_status status = asj_find_rivals(e->context, &e->set, kinds, kind_count, cameras, &e->finalists[best],
                                              e->finalists + e->count, &more);
    e->count += more;
    return status;
}

/* --- answer ------------------------------------------------------------------------------------------------------------------ */

/* How much of the second geometry's matches contradicts the first one's: it gives another partner to a place that the first one has
 * matched, in either image, and that the first one does not hold for nearly as likely (near places have two). As a part of all of
 * them. taken: scratch, probability of the first one by place. */
static double contradiction(estimation *e, const asj_model *second)
{
    const double *mine = e->scratch.probability;
    double *const *taken = e->scratch.score.sum;
    double against = 0, all = 0;
    asj_probabilities(&e->set, &second->view, 1, &e->scratch.score, e->other);
    for (int32_t k = 0; k < e->set.count; k++) {
        taken[0][e->set.list[k].place1] += mine[k];
        taken[1][e->set.list[k].place2] += mine[k];
    }
    for (int32_t k = 0; k < e->set.count; k++) {
        const double first = taken[0][e->set.list[k].place1] - mine[k], other = taken[1][e->set.list[k].place2] - mine[k];
        against += e->other[k] * fmax(0, fmin(1, fmax(first, other)) - mine[k]);
        all += e->other[k];
    }
    for (int32_t v = 0; v < 2; v++)
        memset(taken[v], 0, (size_t)e->set.place_count[v] * sizeof *taken[v]);
    return all > 0 ? against / all : 0;
}

/* What a rival is compared with: of a motion that stands for a whole region (posterior.c) the best of it, as the rivals are. */
static double to_compare(const estimation *e, const asj_model *m)
{
    asj_model peak = *m;
    peak.evidence = m->settled ? fmin(m->peak, m->evidence) : m->evidence;
    return log10_nfa(e, &peak);
}

/* How much contradiction makes a rival: CONTRARY, and less where its evidence, `share` of the best one's, comes near: where things
 * repeat, a wrong geometry shares many matches with the right one. Nearly the same motion is no rival for that. */
static double least_contradiction(const asj_model *best, const asj_model *rival, double share)
{
    if (best->kind == ASJ_GEOMETRY_ESSENTIAL && rival->kind == ASJ_GEOMETRY_ESSENTIAL) {
        double turn[9];
        asj_multiply3_transposed(rival->rotation, best->rotation, turn);
        const double along = fabs(asj_dot3(rival->translation, best->translation));
        if (asj_rotation_angle(turn) < SIMILAR_MOTION && along > cos(SIMILAR_MOTION))
            return CONTRARY;
    }
    const double nearness = fmin(1, fmax(0, (share - NEARLY) / (1 - NEARLY)));
    return CONTRARY + (CONTRARY_ALIKE - CONTRARY) * nearness;
}

/* The largest evidence of a geometry that contradicts the one whose probabilities are in scratch, and that the colours do not
 * contradict; -1 = none. */
static int32_t second_of(estimation *e, int32_t best)
{
    int32_t second = -1;
    const asj_model *m = &e->finalists[best];
    for (int32_t n = 0; n < e->count; n++) {
        const asj_model *rival = &e->finalists[n];
        if (n == best || (second >= 0 && rival->evidence <= e->finalists[second].evidence))
            continue;
        if (contradiction(e, rival) > least_contradiction(m, rival, log10_nfa(e, rival) / to_compare(e, m)) &&
            !asj_colours_contradict(&e->set, e->scratch.probability, e->other, e->vote))
            second = n;
    }
    return second;
}

/* May the second one be the right one as well? nfa: log10, of the best one. */
static int32_t is_near(double nfa, double second, double matches)
{
    const int32_t few = matches < FEW;
    return second <= fmax((few ? NEARLY_OF_FEW : NEARLY) * nfa, nfa + (few ? APART_OF_FEW : APART));
}

/* Covariance of rotation and translation, 6 x 6, from that of the five parameters of model.c; the largest standard deviation of a
 * combination of them. */
static double set_covariance(const estimation *e, int32_t best, double covariance[36])
{
    double five[25], frame[6][5] = {{0}}, axis[3], other[3];
    const double sd = asj_motion_covariance(e->finalists, e->count, best, five);
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
    result->focal[0] = result->focal[1] = result->focal_sd = 0;
    memset(result->rotation, 0, sizeof result->rotation);
    memset(result->translation, 0, sizeof result->translation);
    memset(result->covariance, 0, sizeof result->covariance);
}

/* Rotation and translation of an essential matrix. 0 when nothing determines its translation. */
static int32_t set_pose(estimation *e, int32_t number, asj_geometry *result)
{
    asj_model *m = &e->finalists[number];
    asj_probabilities(&e->set, &m->view, 1, &e->scratch.score, e->scratch.probability);
    if (m->view.plane_count == 0 && !(asj_choose_motion(&e->set, e->scratch.probability, m) > -HUGE_VAL))
        return 0;
    double sd = set_covariance(e, number, result->covariance);
    if (number == e->focal_at && e->focal.is_known)
        sd = hypot(sd, add_focal(&e->focal, result));
    memcpy(result->rotation, m->rotation, sizeof result->rotation);
    memcpy(result->translation, m->translation, sizeof result->translation);
    result->focal[0] = m->cameras[0].fx;
    result->focal[1] = m->cameras[1].fx;
    result->has_pose = sd < POSE_SD;
    if (number == e->focal_at && (sd >= LOOSE_DIRECTION || !e->focal.is_known)) /* a motion that is none tells no focal length */
        clear_pose(result);
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

/* A camera that only turns obeys a homography, and an essential matrix with any translation and a plane far away: where the motion
 * is not known well enough to be told, the homography says what there is to say. */
static int32_t instead_of(const estimation *e, int32_t best)
{
    const int32_t flat = best_of(e, ASJ_GEOMETRY_HOMOGRAPHY);
    return flat >= 0 && e->finalists[flat].evidence > ALMOST * e->finalists[best].evidence ? flat : best;
}

/* A plane, or a camera that only turns, explains as much with any focal length: one that was found is believed where the motion
 * explains about as much as anything else. */
static int32_t is_believed(const estimation *e, int32_t essential, int32_t best)
{
    return essential != e->focal_at || e->finalists[essential].evidence > ALMOST * e->finalists[best].evidence;
}

static void answer(estimation *e, double *probabilities, asj_geometry *result)
{
    int32_t best = best_of(e, ASJ_GEOMETRY_AUTO), determined = 1;
    const double least = log10(e->options->epsilon);
    result->status = ASJ_GEOMETRY_CHANCE;
    if (best < 0)
        return;
    const int32_t essential = best_of(e, ASJ_GEOMETRY_ESSENTIAL); /* a plane's pose comes from here, too */
    if (essential >= 0 && is_believed(e, essential, best) && log10_nfa(e, &e->finalists[essential]) <= least)
        determined = set_pose(e, essential, result);
    if (best == essential && !result->has_pose)
        best = instead_of(e, best);
    determined = determined || best != essential;
    const asj_model *m = &e->finalists[best];
    const int32_t open_focal = best == e->focal_at && !e->focal.is_known;
    result->model = open_focal ? ASJ_GEOMETRY_FUNDAMENTAL : m->kind;
    result->log10_nfa = log10_nfa(e, m);
    set_matrix(m, result);
    asj_probabilities(&e->set, &m->view, 1, &e->scratch.score, e->scratch.probability);
    for (int32_t k = 0; k < e->set.count; k++)
        result->inliers += e->scratch.probability[k];
    const int32_t second = second_of(e, best);
    if (second >= 0) {
        result->has_second = 1;
        result->second_log10_nfa = log10_nfa(e, &e->finalists[second]);
    }
    if (result->log10_nfa > least)
        return;
    if (open_focal && e->options->model == ASJ_GEOMETRY_ESSENTIAL)
        determined = 0;
    result->status = !determined ? ASJ_GEOMETRY_DEGENERATE : ASJ_GEOMETRY_ACCEPTED;
    if (second >= 0 && is_near(to_compare(e, m), result->second_log10_nfa, result->inliers))
        result->status = ASJ_GEOMETRY_AMBIGUOUS;
    for (int32_t k = 0; k < e->set.count && probabilities; k++)
        probabilities[e->set.list[k].source] = e->scratch.probability[k];
}

asj_status asj_geometry_estimate(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                                 const asj_geometry_options *options, double *probabilities, asj_geometry *result)
{
    return asj_estimate_with_colours(context, candidates, count, NULL, options, probabilities, result);
}

asj_status asj_estimate_with_colours(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                                     const double *colours, const asj_geometry_options *options, double *probabilities,
                                     asj_geometry *result)
{
    if (!context)
        return ASJ_ERROR_ARGUMENT;
    if (!options || !result || (!candidates && count > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the candidates, the options or the result is NULL");
    asj_status status = check(context, options);
    if (status != ASJ_OK)
        return status;
    asj_geometry found;
    memset(&found, 0, sizeof found);
    estimation *e = asj_allocate_zero(&context->memory, 1, sizeof *e);
    if (!e)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the geometry");
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_ASSIGN);
    e->context = context;
    e->options = options;
    e->focal_at = -1;
    status = asj_pairs_create(context, candidates, count, colours, options, &e->set);
    e->set.watch = &watch;
    for (size_t k = 0; k < count && probabilities; k++)
        probabilities[k] = 0;
    if (status == ASJ_OK && options->model != ASJ_GEOMETRY_NONE) {
        if (e->set.place_count[0] < 2 || e->set.place_count[1] < 2) {
            found.status = ASJ_GEOMETRY_TOO_FEW;
        } else {
            e->other = asj_allocate(&context->memory, (size_t)e->set.count, sizeof *e->other);
            const int32_t places = e->set.place_count[0] > e->set.place_count[1] ? e->set.place_count[0] : e->set.place_count[1];
            e->vote = asj_allocate(&context->memory, (size_t)places, 4 * sizeof *e->vote);
            status = e->other && e->vote && asj_adjust_scratch_create(&context->memory, &e->set, &e->scratch)
                         ? search_all(e) : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the geometry");
            if (status == ASJ_OK)
                status = search_rivals(e);
            if (status == ASJ_OK)
                status = asj_watch_end(&watch);
            if (status == ASJ_OK)
                answer(e, probabilities, &found);
        }
    }
    asj_adjust_scratch_free(&context->memory, &e->scratch);
    asj_release(&context->memory, e->other);
    asj_release(&context->memory, e->vote);
    asj_pairs_free(&context->memory, &e->set);
    asj_release(&context->memory, e);
    if (status == ASJ_OK)
        *result = found;
    return status;
}

const char *asj_geometry_model_name(int32_t model)
{
    static const char *const names[] = {"none", "auto", "essential", "fundamental", "homography"};
    return model >= ASJ_GEOMETRY_NONE && model <= ASJ_GEOMETRY_HOMOGRAPHY ? names[model] : "unknown";
}

const char *asj_geometry_status_name(int32_t status)
{
    static const char *const names[] = {"not asked", "accepted", "chance", "too few", "ambiguous", "degenerate"};
    return status >= ASJ_GEOMETRY_NOT_ASKED && status <= ASJ_GEOMETRY_DEGENERATE ? names[status] : "unknown";
}
