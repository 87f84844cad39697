/* SPDX-License-Identifier: BSD-2-Clause */
/* The motion with most evidence is followed to longer and shorter focal lengths in small steps, refined at each, until LESS nats of
 * evidence are lost. The evidence of evidence.c is an integral over the parameters, so that over the log of f, with the prior
 * density p of focal_prior.c, comes on top:
 *
 *     evidence = log of (1 / range) integral of exp(evidence(f)) p(f) d log f,
 *
 * and trying many of them needs no other count of tests. The same weights give mean and standard deviation of log f; LEAST_SD comes
 * to it, since the evidence is rugged: of many matches one focal length stands out, and need not be the right one. (Eighteen scenes
 * as in test_focal.c, of 26 to 400 matches known to .05 to .5 px: found to .8 % in the mean, at worst to 1.5 %, where the weights
 * alone say .1 to 1.) f is known when that is KNOWN at most, the evidence falls by CLOSE to both sides, FEWEST steps are seen, and
 * the path goes on to a longer f; where it was about known before, it still is when it is not known better now. Motions that leave
 * f open (Sturm 2001: optical axes that are parallel, or that meet at the same distance from both cameras; a plane that is seen
 * frontally) have flat evidence, and so they show, unless edges tell f.
 *
 * That is so of errors that each match has for itself. Those that locations have in common (a lens that is no pin hole, a wall
 * that is no plane) move evidence by a part of itself, and of a thousand nats a hundredth is as much as LESS: photographs of
 * cameras side by side, which leave f open, told it to 1 to 3 % and 25 to 180 % off. So where evidence is beyond RUGGED what
 * it says of f counts by one over how many times that it is: variances become wider, and other focal lengths are excluded by more
 * (focal.c), unless edges tell the same f by themselves.
 *
 * Each step starts from two guesses, and the better one is kept: where the last step leads, and what leaves a plane where it was.
 * The first one alone overshoots where directions have pulled at the last step, and profiles break off. */
#include "focal_profile.h"
#include "evidence.h"
#include "labels.h"
#include "manhattan.h"
#include "pairs.h"
#include "posterior.h"
#include "small_matrix.h"
#include "stop.h"

#include <math.h>
#include <string.h>

#define REACH ASJ_FOCAL_REACH
#define SIZES 3  /* of smaller steps */
#define TINY 0.1 /* of a step */
#define FEWEST 5 /* steps within LESS of the best */
#define LESS 10.0
#define CLOSE 2.0
#define RUGGED 100.0 /* nats */
#define KNOWN 0.1
#define LEAST_SD 0.01
#define LENS 0.015
#define LEAST_VARIANCE 1e-12 /* of log f: where one step has all the weight rounding may leave less than none */
#define SMALL 0.02 /* of log f: a step that a path does not jump in */
#define ROUNDS 5
#define LEAST_SHARE (-3.0) /* below that directions are left out: labels (labels.c) would count in full */

static const double sizes[SIZES] = {0.01, 0.003, 0.001}; /* of log f; the first steps are those of the prior */

/* By what logs of likelihoods are divided. */
static double temperature_of(double evidence)
{
    return fmax(1, evidence / RUGGED);
}

double asj_focal_excludes(double evidence)
{
    return LESS * temperature_of(evidence);
}

static double factor_of(const asj_focal_profile *p, const asj_model *m)
{
    return m->cameras[0].fx / p->prior->cameras[0].fx;
}

static int32_t shows_directions(const asj_focal_profile *p, double factor)
{
    return p->prior->edges && asj_log_focal_share(p->prior, factor) >= LEAST_SHARE;
}

/* Of the focal length, as the set is turned to it: where directions are left out, what is left of the density of rotations is the
 * half without them (focal_prior.c). */
static double log_prior_of(const asj_focal_profile *p, const asj_model *m)
{
    const double factor = factor_of(p, m), rest = p->prior->edges && !shows_directions(p, factor) ? log(0.5) : 0;
    return asj_log_focal_prior(p->prior, factor) + rest;
}

