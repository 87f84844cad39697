/* SPDX-License-Identifier: BSD-2-Clause */
/* One focal length for both cameras, square pixels, principal points known: six parameters of the seven of a fundamental matrix.
 *
 * Formulas that take it from a fundamental matrix (Bougnoux 1998; Sturm 2001 for equal ones) need a better matrix than a dozen
 * matches among hundreds of wrong ones give. So focal lengths are tried: with each of COARSE ones motions are sampled and refined
 * as with known cameras; the motion of the one with most evidence is followed to longer and shorter ones in small steps, refined
 * at each, until LESS nats of evidence are lost. The evidence of evidence.c is an integral over the parameters, so that over the
 * log of f, with a flat prior between SHORTEST and LONGEST of the longer side, comes on top:
 *
 *     evidence = 1 / log(LONGEST / SHORTEST) integral of evidence(f) d log f,
 *
 * and trying many of them needs no other count of tests. The same weights evidence(f) give mean and standard deviation of log f.
 * f is known when that is KNOWN at most and the evidence falls by CLOSE to both sides. Motions that leave f open (Sturm 2001:
 * optical axes that are parallel, or that meet at the same distance from both cameras; a plane that is seen frontally) have flat
 * evidence, and so they show. */
#include "focal.h"
#include "evidence.h"
#include "motions.h"
#include "posterior.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define SHORTEST 0.4
#define LONGEST 4.0
#define COARSE 5
#define FIRST 0.55 /* of the longer side; then .. */
#define TIMES 1.45
#define FINE 0.05 /* of the log of f */
#define FINER 0.01
#define TINY 0.1 /* of a step */
#define REACH 24 /* steps to either side */
#define FEWEST 5 /* steps within LESS of the best */
#define LESS 10.0
#define CLOSE 2.0
#define KNOWN 0.1
#define ROUNDS 5

typedef struct profile {
    asj_model at[2 * REACH + 1];
    int32_t has[2 * REACH + 1];
    asj_model finalists[2 * ASJ_FINALISTS + ASJ_FINALISTS];
    asj_adjust_scratch *scratch; /* for each thread; the first one serves where there is one only */
    double step;
} profile;

static void set_cameras(const asj_search *search, double factor, asj_camera cameras[2])
{
    for (int32_t v = 0; v < 2; v++) {
        cameras[v] = search->cameras[v];
        cameras[v].fx *= factor;
        cameras[v].fy *= factor;
    }
}

