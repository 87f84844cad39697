/* SPDX-License-Identifier: BSD-2-Clause */
/* What the candidates allow, as a whole. Around a motion the score is rugged: each candidate that comes or goes makes a peak of its
 * own, a degree or two apart, and which of them a search climbs is luck. Their integral and their mean are not. They are taken by
 * adaptive importance sampling: motions are drawn in rounds from normal distributions around the last mean (population Monte Carlo;
 * Cappe, Guillin, Marin and Robert 2004), and all draws of all rounds count, each weighed by its target over the mean of the
 * densities of all rounds (Cornuet, Marin, Mira and Robert 2012). Draws of one round alone, of which a dozen weigh anything, spread
 * less in five dimensions than the candidates allow.
 *
 * The mean of exp(score) over that density, with the flat density of motions as the prior, is the evidence (evidence.c), now of the
 * whole region. Mean and covariance of the pose are those of exp(ASJ_TEMPER score): candidates of one wall, one border or one kind
 * of corner err together, and a product of likelihoods that takes them for independent is too sharp. Raised to a power below 1 it
 * spreads as widely as poses err (composite likelihoods: Pauli, Racugno and Ventura 2011; Ribatet, Cooley and Davison 2012).
 * ASJ_TEMPER is from rendered rooms (tests/accuracy/wide_rooms --poses: errors over what is told). The prior of rotations is not:
 * its edges are no candidates, and manhattan.c counts what they have in common itself.
 *
 * Drawn are the five parameters of the motion (model.c), or the three of a camera that only turns. Planes follow as the equations
 * of adjust.c say, n' = -H_nn^-1 H_nm m', and are integrated over by Laplace's method. Standard deviations of a round: those of the
 * draws so far, times the SPREADS in turn, which the density has all of, so that what lies farther out is found and nothing weighs
 * without bound. Of a covariance of draws, few of which weigh anything at first, LEAST of Laplace's is a part: it is as long and
 * thin as what the candidates allow. Where fewer than ENOUGH weigh anything in the end, their spread is that of chance, and
 * Laplace's tells the rest. (Of 63 motions a tenth have fewer than 43, one has 1.5: it was told to .71 of Laplace's deviations
 * without ASJ_TEMPER, which asks for more than these.)
 * (Where cameras are near each other, turning and moving look alike, and the two together are known far better than either: with
 * one sd for all parameters in place of it hardly a draw weighs anything.) */
#include "posterior.h"
#include "core/angle.h"
#include "core/threads.h"
#include "counter_random.h"
#include "evidence.h"
#include "manhattan.h"
#include "peak.h"
#include "small_matrix.h"
#include "stop.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define DRAWS 120
#define ENOUGH 50.0 /* draws that weigh anything: of fewer the spread is no better known than by Laplace's method */
#define ROUNDS 3
#define ALL (ROUNDS * DRAWS)
#define SPREADS 3
#define MOTION 5 /* parameters at most */
#define LEAST 0.3        /* of Laplace's covariance */
#define UNSEEN 1.28      /* variance over that of ALL draws: of six right candidates these spread .88 as far as 8000 do, of
                          * many .99 (test_posterior.c) */
#define MOST_SD 0.3      /* rad */

typedef char models_are_inverted[ASJ_MODEL_PARAMETERS <= ASJ_MOST_INVERTED ? 1 : -1];

static const double spreads[SPREADS] = {0.8, 1.2, 2};

/* Where motions are drawn from. */
typedef struct cloud {
    int32_t size;                 /* n: 5, or 3 where the camera only turns; matrices are n x n */
    double mean[MOTION];
    double root[MOTION * MOTION]; /* lower triangle L of the covariance L L' */
    double log_root;              /* log det L */
    double least[MOTION * MOTION]; /* part of the covariance, whatever the draws say */
    double follow[3 * ASJ_MOST_PLANES][MOTION];
} cloud;

typedef struct draw {
    double at[MOTION];
    double score; /* of the candidates */
    double prior; /* log of the density of rotations */
    double log_density;
} draw;