asj_status asj_focal_turn(asj_focal_profile *p, double factor)
{
    asj_directions_list directions[2] = {{.count = 0}, {.count = 0}};
    asj_camera cameras[2];
    if (!p->prior->edges)
        return p->status;
    const double share = asj_log_focal_share(p->prior, factor);
    const int32_t shown = shows_directions(p, factor);
    if (shown && p->status == ASJ_OK)
        p->status = asj_focal_directions(p->context, p->prior, factor, directions);
    asj_focal_cameras(p->prior, factor, cameras);
    if (p->status == ASJ_OK)
        p->status = asj_pairs_turn(p->context, directions, shown ? p->branches : NULL, cameras, share, p->set);
    return p->status;
}

/* The vector of a small turn from one rotation to another is its antisymmetric part. */
static void turn_between(const double from[9], const double to[9], double w[3])
{
    double turn[9];
    asj_multiply3_transposed(to, from, turn);
    for (int32_t k = 0; k < 3; k++)
        w[k] = 0.5 * (turn[3 * ((k + 2) % 3) + (k + 1) % 3] - turn[3 * ((k + 1) % 3) + (k + 2) % 3]);
}

/* A guess of the motion of `from` with another focal length, s times as long. `before` NULL: a homography of a plane stays where it
 * was in pixels, but for the rotation, when t becomes D^-1 t and n becomes D n with D = diag(s, s, 1); |t| = 1 again then. Else on
 * from `before`, `ratio` times as far as from there to `from`. */
static void predict(const asj_model *from, const asj_model *before, double ratio, double times, asj_model *to)
{
    double turn[9], w[3];
    for (int32_t v = 0; v < 2; v++) {
        to->cameras[v].fx = times * from->cameras[v].fx;
        to->cameras[v].fy = times * from->cameras[v].fy;
    }
    if (!before) {
        to->translation[0] /= times;
        to->translation[1] /= times;
        const double length = sqrt(asj_dot3(to->translation, to->translation));
        for (int32_t k = 0; k < 3 * to->view.plane_count; k++)
            to->planes[k / 3][k % 3] *= length * (k % 3 < 2 ? times : 1);
        return;
    }
    turn_between(before->rotation, from->rotation, w);
    for (int32_t k = 0; k < 3; k++) {
        w[k] *= ratio;
        to->translation[k] += ratio * (from->translation[k] - before->translation[k]);
    }
    for (int32_t k = 0; k < 3 * to->view.plane_count; k++)
        to->planes[k / 3][k % 3] += ratio * (from->planes[k / 3][k % 3] - before->planes[k / 3][k % 3]);
    asj_rotation_of(w, turn);
    asj_multiply3(turn, from->rotation, to->rotation);
}

/* That motion, refined; 0 when there is none. The set has the directions of its focal length. */
static int32_t refine(asj_focal_profile *p, const asj_model *from, const asj_model *before, double ratio, double times,
                      asj_model *to)
{
    *to = *from;
    predict(from, before, ratio, times, to);
    if (!asj_model_complete(to))
        return 0;
    asj_adjust_like(p->set, to, from, ROUNDS, p->scratch);
    to->evidence = asj_log_evidence(p->set, to, p->scratch) + log_prior_of(p, to);
    return isfinite(to->evidence);
}

/* The better one of both guesses; 0 when there is none. */
static int32_t follow(asj_focal_profile *p, const asj_model *from, const asj_model *before, double ratio, double times,
                      asj_model *to)
{
    asj_model other;
    if (asj_focal_turn(p, times * factor_of(p, from)) != ASJ_OK)
        return 0;
    const int32_t stays = refine(p, from, NULL, 0, times, to);
    if (!before || !refine(p, from, before, ratio, times, &other) || (stays && to->evidence >= other.evidence))
        return stays;
    *to = other;
    return 1;
}

