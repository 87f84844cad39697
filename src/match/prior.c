/* SPDX-License-Identifier: BSD-2-Clause */
/* What the looks of a candidate and its support say of it, as a probability.
 *
 * Two logistic models, the mean of which is taken: where neighbours support a candidate that says most, where corners are few or
 * seen from far apart they cannot. With d the distance of the patches, best(d) the smallest one at the same location of an image,
 * s the correlation of the aligned discs and S the support,
 *
 *     z1 = 1.35 (log best1(d)/d + log best2(d)/d) + 0.36 s + 1.06 log(S + 0.05) - 2.27
 *     z2 = 3.66 (log best1(d)/d + log best2(d)/d) + 2.37 s - 0.49 log d - 4.03,
 *
 * fitted (maximum likelihood) to the candidates of 54 rendered wide pairs and seven pairs of photographs that are none of the wide
 * ones, both images alike. How many candidates are right in all depends on the pair and is not known: each model's constant is
 * moved until its probabilities sum to EXPECTED, those of one location in either image to MOST at most.
 *
 * Where both images have colours, these have a say (colour_prior.c): to each z comes its weight times how well they agree. The
 * weights lie between what 98 rendered rooms ask for (2.1 and 2.3: every surface has one colour) and what photographs do (0 to 0.5:
 * video frames, grey walls; 1.3 to 2.8: good ones with coloured things). */
#include "prior.h"
#include "colour_prior.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define EXPECTED 15.0
#define MOST 0.9
#define STEPS 40   /* of bisection, on [-15, 15] */
#define DOUBT 1e-9 /* a sum of a million numbers in a double is out by a tenth of that at most */
#define COLOUR_1 0.6
#define COLOUR_2 1.2

static float *best_distances(const asj_match_run *run, int32_t side)
{
    const uint32_t *location = run->image[side]->l_junctions.location, count = run->image[side]->l_junctions.location_count;
    float *best = asj_allocate(&run->context->memory, count, sizeof *best);
    for (uint32_t p = 0; best && p < count; p++)
        best[p] = HUGE_VALF;
    for (size_t k = 0; best && k < run->candidates.count; k++) {
        const asj_candidate *c = &run->candidates.list[k];
        float *smallest = &best[location[asj_candidate_l(c, side)]];
        *smallest = c->distance2 < *smallest ? c->distance2 : *smallest;
    }
    return best;
}

/* One of the two models: logits and odds of each candidate, sums of each location. */
typedef struct prior_model {
    double *z, *odds, *sums[2];
} prior_model;

/* What a call works on. */
typedef struct priors {
    prior_model models[2];
    double *other;      /* what the second model makes of each candidate */
    uint32_t *place[2]; /* locations of the candidates, side by side */
    float *best[2];
    asj_watch watch;
} priors;

/* Sums of the probabilities by location. Neighbours are mostly of one location of the first image. */
static void add_up(const uint32_t *place, const double *probability, size_t count, double *sums)
{
    uint32_t at = place[0];
    double sum = 0;
    for (size_t k = 0; k < count; k++) {
        if (place[k] != at) {
            sums[at] = sum;
            at = place[k];
            sum = sums[at];
        }
        sum += probability[k];
    }
    sums[at] = sum;
}

/* The probabilities of the candidates, limited by location; their sum. */
static double limit(const asj_match_run *run, const priors *p, const prior_model *m, double *probability)
{
    const size_t count = run->candidates.count;
    double total = 0;
    for (int32_t side = 0; side < 2; side++) {
        const uint32_t *place = p->place[side];
        double *sums = m->sums[side];
        memset(sums, 0, run->image[side]->l_junctions.location_count * sizeof *sums);
        add_up(place, probability, count, sums);
        for (size_t k = 0; k < count; k++)
            if (sums[place[k]] > MOST)
                probability[k] *= MOST / sums[place[k]];
    }
    for (size_t k = 0; k < count; k++)
        total += probability[k];
    return total;
}

/* Of the logits z + shift. */
static double shifted(const asj_match_run *run, const priors *p, const prior_model *m, double shift, double *probability)
{
    for (size_t k = 0; k < run->candidates.count; k++)
        probability[k] = 1 / (1 + exp(-(m->z[k] + shift)));
    return limit(run, p, m, probability);
}

/* The same but for rounding, from the odds exp(-z): one exponential instead of one for each candidate. */
static double nearly_shifted(const asj_match_run *run, const priors *p, const prior_model *m, double shift, double *probability)
{
    const double factor = exp(-shift);
    for (size_t k = 0; k < run->candidates.count; k++)
        probability[k] = 1 / (1 + m->odds[k] * factor);
    return limit(run, p, m, probability);
}