static void normal_numbers(uint64_t seed, uint64_t stream, uint64_t number, double out[MOTION + 1])
{
    for (uint64_t k = 0; k < MOTION + 1; k += 2) { /* Box and Muller */
        const double u = 1 - asj_counter_random(seed, stream, number * 8 + k);
        const double r = sqrt(-2 * log(u)), angle = 2 * ASJ_PI * asj_counter_random(seed, stream, number * 8 + k + 1);
        out[k] = r * cos(angle);
        out[k + 1] = r * sin(angle);
    }
}

/* Log of the density of the normal distributions of a round together, at x = mean + L y. */
static double log_density(const cloud *c, const double x[MOTION])
{
    const int32_t n = c->size;
    double y[MOTION], square = 0, sum = 0;
    for (int32_t i = 0; i < n; i++) {
        y[i] = x[i] - c->mean[i];
        for (int32_t k = 0; k < i; k++)
            y[i] -= c->root[i * n + k] * y[k];
        y[i] /= c->root[i * n + i];
        square += y[i] * y[i];
    }
    for (int32_t k = 0; k < SPREADS; k++) {
        const double s = spreads[k];
        double volume = s;
        for (int32_t i = 1; i < n; i++)
            volume *= s;
        sum += exp(-0.5 * square / (s * s)) / volume;
    }
    return sum > 0 ? log(sum / SPREADS) - 0.5 * n * log(2 * ASJ_PI) - c->log_root : -HUGE_VAL;
}

double asj_largest_sd(const double covariance[MOTION * MOTION], int32_t n)
{
    double values[MOTION], vectors[MOTION * MOTION];
    asj_symmetric_eigen(covariance, n, values, vectors);
    return sqrt(fmax(0, values[n - 1]));
}

/* Lower triangle of a covariance, to which its least part is added. */
static int32_t set_root(double covariance[MOTION * MOTION], cloud *c)
{
    double none[MOTION] = {0}, log_determinant;
    for (int32_t k = 0; k < c->size * c->size; k++) {
        covariance[k] += c->least[k];
        c->root[k] = covariance[k];
    }
    if (!asj_cholesky_solve(c->root, c->size, none, &log_determinant))
        return 0;
    c->log_root = 0.5 * log_determinant;
    return 1;
}

/* The cloud of Laplace's approximation at the model; *log_planes: what the planes add to the log of the evidence. */
static int32_t start(const asj_pairs *set, asj_model *model, asj_adjust_scratch *scratch, cloud *c, double *log_planes)
{
    double information[ASJ_MODEL_PARAMETERS * ASJ_MODEL_PARAMETERS], inverse[ASJ_MODEL_PARAMETERS * ASJ_MODEL_PARAMETERS];
    double of_planes[9 * ASJ_MOST_PLANES * ASJ_MOST_PLANES], inverse_planes[9 * ASJ_MOST_PLANES * ASJ_MOST_PLANES];
    double covariance[MOTION * MOTION] = {0}, log_determinant = 0;
    const int32_t n = model->parameters, motion = n < MOTION ? n : MOTION, more = n - motion;
    memset(c, 0, sizeof *c);
    c->size = motion;
    asj_probabilities(set, &model->view, 1, &scratch->score, scratch->probability);
    asj_information(set, model, scratch->probability, information);
    for (int32_t p = 0; p < n; p++)
        information[p * (n + 1)] += asj_prior_information(model, p);
    if (!asj_invert_positive(information, n, inverse, NULL))
        return 0;
    for (int32_t i = 0; i < motion; i++)
        for (int32_t k = 0; k < motion; k++)
            covariance[i * motion + k] = inverse[i * n + k];
    for (int32_t i = 0; i < more; i++)
        for (int32_t k = 0; k < more; k++)
            of_planes[i * more + k] = information[(motion + i) * n + motion + k];
    if (more > 0 && !asj_invert_positive(of_planes, more, inverse_planes, &log_determinant))
        return 0;
    for (int32_t i = 0; i < more; i++)
        for (int32_t k = 0; k < motion; k++)
            for (int32_t j = 0; j < more; j++)
                c->follow[i][k] -= inverse_planes[i * more + j] * information[(motion + j) * n + k];
    *log_planes = -0.5 * log_determinant;
    for (int32_t p = motion; p < n; p++)
        *log_planes += asj_log_volume(model, p);
    memcpy(model->covariance, covariance, sizeof covariance);
    const int32_t good = set_root(covariance, c);
    for (int32_t k = 0; k < motion * motion; k++)
        c->least[k] = LEAST * covariance[k];
    return good;
}

