/* SPDX-License-Identifier: BSD-2-Clause */
/* May this be chance? A number of false alarms without a count of tests.
 *
 * Background: the candidates are wrong, and those of different spots of the images independent of each other. For one geometry
 * fixed beforehand, L = exp(score) (score.c) then has mean 1. So has its mean over any distribution of geometries q that is
 * fixed beforehand (Fubini), and Markov's inequality bounds the chance of a large one:
 *
 *     evidence = integral of exp(score(g)) q(g) dg,     P(evidence >= 1 / epsilon) <= epsilon,     NFA = 1 / evidence,
 *
 * the expected number of image pairs as good as this one among those with nothing in common. The integral takes the place of the
 * number of tests times the tail in the a-contrario method (Desolneux, Moisan and Morel; Moisan and Stival 2004 for point matches,
 * with a count of samples): looking at more geometries does not make it any larger. It is taken about its peak (Laplace's method,
 * with the information matrix of adjust.c), q being flat over rotations (volume 8 pi^2), directions (4 pi) and, where the camera is
 * not known, what else there is (rotations that the images' own directions make likely have more than their share: manhattan.c, the
 * density over the flat one being multiplied in):
 *
 *     log evidence = score + sum over the parameters of log(sqrt(2 pi) / width) - 1/2 log det(information + 2 pi / width^2).
 *
 * Candidates of one spot are not independent: what looks like another thing looks like it all over (the four corners of a door
 * panel), and near candidates share the pixels that they were aligned on. So contributions to the score are counted in falling
 * order, each divided by one plus how many larger ones lie near it in either image: sum of
 *
 *     (1 - d^2 / (2 (POWER + 1) SHARED^2))^POWER,    d the smaller of both distances,
 *
 * which is exp(-d^2 / 2 SHARED^2) for all that it matters, has the same integral over the plane, and needs no exponential.
 * Without that, letters that were matched with other letters reach an evidence of exp(50); with half this SHARED,
 * one in ten pairs of unrelated rendered rooms reaches 10^7, which should happen once in 10^7 pairs.
 *
 * posterior.c draws motions around one, and for these the divisors stay what they are there: counted anew, of near candidates the
 * one that happens to suit a motion best counts most, every motion finds some that suit it, and the score has peaks everywhere. */
#include "evidence.h"
#include "core/angle.h"
#include "elementary.h"
#include "manhattan.h"
#include "near.h"
#include "ratios.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define SHARED 30.0 /* px */
#define POWER 128 /* add_nearness() has its squarings, */
#define LEAST_BASE 0.8F /* below which it leaves nothing, 4e-13, or numbers so small that processors take long */
#define LEAST_SHARE 0.01 /* nats: less is left out */

/* Widths of the parameters' priors. */
static double width_of(const asj_model *m, int32_t parameter)
{
    if (m->kind == ASJ_GEOMETRY_ESSENTIAL)
        return parameter < 3 ? 4.29 : parameter < 5 ? 3.54 : 3; /* (8 pi^2)^(1/3), sqrt(4 pi), base over distance of a plane */
    if (m->kind == ASJ_GEOMETRY_FUNDAMENTAL)
        return parameter < 6 ? 4.29 : 3;
    return asj_model_only_turns(m) ? 4.29 : 3; /* entries of a normalised homography */
}

double asj_prior_information(const asj_model *model, int32_t parameter)
{
    const double width = width_of(model, parameter);
    return 2 * ASJ_PI / (width * width);
}

double asj_log_volume(const asj_model *model, int32_t parameter)
{
    return 0.5 * log(2 * ASJ_PI) - log(width_of(model, parameter));
}

double asj_log_form(const asj_model *model)
{
    return asj_model_only_turns(model) ? log(0.5) : 0;
}

/* The larger share first, then the candidate that was given first. */
static int32_t is_before(const asj_share *p, const asj_share *q)
{
    return p->value > q->value || (p->value == q->value && p->pair->source < q->pair->source);
}

/* Shell's sort with the gaps of Ciura (2001): there are a hundred or two, and asj_sort() would call a function to compare. */
static void sort_shares(asj_share *shares, int32_t count)
{
    static const int32_t gaps[] = {1750, 701, 301, 132, 57, 23, 10, 4, 1};
    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; g++)
        for (int32_t n = gaps[g]; n < count; n++) {
            const asj_share one = shares[n];
            int32_t k = n;
            for (; k >= gaps[g] && is_before(&one, &shares[k - gaps[g]]); k -= gaps[g])
                shares[k] = shares[k - gaps[g]];
            shares[k] = one;
        }
}

