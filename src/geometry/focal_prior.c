/* SPDX-License-Identifier: BSD-2-Clause */
/* The directions of a room are at right angles (directions.c), and with a wrong focal length they are not: edges that run towards
 * two vanishing points v and w of it give f by (v - c)'(w - c) + f^2 = 0 (Caprile and Torre 1990). No single pair of points is sure
 * enough; but how well the best three directions explain all edges, score(f), is a log likelihood ratio, and its peak stands at the
 * right focal length (of 58 pairs of rendered rooms within 3 % in 48, of seven pairs of video frames within 6 % in four).
 *
 * Edges are not independent (both sides of a board; what is not quite at right angles), so their scores count by ASJ_SCORE_COOL.
 * Then none of those peaks is out by more than two standard deviations, of rooms or frames, but one of the latter; with 1 five are
 * (tests/accuracy/tried/geometry.md, "What edges say of the focal length"). With it, over a flat density of log f, the edges' own
 * one is
 *
 *     s(f) = exp((score1(f) + score2(f)) / ASJ_SCORE_COOL) / mean over f of the same.
 *
 * A picture may show no room, or something at other angles; or both show directions, but not the same ones. So the prior is a
 * mixture: a quarter of it flat in f and in rotations, a quarter flat in rotations only, and a half with all that directions
 * say. With q(R | f) the density of rotations that the directions found at f allow (manhattan.c), all densities over flat ones:
 *
 *     p(f, R) = 1/4 + s/4 + s q / 2 = (1/2 + s/2) (1/2 + 1/2 (s / (1/2 + s/2)) q).
 *
 * The first factor is asj_log_focal_prior(); the second is the prior of rotations as with known cameras, but for
 * s / (1/2 + s/2), asj_log_focal_share(). So at focal lengths where the edges do not look right their directions count for
 * nothing: taken as they are, three directions explain some edges at any f, and draw motions to where these are.
 *
 * Of focal lengths that are about known the factor is log normal around 1, with the density g over the flat one. Then s is divided
 * by its mean under g, and p is multiplied by g. */
#include "focal_prior.h"
#include "core/angle.h"
#include "core/threads.h"
#include "stop.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAME 1e-6 /* of a step */
#define SURE 1.5 /* nats by which a peak tells f: rooms have 2.3 to 3.8, a facade with peaks at two wrong ones .1 to .8 */
#define SHORTEST 0.4 /* where nothing is known, */
#define STEP 0.05    /* .. and so up to 3.99 */
#define WIDTHS 4     /* standard deviations to either side, where something is, */
#define PER_WIDTH 2  /* .. in so many steps each at least */

typedef struct job {
    const asj_pairs *set;
    asj_focal_prior *prior;
    asj_directions_scratch **scratch; /* of each thread */
} job;

double asj_focal_factor(const asj_focal_prior *prior, int32_t n)
{
    return prior->shortest * exp(n * prior->step);
}

double asj_focal_range(const asj_focal_prior *prior)
{
    return (prior->count - 1) * prior->step;
}

void asj_focal_cameras(const asj_focal_prior *prior, double factor, asj_camera cameras[2])
{
    for (int32_t v = 0; v < 2; v++) {
        cameras[v] = prior->cameras[v];
        cameras[v].fx *= factor;
        cameras[v].fy *= factor;
    }
}

static void find_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end && !asj_pairs_stop(j->set, part); n++) {
        const int32_t v = (int32_t)(n % 2), k = (int32_t)(n / 2);
        asj_camera cameras[2];
        asj_focal_cameras(j->prior, asj_focal_factor(j->prior, k), cameras);
        asj_find_directions_with(j->scratch[part->thread], &j->prior->edges[v], &cameras[v], 0, &j->prior->directions[v][k]);
    }
}

/* Directions at all factors. */
static asj_status find_all(asj_context *context, const asj_pairs *set, asj_focal_prior *prior)
{
    asj_memory *memory = &context->memory;
    const size_t threads = (size_t)context->threads;
    const size_t most = prior->edges[0].count > prior->edges[1].count ? prior->edges[0].count : prior->edges[1].count;
    const job j = {set, prior, asj_allocate_zero(memory, threads, sizeof *j.scratch)};
    int32_t good = j.scratch != NULL;
    for (size_t t = 0; t < threads && good; t++)
        good = (j.scratch[t] = asj_directions_scratch_create(memory, most)) != NULL;
    if (good)
        asj_parallel(context, context->threads, 2 * prior->count, 2, find_some, &j);
    for (size_t t = 0; t < threads && j.scratch; t++)
        asj_directions_scratch_free(memory, j.scratch[t]);
    asj_release(memory, j.scratch);
    return good ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the directions of %zu edges", most);
}

static double score_of(const asj_directions_list *of)
{
    return of->count > 0 ? of->list[0].score / ASJ_SCORE_COOL : 0;
}

/* Log of the density of a factor without edges, over the flat one. */
static double log_given(const asj_focal_prior *prior, double factor)
{
    if (prior->sd == 0)
        return 0;
    const double off = log(factor) / prior->sd;
    return log(asj_focal_range(prior) / (prior->sd * sqrt(2 * ASJ_PI))) - 0.5 * off * off;
}