static int32_t move(const asj_model *model, const cloud *c, const double at[MOTION], asj_model *moved)
{
    double delta[ASJ_MODEL_PARAMETERS] = {0};
    memcpy(delta, at, (size_t)c->size * sizeof *at);
    for (int32_t p = c->size; p < model->parameters; p++)
        for (int32_t k = 0; k < c->size; k++)
            delta[p] += c->follow[p - c->size][k] * at[k];
    return asj_model_move(model, delta, moved);
}

/* What a loop over draws works on. */
typedef struct job {
    const asj_pairs *set;
    const asj_model *model;
    const cloud *cloud;
    uint64_t seed, stream;
    asj_adjust_scratch *scratch; /* for each thread */
    draw *draws;
} job;

static void draw_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const cloud *c = j->cloud;
    for (int64_t n = part->first; n < part->end; n++) {
        draw *d = &j->draws[n];
        double y[MOTION + 1];
        asj_model moved;
        const double scale = n == 0 ? 0 : spreads[n % SPREADS];
        normal_numbers(j->seed, j->stream, (uint64_t)n, y);
        for (int32_t i = 0; i < c->size; i++) {
            d->at[i] = c->mean[i];
            for (int32_t k = 0; k <= i; k++)
                d->at[i] += scale * c->root[i * c->size + k] * y[k];
        }
        d->score = -HUGE_VAL;
        d->prior = 0;
        if (!asj_pairs_stop(j->set, part) && move(j->model, c, d->at, &moved)) {
            d->score = asj_score_weighed(j->set, &moved.view, j->scratch[0].weights, &j->scratch[part->thread]);
            d->prior = asj_rotation_prior(j->set, moved.rotation);
        }
    }
}

/* The log density of each draw: the mean of those of the rounds so far. */
static void set_densities(const cloud *clouds, int32_t rounds, draw *draws, int32_t count)
{
    for (int32_t n = 0; n < count; n++) {
        double each[ROUNDS], largest = -HUGE_VAL, sum = 0;
        for (int32_t r = 0; r < rounds; r++) {
            each[r] = log_density(&clouds[r], draws[n].at);
            largest = fmax(largest, each[r]);
        }
        for (int32_t r = 0; r < rounds && largest > -HUGE_VAL; r++)
            sum += exp(each[r] - largest);
        draws[n].log_density = sum > 0 ? largest + log(sum / rounds) : HUGE_VAL; /* HUGE_VAL: too far away to count */
    }
}

/* Weights exp(temper score) x prior over density of the draws, the largest 1; *sum of them. Returns the log of the factor that
 * has been taken out, -HUGE_VAL when there are none. */
static double weigh(const draw *draws, int32_t count, double temper, double *weights, double *sum)
{
    double largest = -HUGE_VAL;
    *sum = 0;
    for (int32_t n = 0; n < count; n++)
        largest = fmax(largest, temper * draws[n].score + draws[n].prior - draws[n].log_density);
    for (int32_t n = 0; n < count && largest > -HUGE_VAL; n++) {
        weights[n] = exp(temper * draws[n].score + draws[n].prior - draws[n].log_density - largest);
        *sum += weights[n];
    }
    return largest;
}

/* Mean and covariance of the draws of `size` parameters; 0 when they weigh nothing. */
static int32_t summarise(const draw *draws, int32_t count, int32_t size, double mean[MOTION], double covariance[MOTION * MOTION])
{
    double weights[ALL], sum;
    memset(mean, 0, MOTION * sizeof *mean);
    memset(covariance, 0, MOTION * MOTION * sizeof *covariance);
    if (!(weigh(draws, count, ASJ_TEMPER, weights, &sum) > -HUGE_VAL))
        return 0;
    for (int32_t n = 0; n < count; n++)
        for (int32_t k = 0; k < size; k++)
            mean[k] += weights[n] / sum * draws[n].at[k];
    for (int32_t n = 0; n < count; n++)
        for (int32_t i = 0; i < size; i++)
            for (int32_t k = 0; k < size; k++)
                covariance[i * size + k] += weights[n] / sum * (draws[n].at[i] - mean[i]) * (draws[n].at[k] - mean[k]);
    return 1;
}

