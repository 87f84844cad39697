/* SPDX-License-Identifier: BSD-2-Clause */
/* Expectation and maximisation (Dempster, Laird and Rubin 1977): the probabilities of the candidates given the geometry, then the
 * geometry by one Gauss-Newton step over the weighted residuals; standard deviations shrink from WIDE times to 1, so that the first
 * steps look farther. A residual of square q weighs 1 / (1 + q / TAIL) (Cauchy's), since A and x are not normal far out. */
#include "adjust.h"
#include "manhattan.h"
#include "slopes.h"
#include "small_matrix.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define WIDE 3.0
#define LIKE_ROUNDS 2
#define TAIL 6.0
#define BEHIND 2.0
#define LEAST 1e-3 /* probability below which a candidate is left out */
#define DAMPING 1e-3 /* of the prior that parameters stay, in units of their information: keeps what nothing determines */

typedef struct equations {
    double normal[ASJ_MODEL_PARAMETERS * ASJ_MODEL_PARAMETERS];
    double right[ASJ_MODEL_PARAMETERS];
} equations;

/* Adds the products of derivatives; called with constant `rows`, so that loops over them are written out. */
static inline void add_products(double slope[ASJ_PART_PARAMETERS][6], const double *value, int32_t rows, double weight,
                                const int32_t *used, int32_t count, int32_t n, equations *e)
{
    for (int32_t i = 0; i < count; i++) {
        double *row = e->normal + (ptrdiff_t)used[i] * n, at_value = 0;
        for (int32_t k = 0; k <= i; k++) {
            double sum = 0;
            for (int32_t r = 0; r < rows; r++)
                sum += slope[i][r] * slope[k][r];
            row[used[k]] += weight * sum;
        }
        for (int32_t r = 0; r < rows; r++)
            at_value += slope[i][r] * value[r];
        e->right[used[i]] -= weight * at_value;
    }
}

/* Adds the residuals and derivatives of one candidate's part. fine: likelihood.c. */
static void add_part(const asj_pairs *set, const asj_pair *c, int32_t part, const asj_model *model, const asj_model_slopes *slopes,
                     int32_t fine, double weight, equations *e)
{
    asj_residuals at;
    double slope[ASJ_PART_PARAMETERS][6];
    const int32_t n = model->parameters, *used = slopes->parameter[part], count = slopes->count[part];
    const int32_t rows = asj_residual_slopes(&model->view, part, set, c, slopes, &at, slope);
    if (rows == 0)
        return;
    weight /= 1 + at.square / TAIL;
    if (fine)
        weight *= asj_size_weight(at.square, asj_part_is_planar(&model->view, part));
    if (rows == 3)
        add_products(slope, at.value, 3, weight, used, count, n, e);
    else
        add_products(slope, at.value, 6, weight, used, count, n, e);
}

/* Adds one candidate: each of its parts as far as it is probable. */
static void add_candidate(const asj_pairs *set, const asj_pair *c, const asj_model *model, const asj_model_slopes *slopes,
                          const asj_peaks *peaks, double weight, equations *e)
{
    double parts[ASJ_MOST_PARTS];
    if (model->view.plane_count == 0) { /* one part: its share is 1, whatever the ratio; equations weigh it by its residuals */
        add_part(set, c, 0, model, slopes, peaks->fine, weight, e);
        return;
    }
    const double sum = asj_likelihood_ratio(&model->view, set, c, peaks, parts);
    for (int32_t k = 0; k <= model->view.plane_count && sum > 0; k++)
        if (weight * parts[k] > LEAST * sum)
            add_part(set, c, k, model, slopes, peaks->fine, weight * parts[k] / sum, e);
}

static int32_t set_up(const asj_pairs *set, const asj_model *model, const double *probability, double loose, equations *e)
{
    const asj_peaks peaks = asj_likelihood_peaks(set, &model->view, loose);
    const int32_t n = model->parameters;
    asj_model_slopes slopes;
    memset(e, 0, sizeof *e);
    if (!asj_model_slopes_of(model, &slopes))
        return 0;
    for (int32_t k = 0; k < set->count; k++)
        if (probability[k] > LEAST)
            add_candidate(set, &set->list[k], model, &slopes, &peaks, probability[k], e);
    for (int32_t p = 0; p < n; p++)
        for (int32_t q = 0; q < p; q++)
            e->normal[q * n + p] = e->normal[p * n + q];
    return 1;
}