/* Where rounding could decide on which side of EXPECTED a sum is, it is computed as the last one will be. */
static void bring_to_sum(const asj_match_run *run, priors *p, const prior_model *m, const asj_part *part, double *probability)
{
    double low = -15, high = 15;
    for (size_t k = 0; k < run->candidates.count; k++)
        m->odds[k] = exp(-m->z[k]);
    for (int32_t step = 0; step < STEPS && !asj_watch_stops(&p->watch, part); step++) {
        const double middle = 0.5 * (low + high);
        double sum = nearly_shifted(run, p, m, middle, probability);
        if (!(fabs(sum - EXPECTED) > DOUBT * EXPECTED))
            sum = shifted(run, p, m, middle, probability);
        if (sum < EXPECTED)
            low = middle;
        else
            high = middle;
    }
    shifted(run, p, m, low, probability);
}

static void logits(const asj_match_run *run, const float *best1, const float *best2, double *z1, double *z2)
{
    for (size_t k = 0; k < run->candidates.count; k++) {
        const asj_candidate *c = &run->candidates.list[k];
        const double least = 1e-8, d2 = fmax((double)c->distance2, least), s = (double)c->similarity;
        const double in1 = fmax((double)best1[run->image[0]->l_junctions.location[c->i]], least);
        const double in2 = fmax((double)best2[run->image[1]->l_junctions.location[c->j]], least);
        const double ratios = 0.5 * (log(in1 / d2) + log(in2 / d2));
        z1[k] = 1.35 * ratios + 0.36 * s + 1.06 * log((double)c->support + 0.05) - 2.27;
        z2[k] = 3.66 * ratios + 2.37 * s - 0.49 * 0.5 * log(d2) - 4.03;
    }
}

typedef struct job {
    const asj_match_run *run;
    priors *p;
    double *prior;
} job;

static void bring_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++)
        bring_to_sum(j->run, j->p, &j->p->models[n], part, n == 0 ? j->prior : j->p->other);
}

/* Each model by a thread. */
static void mean_of_models(const asj_match_run *run, priors *p, double *prior)
{
    const job j = {run, p, prior};
    asj_parallel(run->context, run->context->threads, 2, 1, bring_some, &j);
    for (size_t k = 0; k < run->candidates.count; k++)
        prior[k] = 0.5 * (prior[k] + p->other[k]);
}

static asj_status set_priors(const asj_match_run *run, priors *p, double *prior, double *colours)
{
    for (int32_t side = 0; side < 2; side++)
        for (size_t k = 0; k < run->candidates.count; k++)
            p->place[side][k] = run->image[side]->l_junctions.location[asj_candidate_l(&run->candidates.list[k], side)];
    logits(run, p->best[0], p->best[1], p->models[0].z, p->models[1].z);
    asj_watch_start(&p->watch, run->context, ASJ_STAGE_ASSIGN);
    mean_of_models(run, p, prior);
    if (!run->image[0]->colours || !run->image[1]->colours || p->watch.stopped)
        return asj_watch_end(&p->watch);
    const asj_status status = asj_colour_agreement(run, prior, colours);
    for (size_t k = 0; k < run->candidates.count; k++) {
        p->models[0].z[k] += COLOUR_1 * colours[k];
        p->models[1].z[k] += COLOUR_2 * colours[k];
    }
    mean_of_models(run, p, prior);
    return status == ASJ_OK ? asj_watch_end(&p->watch) : status;
}

static int32_t create(const asj_match_run *run, priors *p)
{
    asj_memory *memory = &run->context->memory;
    const size_t count = run->candidates.count;
    p->other = asj_allocate(memory, count, sizeof *p->other);
    int32_t good = p->other != NULL;
    for (int32_t n = 0; n < 2; n++) {
        prior_model *m = &p->models[n];
        m->z = asj_allocate(memory, count, sizeof *m->z);
        m->odds = asj_allocate(memory, count, sizeof *m->odds);
        for (int32_t side = 0; side < 2; side++)
            m->sums[side] = asj_allocate(memory, run->image[side]->l_junctions.location_count, sizeof *m->sums[side]);
        p->best[n] = best_distances(run, n);
        p->place[n] = asj_allocate(memory, count, sizeof *p->place[n]);
        good = good && m->z && m->odds && m->sums[0] && m->sums[1] && p->best[n] && p->place[n];
    }
    return good;
}

static void release(asj_memory *memory, const priors *p)
{
    for (int32_t n = 0; n < 2; n++) {
        const prior_model *m = &p->models[n];
        asj_release(memory, m->z);
        asj_release(memory, m->odds);
        asj_release(memory, m->sums[0]);
        asj_release(memory, m->sums[1]);
        asj_release(memory, p->best[n]);
        asj_release(memory, p->place[n]);
    }
    asj_release(memory, p->other);
}

asj_status asj_candidate_priors(const asj_match_run *run, double *prior, double *colours)
{
    const size_t count = run->candidates.count;
    priors p;
    asj_status status = ASJ_OK;
    memset(&p, 0, sizeof p);
    memset(colours, 0, count * sizeof *colours);
    if (!create(run, &p))
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the priors of %zu candidates", count);
    else if (count > 0)
        status = set_priors(run, &p, prior, colours);
    release(&run->context->memory, &p);
    return status;
}