static void set_factors(double sd, asj_focal_prior *prior)
{
    prior->sd = sd;
    prior->shortest = SHORTEST;
    prior->step = STEP;
    prior->count = ASJ_FOCAL_MOST;
    if (sd == 0)
        return;
    prior->step = fmin(STEP, sd / PER_WIDTH);
    const int32_t steps = (int32_t)ceil(WIDTHS * sd / prior->step);
    prior->shortest = exp(-steps * prior->step);
    prior->count = 2 * steps + 1 < ASJ_FOCAL_MOST ? 2 * steps + 1 : ASJ_FOCAL_MOST;
}

asj_status asj_focal_prior_make(asj_context *context, const asj_pairs *set, const asj_edge_list *edges, const asj_camera cameras[2],
                                double sd, asj_focal_prior *prior)
{
    double most = 0, sum = 0, weights = 0;
    memset(prior, 0, sizeof *prior);
    memcpy(prior->cameras, cameras, sizeof prior->cameras);
    set_factors(sd, prior);
    prior->edges = edges;
    const asj_status status = edges ? find_all(context, set, prior) : ASJ_OK;
    for (int32_t k = 0; k < prior->count; k++) {
        prior->log_edges[k] = score_of(&prior->directions[0][k]) + score_of(&prior->directions[1][k]);
        most = fmax(most, prior->log_edges[k]);
    }
    for (int32_t k = 0; k < prior->count; k++) {
        const double weight = exp(log_given(prior, asj_focal_factor(prior, k)));
        weights += weight;
        sum += weight * exp(prior->log_edges[k] - most);
    }
    for (int32_t k = 0; k < prior->count; k++)
        prior->log_edges[k] -= most + log(sum / weights);
    return status;
}

int32_t asj_likeliest_focal(const asj_focal_prior *prior)
{
    int32_t best = -1;
    double most = 0; /* flat */
    for (int32_t k = 0; k < prior->count; k++) {
        const double log_density = prior->log_edges[k] + log_given(prior, asj_focal_factor(prior, k));
        if (log_density > most) {
            best = k;
            most = log_density;
        }
    }
    return best;
}

int32_t asj_focal_has_edges(const asj_focal_prior *prior, double factor)
{
    const int32_t likeliest = asj_likeliest_focal(prior);
    if (likeliest < 0 || !(fabs(log(factor / asj_focal_factor(prior, likeliest))) < ASJ_SAME_FOCAL))
        return 0;
    for (int32_t k = 0; k < prior->count; k++)
        if (abs(k - likeliest) * prior->step > 2 * ASJ_SAME_FOCAL && prior->log_edges[k] > prior->log_edges[likeliest] - SURE)
            return 0;
    return 1;
}

/* Where a factor stands among those of the prior. */
static double place_of(const asj_focal_prior *prior, double factor)
{
    return log(factor / prior->shortest) / prior->step;
}

/* log s at any factor. */
static double log_edges_at(const asj_focal_prior *prior, double factor)
{
    const double at = fmin(fmax(place_of(prior, factor), 0), prior->count - 1);
    const int32_t k = at < prior->count - 2 ? (int32_t)at : prior->count - 2;
    return prior->log_edges[k] + (at - k) * (prior->log_edges[k + 1] - prior->log_edges[k]);
}

static double log_by_edges(const asj_focal_prior *prior, double factor)
{
    return log(0.5 + 0.5 * exp(log_edges_at(prior, factor)));
}

double asj_log_focal_prior(const asj_focal_prior *prior, double factor)
{
    return log_by_edges(prior, factor) + log_given(prior, factor);
}

void asj_focal_prior_moments(const asj_focal_prior *prior, double *mean, double *variance)
{
    double sum = 0, first = 0, second = 0;
    for (int32_t k = 0; k < prior->count; k++) {
        const double factor = asj_focal_factor(prior, k), x = log(factor), weight = exp(asj_log_focal_prior(prior, factor));
        sum += weight;
        first += weight * x;
        second += weight * x * x;
    }
    *mean = first / sum;
    *variance = second / sum - *mean * *mean;
}

double asj_log_focal_share(const asj_focal_prior *prior, double factor)
{
    return log_edges_at(prior, factor) - log_by_edges(prior, factor);
}

asj_status asj_focal_directions(asj_context *context, const asj_focal_prior *prior, double factor,
                                asj_directions_list directions[2])
{
    const double at = place_of(prior, factor);
    const int32_t nearest = (int32_t)lround(at);
    asj_camera cameras[2];
    asj_focal_cameras(prior, factor, cameras);
    for (int32_t v = 0; v < 2; v++)
        if (nearest >= 0 && nearest < prior->count && fabs(at - nearest) < SAME)
            directions[v] = prior->directions[v][nearest];
        else if (!asj_find_directions(&context->memory, &prior->edges[v], &cameras[v], 0, &directions[v]))
            return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the directions of %zu edges", prior->edges[v].count);
    return ASJ_OK;
}