/* The prior of rotations pulls towards the likeliest of them. */
static void add_prior(const asj_pairs *set, const asj_model *model, equations *e)
{
    if (asj_model_has_rotation(model))
        asj_add_rotation_prior(set, model->rotation, model->parameters, e->normal, e->right);
}

void asj_information(const asj_pairs *set, const asj_model *model, const double *probability, double *information)
{
    equations e;
    if (!set_up(set, model, probability, 1, &e))
        memset(&e, 0, sizeof e);
    add_prior(set, model, &e);
    memcpy(information, e.normal, (size_t)(model->parameters * model->parameters) * sizeof *information);
}

/* The rotation, whose parameters are the first three, stays. */
static void hold_rotation(int32_t n, equations *e)
{
    for (int32_t p = 0; p < 3; p++) {
        for (int32_t q = 0; q < n; q++)
            e->normal[p * n + q] = e->normal[q * n + p] = p == q;
        e->right[p] = 0;
    }
}

enum { FREE, HELD };

/* One step; 0 when the equations cannot be solved. */
static int32_t step(const asj_pairs *set, asj_model *model, const double *probability, double loose, int32_t held)
{
    equations e;
    const int32_t n = model->parameters;
    if (!set_up(set, model, probability, loose, &e))
        return 0;
    add_prior(set, model, &e);
    for (int32_t p = 0; p < n; p++)
        e.normal[p * (n + 1)] += DAMPING * e.normal[p * (n + 1)] + 1e-3;
    if (held)
        hold_rotation(n, &e);
    if (!asj_cholesky_solve(e.normal, n, e.right, NULL))
        return 0;
    double size = 0;
    for (int32_t p = 0; p < n; p++) {
        if (!isfinite(e.right[p]))
            return 0;
        size = fmax(size, fabs(e.right[p]));
    }
    for (int32_t p = 0; p < n && size > 0.3; p++)
        e.right[p] *= 0.3 / size;
    asj_model moved;
    if (!asj_model_move(model, e.right, &moved))
        return 0;
    *model = moved;
    return 1;
}

int32_t asj_adjust_once(const asj_pairs *set, asj_model *model, const double *probability)
{
    return step(set, model, probability, 1, FREE);
}

int32_t asj_adjust_held(const asj_pairs *set, asj_model *model, const double *probability, double loose)
{
    return step(set, model, probability, loose, HELD);
}

double asj_choose_motion(const asj_pairs *set, const double *probability, asj_model *model)
{
    double essential[9], rotations[2][9], t[3], best = -HUGE_VAL;
    int32_t chosen = 0;
    asj_essential_of(model->view.matrix, model->cameras, essential);
    if (!asj_motions_of(essential, rotations, t))
        return -HUGE_VAL;
    for (int32_t m = 0; m < 4; m++) {
        const double sign = m < 2 ? 1 : -1, translation[3] = {sign * t[0], sign * t[1], sign * t[2]};
        double balance = 0;
        for (int32_t k = 0; k < set->count; k++)
            if (probability[k] > LEAST) {
                double r1[3], r2[3];
                asj_ray(&model->cameras[0], set->list[k].x1, set->list[k].y1, r1);
                asj_ray(&model->cameras[1], set->list[k].x2, set->list[k].y2, r2);
                const int32_t side = asj_in_front(rotations[m % 2], translation, r1, r2);
                balance += side > 0 ? probability[k] : side < 0 ? -BEHIND * probability[k] : 0;
            }
        if (balance > best) {
            best = balance;
            chosen = m;
        }
    }
    memcpy(model->rotation, rotations[chosen % 2], sizeof model->rotation);
    for (int32_t k = 0; k < 3; k++)
        model->translation[k] = chosen < 2 ? t[k] : -t[k];
    asj_model_complete(model);
    return best;
}