/* Fills the profile to one side of its middle. The first, tiny step tells the direction of the path. */
static void fill_side(asj_focal_profile *p, int32_t side, double *most)
{
    asj_model tiny, *start = &p->at[REACH];
    const asj_model *before = &tiny, *from = start;
    double ratio = -1 / TINY;
    if (!follow(p, start, NULL, 0, exp(side * TINY * p->step), &tiny))
        return;
    for (int32_t k = 1; k <= REACH && !asj_pairs_stop(p->set, NULL); k++) {
        asj_model *to = &p->at[REACH + side * k];
        const double factor = factor_of(p, from) * exp(side * p->step);
        if (factor < p->prior->shortest || factor > asj_focal_factor(p->prior, p->prior->count - 1) ||
            !follow(p, from, before, ratio, exp(side * p->step), to))
            return;
        p->has[REACH + side * k] = 1;
        *most = fmax(*most, to->evidence);
        if (to->evidence < *most - LESS)
            return;
        before = from;
        from = to;
        ratio = 1;
    }
}

/* .. to both; returns how many steps are within LESS of the best. */
static int32_t fill_with(asj_focal_profile *p, double step, double *most)
{
    int32_t count = 0;
    memset(p->has, 0, sizeof p->has);
    p->step = step;
    p->has[REACH] = 1;
    *most = p->at[REACH].evidence;
    fill_side(p, -1, most);
    fill_side(p, 1, most);
    for (int32_t k = 0; k <= 2 * REACH; k++)
        count += p->has[k] && p->at[k].evidence > *most - LESS;
    return count;
}

static int32_t find_best(const asj_focal_profile *p)
{
    int32_t best = REACH;
    for (int32_t k = 0; k <= 2 * REACH; k++)
        best = p->has[k] && p->at[k].evidence > p->at[best].evidence ? k : best;
    return best;
}

/* Where few steps are within LESS of the best, many matches tell f exactly, or the path breaks off: smaller steps from there. */
static int32_t fill(asj_focal_profile *p, double *most)
{
    int32_t count = fill_with(p, p->prior->step, most);
    for (int32_t n = 0; n < SIZES && count < FEWEST && p->status == ASJ_OK; n++) {
        if (sizes[n] >= p->step)
            continue;
        p->at[REACH] = p->at[find_best(p)];
        count = fill_with(p, sizes[n], most);
    }
    return count;
}

/* 0 when there is no motion with a longer focal length. By a small step where that differs much, as a path may jump. */
static int32_t set_along(asj_focal_profile *p, asj_focal *found)
{
    const double step = p->prior->sd > 0 ? fmin(found->sd, SMALL) : found->sd, times = found->sd / step;
    asj_model longer;
    if (!follow(p, &found->model, NULL, 0, exp(step), &longer))
        return 0;
    turn_between(found->model.rotation, longer.rotation, found->along);
    for (int32_t k = 0; k < 3; k++) {
        found->along[k] *= times;
        found->along[3 + k] = times * (longer.translation[k] - found->model.translation[k]);
    }
    return 1;
}

/* What the profile says of log f, relative to what was given: mean and variance, and the log of the mean of the evidence. */
typedef struct summary {
    double mean, variance, mean_weight;
    int32_t steps; /* within LESS of the best */
    int32_t is_cut; /* what its ends cut off would make it wider */
} summary;

static summary summarize(asj_focal_profile *p)
{
    double most, sum = 0, first = 0, second = 0;
    summary s = {.steps = fill(p, &most)};
    int32_t lowest = 2 * REACH, highest = 0;
    for (int32_t k = 0; k <= 2 * REACH; k++) {
        const double weight = p->has[k] ? exp(p->at[k].evidence - most) : 0, x = p->step * (k - REACH);
        lowest = p->has[k] && k < lowest ? k : lowest;
        highest = p->has[k] ? k : highest;
        sum += weight;
        first += weight * x;
        second += weight * x * x;
    }
    s.mean = log(factor_of(p, &p->at[REACH])) + first / sum;
    s.variance = fmax(LEAST_VARIANCE, second / sum - first / sum * (first / sum));
    if (!(p->prior->sd > 0) && !asj_focal_has_edges(p->prior, exp(s.mean)))
        s.variance *= temperature_of(most);
    s.mean_weight = log(sum * p->step / asj_focal_range(p->prior));
    s.is_cut = p->at[lowest].evidence > most - CLOSE || p->at[highest].evidence > most - CLOSE;
    return s;
}