/* Adds to near[k] how near (x1[k], y1[k], x2[k], y2[k]) is to the first of them, k = 1 .. count - 1. Without a branch, so that
 * compilers make vectors of it. */
static void add_nearness(const float *x1, const float *y1, const float *x2, const float *y2, int32_t count, float *near)
{
    const float a1 = x1[0], b1 = y1[0], a2 = x2[0], b2 = y2[0], factor = (float)(0.5 / ((POWER + 1) * SHARED * SHARED));
    for (int32_t k = 1; k < count; k++) {
        const float dx1 = x1[k] - a1, dy1 = y1[k] - b1, dx2 = x2[k] - a2, dy2 = y2[k] - b2;
        const float in1 = dx1 * dx1 + dy1 * dy1, in2 = dx2 * dx2 + dy2 * dy2, base = 1 - factor * (in1 < in2 ? in1 : in2);
        const float w = base > LEAST_BASE ? base : 0, w2 = w * w, w4 = w2 * w2, w8 = w4 * w4, w16 = w8 * w8, w32 = w16 * w16;
        const float w64 = w32 * w32;
        near[k] += w64 * w64;
    }
}

/* Of each of the shares, which fall, how near the larger ones are, as a sum. */
static const float *find_nearness(const asj_share *shares, int32_t count, asj_adjust_scratch *scratch)
{
    float *const x1 = scratch->spots, *const y1 = x1 + count, *const x2 = y1 + count, *const y2 = x2 + count;
    float *const near = y2 + count;
    for (int32_t k = 0; k < count; k++) {
        const asj_pair *c = shares[k].pair;
        x1[k] = (float)c->x1;
        y1[k] = (float)c->y1;
        x2[k] = (float)c->x2;
        y2[k] = (float)c->y2;
        near[k] = 0;
    }
    for (int32_t k = 0; k < count; k++)
        add_nearness(x1 + k, y1 + k, x2 + k, y2 + k, count - k, near + k);
    return near;
}

static double count_apart(const asj_share *shares, int32_t count, asj_adjust_scratch *scratch)
{
    const float *near = find_nearness(shares, count, scratch);
    double total = 0;
    for (int32_t k = 0; k < count; k++)
        total += shares[k].value / (1 + (double)near[k]);
    return total;
}

static uint32_t place_of(const asj_pair *c, int32_t side)
{
    return side == 0 ? c->place1 : c->place2;
}

/* Adds up what candidates say of the places of one image, in scratch->score.sum, and returns how many places that are, which
 * scratch->score.touched names. Their best candidates: scratch->shares. */
static int32_t add_up(const asj_pairs *set, int32_t side, const uint32_t *near, int32_t near_count, const double *ratio,
                      asj_adjust_scratch *scratch)
{
    double *sum = scratch->score.sum[side];
    uint32_t *touched = scratch->score.touched[side];
    int32_t places = 0;
    for (int32_t n = 0; n < near_count; n++) {
        const asj_pair *c = &set->list[near[n]];
        const uint32_t place = place_of(c, side);
        const double value = c->prior * ratio[n];
        if (!(value > 0))
            continue;
        if (sum[place] == 0) {
            touched[places++] = place;
            scratch->best[place] = 0;
        }
        sum[place] += value;
        if (value > scratch->best[place]) {
            scratch->best[place] = value;
            scratch->shares[place].pair = c;
        }
    }
    return places;
}

/* What the place has to say with so much from its candidates. */
static double share_of(const asj_pairs *set, int32_t side, uint32_t place, double sum)
{
    const double rest = 1 - set->prior[side][place];
    return asj_log_normal((rest + sum) / rest);
}

/* The shares of one image's places in scratch->sorted, falling; returns how many. ratio: of each of the `near` candidates. */
static int32_t find_shares(const asj_pairs *set, int32_t side, const uint32_t *near, int32_t near_count, const double *ratio,
                           asj_adjust_scratch *scratch)
{
    double *sum = scratch->score.sum[side];
    const uint32_t *touched = scratch->score.touched[side];
    const int32_t places = add_up(set, side, near, near_count, ratio, scratch);
    int32_t count = 0;
    for (int32_t n = 0; n < places; n++) {
        const uint32_t p = touched[n];
        const double value = share_of(set, side, p, sum[p]);
        if (value > LEAST_SHARE)
            scratch->sorted[count++] = (asj_share){value, scratch->shares[p].pair};
        sum[p] = 0;
    }
    sort_shares(scratch->sorted, count);
    return count;
}