/* The best motion with one focal length. */
static asj_status search_at(asj_context *context, const asj_pairs *set, const asj_search *search, double factor,
                            const asj_model *flat, int32_t flat_count, profile *p, asj_model *best)
{
    asj_search with = *search;
    int32_t count = 0;
    with.kind = ASJ_GEOMETRY_ESSENTIAL;
    set_cameras(search, factor, with.cameras);
    asj_status status = asj_geometry_search(context, set, &with, p->finalists, &count);
    if (status == ASJ_OK && flat_count > 0) {
        memcpy(p->finalists + count, flat, (size_t)flat_count * sizeof *flat);
        count += flat_count;
    }
    if (status == ASJ_OK && count > 0)
        status = asj_refine_motions(context, set, with.cameras, search->seed, 0, p->finalists, &count);
    for (int32_t k = 0; k < count && status == ASJ_OK; k++)
        if (p->finalists[k].kind == ASJ_GEOMETRY_ESSENTIAL && p->finalists[k].evidence > best->evidence)
            *best = p->finalists[k];
    return status;
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

/* That motion, refined; 0 when there is none. */
static int32_t follow(const asj_pairs *set, const asj_model *from, const asj_model *before, double ratio, double times,
                      asj_adjust_scratch *scratch, asj_model *to)
{
    *to = *from;
    predict(from, before, ratio, times, to);
    if (!asj_model_complete(to))
        return 0;
    asj_adjust_like(set, to, from, ROUNDS, scratch);
    to->evidence = asj_log_evidence(set, to, scratch);
    return isfinite(to->evidence);
}

static double factor_of(const asj_search *search, const asj_model *m)
{
    return m->cameras[0].fx / search->cameras[0].fx;
}

/* Fills the profile to one side of its middle. The first, tiny step tells the direction of the path. */
static void fill_side(const asj_pairs *set, const asj_search *search, int32_t side, profile *p, double *most)
{
    asj_model tiny, *start = &p->at[REACH];
    const asj_model *before = &tiny, *from = start;
    double ratio = -1 / TINY;
    if (!follow(set, start, NULL, 0, exp(side * TINY * p->step), p->scratch, &tiny))
        return;
    for (int32_t k = 1; k <= REACH; k++) {
        asj_model *to = &p->at[REACH + side * k];
        const double factor = factor_of(search, from) * exp(side * p->step);
        if (factor < SHORTEST || factor > LONGEST || !follow(set, from, before, ratio, exp(side * p->step), p->scratch, to))
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
static int32_t fill(const asj_pairs *set, const asj_search *search, double step, profile *p, double *most)
{
    int32_t count = 0;
    memset(p->has, 0, sizeof p->has);
    p->step = step;
    p->has[REACH] = 1;
    *most = p->at[REACH].evidence;
    fill_side(set, search, -1, p, most);
    fill_side(set, search, 1, p, most);
    for (int32_t k = 0; k <= 2 * REACH; k++)
        count += p->has[k] && p->at[k].evidence > *most - LESS;
    return count;
}

/* 0 when there is no motion with a longer focal length. */
static int32_t set_along(const asj_pairs *set, profile *p, asj_focal *found)
{
    asj_model longer;
    if (!follow(set, &found->model, NULL, 0, exp(found->sd), p->scratch, &longer))
        return 0;
    turn_between(found->model.rotation, longer.rotation, found->along);
    for (int32_t k = 0; k < 3; k++)
        found->along[3 + k] = longer.translation[k] - found->model.translation[k];
    return 1;
}

/* Mean and standard deviation of log f, and the mean evidence. */
static void judge(asj_context *context, const asj_pairs *set, const asj_search *search, profile *p, asj_focal *found)
{
    double most;
    int32_t steps = fill(set, search, FINE, p, &most);
    if (steps < FEWEST) /* very sharp, or a path that breaks off */
        steps = fill(set, search, FINER, p, &most);
    double sum = 0, first = 0, second = 0;
    int32_t nearest = REACH, lowest = 2 * REACH, highest = 0;
    for (int32_t k = 0; k <= 2 * REACH; k++) {
        const double weight = p->has[k] ? exp(p->at[k].evidence - most) : 0, x = p->step * (k - REACH);
        lowest = p->has[k] && k < lowest ? k : lowest;
        highest = p->has[k] ? k : highest;
        sum += weight;
        first += weight * x;
        second += weight * x * x;
        nearest = p->has[k] && p->at[k].evidence > p->at[nearest].evidence ? k : nearest;
    }
    const double mean = first / sum, variance = second / sum - mean * mean;
    found->sd = sqrt(fmax(variance, p->step * p->step / 12));
    /* what the profile's ends cut off would make it wider */
    const int32_t cut = p->at[lowest].evidence > most - CLOSE || p->at[highest].evidence > most - CLOSE;
    if (!follow(set, &p->at[nearest], NULL, 0, exp(mean - p->step * (nearest - REACH)), p->scratch, &found->model))
        found->model = p->at[nearest];
    found->is_known = steps >= FEWEST && found->sd <= KNOWN && !cut && set_along(set, p, found);
    asj_settle(context, set, search->seed, p->scratch, &found->model);
    found->model.evidence += log(sum * p->step / log(LONGEST / SHORTEST));
}

static asj_status find(asj_context *context, const asj_pairs *set, const asj_search *search, const asj_model *flat, int32_t count,
                       profile *p, asj_focal *found)
{
    asj_status status = ASJ_OK;
    asj_model *start = &p->at[REACH];
    double factor = FIRST;
    start->evidence = -HUGE_VAL;
    for (int32_t k = 0; k < COARSE && status == ASJ_OK; k++, factor *= TIMES)
        status = search_at(context, set, search, factor, flat, count, p, start);
    if (status == ASJ_OK && start->evidence > -HUGE_VAL)
        judge(context, set, search, p, found);
    return status;
}

asj_status asj_find_focal(asj_context *context, const asj_pairs *set, const asj_search *search, const asj_model *flat,
                          int32_t count, asj_focal *found)
{
    asj_memory *memory = &context->memory;
    profile *p = asj_allocate_zero(memory, 1, sizeof *p);
    asj_status status = ASJ_OK;
    memset(found, 0, sizeof *found);
    found->model.evidence = -HUGE_VAL;
    if (p)
        p->scratch = asj_adjust_scratches_create(memory, set, context->threads);
    const int32_t good = p && p->scratch;
    if (!good)
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the focal length");
    if (status == ASJ_OK)
        status = find(context, set, search, flat, count, p, found);
    if (p)
        asj_adjust_scratches_free(memory, p->scratch, context->threads);
    asj_release(memory, p);
    return status;
}