/* How many draws weigh anything: (sum of the weights)^2 over the sum of their squares (Kish 1965). */
static double effective(const draw *draws, int32_t count)
{
    double weights[ALL], sum, squares = 0;
    if (!(weigh(draws, count, ASJ_TEMPER, weights, &sum) > -HUGE_VAL))
        return 0;
    for (int32_t n = 0; n < count; n++)
        squares += weights[n] * weights[n];
    return sum * sum / squares;
}

/* The log of the integral of exp(score). */
static double log_integral(const draw *draws, int32_t count)
{
    double weights[ALL], sum;
    const double factor = weigh(draws, count, 1, weights, &sum);
    return factor > -HUGE_VAL ? factor + log(sum / count) : -HUGE_VAL;
}

/* Draws all rounds; *last: mean and root of all of them. 0 when there is nothing to draw. */
static int32_t draw_rounds(asj_context *context, job *j, cloud *last, double covariance[MOTION * MOTION])
{
    cloud clouds[ROUNDS];
    for (int32_t round = 0; round < ROUNDS; round++) {
        const int32_t count = (round + 1) * DRAWS;
        clouds[round] = *last;
        const job of_round = {j->set, j->model, &clouds[round], j->seed, (uint64_t)round, j->scratch, j->draws + round * DRAWS};
        asj_parallel(context, context->threads, DRAWS, 8, draw_some, &of_round);
        set_densities(clouds, round + 1, j->draws, count);
        if (!summarise(j->draws, count, last->size, last->mean, covariance) || !set_root(covariance, last))
            return 0;
    }
    return 1;
}

/* The cloud of Laplace's approximation as wide as ASJ_TEMPER makes it. */
static void widen(cloud *c)
{
    for (int32_t k = 0; k < c->size * c->size; k++)
        c->root[k] /= sqrt(ASJ_TEMPER);
    c->log_root -= 0.5 * c->size * log(ASJ_TEMPER);
}

void asj_settle(asj_context *context, const asj_pairs *set, uint64_t seed, asj_adjust_scratch *scratch, asj_model *model)
{
    draw draws[ALL];
    cloud c;
    asj_model moved;
    double log_planes, covariance[MOTION * MOTION];
    if (!asj_model_has_rotation(model))
        return;
    asj_climb(set, model, &scratch[0]);
    model->evidence = asj_log_evidence(set, model, &scratch[0]);
    if (!start(set, model, &scratch[0], &c, &log_planes))
        return;
    if (asj_largest_sd(model->covariance, c.size) > MOST_SD) { /* a direction that nothing determines has no middle */
        model->peak = model->evidence;
        model->settled = 1;
        return;
    }
    widen(&c);
    asj_weigh_places(set, &model->view, &scratch[0]);
    job j = {set, model, NULL, seed, 0, scratch, draws};
    if (!draw_rounds(context, &j, &c, covariance) || !move(model, &c, c.mean, &moved))
        return;
    const double log_mean = log_integral(draws, ALL);
    double volume = log_planes + asj_log_form(model);
    for (int32_t p = 0; p < c.size; p++)
        volume += asj_log_volume(model, p) - 0.5 * log(2 * ASJ_PI);
    moved.peak = model->evidence;
    moved.evidence = log_mean + volume;
    memcpy(moved.covariance, covariance, sizeof covariance);
    const double unknown = fmax(0, 1 - effective(draws, ALL) / ENOUGH);
    for (int32_t k = 0; k < MOTION * MOTION; k++)
        moved.covariance[k] = UNSEEN * moved.covariance[k] + unknown / ASJ_TEMPER * model->covariance[k];
    moved.settled = 1;
    *model = moved;
}