/* Likelihood ratios of the candidates that are near enough the view, in scratch->probability, and which they are, in
 * scratch->score.near; returns how many. */
static int32_t find_ratios(const asj_pairs *set, const asj_two_view *view, asj_adjust_scratch *scratch)
{
    const asj_peaks peaks = asj_likelihood_peaks(set, view, 1);
    const int32_t near = asj_near(set, set->count, view, asj_far_limit(set, view, 1), scratch->score.near);
    asj_likelihood_ratios(view, set, scratch->score.near, near, &peaks, scratch->probability);
    return near;
}

double asj_score_apart(const asj_pairs *set, const asj_two_view *view, asj_adjust_scratch *scratch)
{
    const int32_t near = find_ratios(set, view, scratch);
    double of_side[2];
    for (int32_t side = 0; side < 2; side++) {
        const int32_t count = find_shares(set, side, scratch->score.near, near, scratch->probability, scratch);
        of_side[side] = set->empty[side] + count_apart(scratch->sorted, count, scratch);
    }
    return of_side[0] < of_side[1] ? of_side[0] : of_side[1];
}

void asj_weigh_places(const asj_pairs *set, const asj_two_view *view, asj_adjust_scratch *scratch)
{
    const int32_t near = find_ratios(set, view, scratch);
    for (int32_t side = 0; side < 2; side++) {
        double *weights = scratch->weights[side];
        int32_t count = find_shares(set, side, scratch->score.near, near, scratch->probability, scratch);
        memset(weights, 0, (size_t)set->place_count[side] * sizeof *weights);
        for (int32_t k = 0; k < count; k++)
            weights[place_of(scratch->sorted[k].pair, side)] = 1;
        for (int32_t k = 0; k < set->count; k++) { /* the others have nothing to say yet, and come after */
            const asj_pair *c = &set->list[k];
            if (weights[place_of(c, side)] == 0)
                scratch->sorted[count++] = (asj_share){0, c};
            weights[place_of(c, side)] = 1;
        }
        const float *nearness = find_nearness(scratch->sorted, count, scratch);
        for (int32_t k = 0; k < count; k++)
            weights[place_of(scratch->sorted[k].pair, side)] = 1 / (1 + (double)nearness[k]);
    }
}

double asj_score_weighed(const asj_pairs *set, const asj_two_view *view, double *const weights[2], asj_adjust_scratch *scratch)
{
    const int32_t near = find_ratios(set, view, scratch);
    double of_side[2];
    for (int32_t side = 0; side < 2; side++) {
        double *sum = scratch->score.sum[side];
        const uint32_t *touched = scratch->score.touched[side];
        const int32_t places = add_up(set, side, scratch->score.near, near, scratch->probability, scratch);
        of_side[side] = set->empty[side];
        for (int32_t n = 0; n < places; n++) {
            of_side[side] += weights[side][touched[n]] * share_of(set, side, touched[n], sum[touched[n]]);
            sum[touched[n]] = 0;
        }
    }
    return of_side[0] < of_side[1] ? of_side[0] : of_side[1];
}

double asj_log_evidence(const asj_pairs *set, const asj_model *model, asj_adjust_scratch *scratch)
{
    double information[ASJ_MODEL_PARAMETERS * ASJ_MODEL_PARAMETERS], none[ASJ_MODEL_PARAMETERS] = {0}, log_determinant;
    double volume = asj_log_form(model);
    const int32_t n = model->parameters;
    asj_probabilities(set, &model->view, 1, &scratch->score, scratch->probability);
    asj_information(set, model, scratch->probability, information);
    for (int32_t p = 0; p < n; p++) {
        information[p * (n + 1)] += asj_prior_information(model, p);
        volume += asj_log_volume(model, p);
    }
    if (asj_model_has_rotation(model))
        volume += asj_rotation_prior(set, model->rotation);
    if (!asj_cholesky_solve(information, n, none, &log_determinant))
        return -HUGE_VAL;
    return asj_score_apart(set, &model->view, scratch) + volume - 0.5 * log_determinant;
}