/* Mean and standard deviation of log f with what was known before, when images tell no more than to LENS, as lenses are no pin
 * holes. The profile's are m and v, relative to what was given, which is known to s; so images alone have the precision
 * d = 1 / v - 1 / s^2 and the mean m / (v d). With d' = 1 / (1 / d + LEAST_SD^2 + LENS^2) in place of d both together have the
 * precision d' + 1 / s^2. */
static void combine(double s, summary *of)
{
    const double before = 1 / (s * s), d = 1 / of->variance - before;
    if (!(d > 0)) { /* images tell nothing */
        of->mean = 0;
        of->variance = s * s;
        return;
    }
    const double mean = of->mean / (of->variance * d), wider = 1 / (1 / d + LEAST_SD * LEAST_SD + LENS * LENS);
    of->variance = 1 / (wider + before);
    of->mean = mean * wider * of->variance;
}

/* The motion at that place of log f, from the nearest step on. */
static void move_to(asj_focal_profile *p, double place, int32_t from_best, asj_model *model)
{
    const double middle = log(factor_of(p, &p->at[REACH])), at = REACH + (place - middle) / p->step;
    int32_t nearest = from_best ? find_best(p) : REACH;
    for (int32_t k = 0; k <= 2 * REACH && !from_best; k++)
        nearest = p->has[k] && fabs(k - at) < fabs(nearest - at) ? k : nearest;
    if (!follow(p, &p->at[nearest], NULL, 0, exp(place - middle - p->step * (nearest - REACH)), model))
        *model = p->at[nearest];
}

/* The focal length is that of found->model. Its evidence becomes what the profile has in the mean. */
static void finish(asj_focal_profile *p, double mean_weight, asj_focal *found)
{
    if (asj_focal_turn(p, factor_of(p, &found->model)) != ASJ_OK)
        return;
    const double log_prior = log_prior_of(p, &found->model);
    found->model.evidence -= log_prior;
    asj_settle(p->context, p->set, p->seed, p->scratch, &found->model);
    found->log_share = log_prior + mean_weight;
    found->model.evidence += found->log_share;
    found->model.peak += found->log_share;
}

/* Mean and standard deviation of log f, and the mean evidence. Where it was about known before, and the motion does not tell it
 * (tells: 0 where it cannot), it stays as it was, but for what edges say. */
static void judge(asj_focal_profile *p, int32_t tells, asj_focal *found)
{
    const double sd = p->prior->sd;
    summary s = summarize(p);
    const int32_t told = s.variance + LEAST_SD * LEAST_SD <= KNOWN * KNOWN && !s.is_cut && (s.steps >= FEWEST || sd > 0);
    if (sd > 0 && !(told && tells))
        asj_focal_prior_moments(p->prior, &s.mean, &s.variance);
    if (sd > 0)
        combine(sd, &s);
    else
        s.variance += LEAST_SD * LEAST_SD;
    found->sd = sqrt(s.variance);
    move_to(p, s.mean, sd == 0, &found->model);
    found->is_known = (sd > 0 || (told && (tells || p->prior->edges))) && set_along(p, found);
    finish(p, s.mean_weight, found);
}

asj_status asj_focal_follow(asj_focal_profile *p, const asj_model *start, int32_t tells, asj_focal *found)
{
    asj_model *middle = &p->at[REACH];
    memset(found, 0, sizeof *found);
    *middle = *start;
    if (asj_focal_turn(p, factor_of(p, start)) != ASJ_OK)
        return p->status;
    middle->evidence = asj_log_evidence(p->set, middle, p->scratch) + log_prior_of(p, middle);
    if (isfinite(middle->evidence))
        judge(p, tells, found);
    else
        found->model = *start;
    return p->status;
}