void asj_adjust(const asj_pairs *set, asj_model *model, int32_t rounds, asj_adjust_scratch *scratch)
{
    for (int32_t round = 0; round < rounds; round++) {
        const double loose = WIDE + (1 - WIDE) * fmin(1, round / fmax(1, rounds - 3.0));
        asj_probabilities(set, &model->view, loose, &scratch->score, scratch->probability);
        if (round == 0 && model->kind == ASJ_GEOMETRY_ESSENTIAL && model->view.plane_count == 0)
            asj_choose_motion(set, scratch->probability, model);
        if (!step(set, model, scratch->probability, loose, FREE))
            break;
    }
    model->score = asj_score(set, set->count, &model->view, 1, &scratch->score);
}

void asj_adjust_like(const asj_pairs *set, asj_model *model, const asj_model *like, int32_t rounds, asj_adjust_scratch *scratch)
{
    asj_probabilities(set, &like->view, 1, &scratch->score, scratch->probability);
    for (int32_t round = 0; round < rounds; round++) {
        const int32_t own = round >= LIKE_ROUNDS;
        if (own)
            asj_probabilities(set, &model->view, 1, &scratch->score, scratch->probability);
        if (!step(set, model, scratch->probability, own ? 1 : WIDE, FREE))
            break;
    }
    model->score = asj_score(set, set->count, &model->view, 1, &scratch->score);
}

double asj_explained(const asj_pairs *set, const asj_model *model, asj_adjust_scratch *scratch)
{
    asj_probabilities(set, &model->view, 1, &scratch->score, scratch->probability);
    return asj_inliers(set, scratch->probability);
}

void asj_adjust_scratch_free(asj_memory *memory, asj_adjust_scratch *s)
{
    for (int32_t v = 0; v < 2; v++) {
        asj_release(memory, s->score.sum[v]);
        asj_release(memory, s->score.touched[v]);
        asj_release(memory, s->weights[v]);
    }
    asj_release(memory, s->score.near);
    asj_release(memory, s->score.ratio);
    asj_release(memory, s->probability);
    asj_release(memory, s->shares);
    asj_release(memory, s->sorted);
    asj_release(memory, s->best);
    asj_release(memory, s->spots);
}

int32_t asj_adjust_scratch_create(asj_memory *memory, const asj_pairs *set, asj_adjust_scratch *s)
{
    int32_t good = 1;
    for (int32_t v = 0; v < 2; v++) {
        const size_t places = (size_t)set->place_count[v];
        s->score.sum[v] = asj_allocate_zero(memory, places, sizeof *s->score.sum[v]);
        s->score.touched[v] = asj_allocate(memory, places, sizeof *s->score.touched[v]);
        s->weights[v] = asj_allocate(memory, places, sizeof *s->weights[v]);
        good = good && s->score.sum[v] && s->score.touched[v] && s->weights[v];
    }
    const size_t most = (size_t)(set->place_count[0] > set->place_count[1] ? set->place_count[0] : set->place_count[1]);
    s->score.near = asj_allocate(memory, (size_t)set->count + 1, sizeof *s->score.near);
    s->score.ratio = asj_allocate(memory, (size_t)set->count, sizeof *s->score.ratio);
    s->probability = asj_allocate(memory, (size_t)set->count, sizeof *s->probability);
    s->shares = asj_allocate(memory, most, sizeof *s->shares);
    s->sorted = asj_allocate(memory, most, sizeof *s->sorted);
    s->best = asj_allocate(memory, most, sizeof *s->best);
    s->spots = asj_allocate(memory, 5 * most, sizeof *s->spots);
    return good && s->score.near && s->score.ratio && s->probability && s->shares && s->sorted && s->best && s->spots;
}

void asj_adjust_scratches_free(asj_memory *memory, asj_adjust_scratch *scratches, int32_t threads)
{
    for (int32_t t = 0; scratches && t < threads; t++)
        asj_adjust_scratch_free(memory, &scratches[t]);
    asj_release(memory, scratches);
}

asj_adjust_scratch *asj_adjust_scratches_create(asj_memory *memory, const asj_pairs *set, int32_t threads)
{
    asj_adjust_scratch *scratches = asj_allocate_zero(memory, (size_t)threads, sizeof *scratches);
    int32_t good = scratches != NULL;
    for (int32_t t = 0; t < threads && good; t++)
        good = asj_adjust_scratch_create(memory, set, &scratches[t]);
    if (!good) {
        asj_adjust_scratches_free(memory, scratches, threads);
        return NULL;
    }
    return scratches;
}
