/* SPDX-License-Identifier: BSD-2-Clause */
/* A motion with another rotation.
 *
 * What is matched on one wall, or far away, allows motions that turn by several degrees more, if the camera moves and the wall
 * stands accordingly, and the directions of the room say which of them it is. On the way from one to the other all three have to
 * change together; steps of translation and planes alone, from where they were, lose the candidates instead. But once the rotation
 * R is known the rest is linear. With r1 and r2 the rays of a candidate and w its probability under `like`:
 *
 *     t:  sum of w ((R r1 x r2)' t)^2 / |R r1|^2 is least, |t| = 1: an eigenvector. Of t and -t that with more in front of both
 *         cameras.
 *     n:  r1 has the depth 1/s where r2 x (R r1 + s t) = a + s b is least, s = -a'b / b'b. The plane n'r1 = s through those that
 *         lie on it under `like`: sum of w b'b (n'r1 - s)^2 / |R r1|^2 is least.
 *
 * The steps that follow weigh the candidates' maps as well, and then what is probable under the model itself. */
#include "around_rotation.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define LEAST 1e-3       /* probability below which a candidate is left out */
#define LEAST_PARALLAX 1e-9 /* b'b: nothing is known of the depth */
#define WIDE 3.0
#define LIKE_ROUNDS 8
#define ROUNDS 4

/* A candidate's rays, that of image 1 turned into camera 2 as well. */
typedef struct ray_pair {
    double first[3], turned[3], second[3];
} ray_pair;

static ray_pair rays_of(const asj_model *m, const asj_pair *c)
{
    ray_pair r;
    asj_ray(&m->cameras[0], c->x1, c->y1, r.first);
    asj_ray(&m->cameras[1], c->x2, c->y2, r.second);
    asj_apply3(m->rotation, r.first, r.turned);
    return r;
}

static void fit_translation(const asj_pairs *set, const double *probability, asj_model *m)
{
    double sum[9] = {0}, values[3], vectors[9], in_front = 0;
    for (int32_t k = 0; k < set->count; k++) {
        double across[3];
        if (!(probability[k] > LEAST))
            continue;
        const ray_pair r = rays_of(m, &set->list[k]);
        asj_cross3(r.turned, r.second, across);
        const double weight = probability[k] / asj_dot3(r.turned, r.turned);
        for (int32_t i = 0; i < 9; i++)
            sum[i] += weight * across[i / 3] * across[i % 3];
    }
    asj_symmetric_eigen(sum, 3, values, vectors);
    for (int32_t i = 0; i < 3; i++)
        m->translation[i] = vectors[3 * i];
    for (int32_t k = 0; k < set->count; k++)
        if (probability[k] > LEAST) {
            const ray_pair r = rays_of(m, &set->list[k]);
            in_front += probability[k] * asj_in_front(m->rotation, m->translation, r.first, r.second);
        }
    for (int32_t i = 0; i < 3 && in_front < 0; i++)
        m->translation[i] = -m->translation[i];
}

/* A plane's normal equations. */
typedef struct plane_sums {
    double normal[9], right[3];
} plane_sums;

static void add_depth(const ray_pair *r, double depth, double weight, plane_sums *sums)
{
    for (int32_t i = 0; i < 9; i++)
        sums->normal[i] += weight * r->first[i / 3] * r->first[i % 3];
    for (int32_t i = 0; i < 3; i++)
        sums->right[i] += weight * depth * r->first[i];
}

/* Planes that cannot be fitted stay. */
static void fit_planes(const asj_pairs *set, const double *probability, const asj_model *like, asj_model *m)
{
    const asj_peaks peaks = asj_likelihood_peaks(set, &like->view, 1);
    plane_sums sums[ASJ_MOST_PLANES];
    memset(sums, 0, sizeof sums);
    for (int32_t k = 0; k < set->count; k++) {
        double parts[ASJ_MOST_PARTS], a[3], b[3];
        if (!(probability[k] > LEAST))
            continue;
        const ray_pair r = rays_of(m, &set->list[k]);
        const double all = asj_likelihood_ratio(&like->view, set, &set->list[k], &peaks, parts);
        asj_cross3(r.second, r.turned, a);
        asj_cross3(r.second, m->translation, b);
        const double parallax = asj_dot3(b, b);
        if (!(parallax > LEAST_PARALLAX) || !(all > 0))
            continue;
        const double weight = probability[k] * parallax / asj_dot3(r.turned, r.turned);
        for (int32_t p = 0; p < m->view.plane_count; p++)
            add_depth(&r, -asj_dot3(a, b) / parallax, weight * parts[p + 1] / all, &sums[p]);
    }
    for (int32_t p = 0; p < m->view.plane_count; p++)
        if (asj_cholesky_solve(sums[p].normal, 3, sums[p].right, NULL))
            memcpy(m->planes[p], sums[p].right, sizeof m->planes[p]);
}

void asj_adjust_around_rotation(const asj_pairs *set, asj_model *model, const asj_model *like, asj_adjust_scratch *scratch)
{
    double *probability = scratch->probability;
    asj_model fitted = *model;
    asj_probabilities(set, &like->view, 1, &scratch->score, probability);
    fit_translation(set, probability, &fitted);
    if (fitted.view.plane_count > 0)
        fit_planes(set, probability, like, &fitted);
    if (asj_model_complete(&fitted))
        *model = fitted;
    for (int32_t round = 0; round < LIKE_ROUNDS; round++)
        if (!asj_adjust_held(set, model, probability, WIDE))
            return;
    for (int32_t round = 0; round < ROUNDS; round++) {
        const double loose = WIDE + (1 - WIDE) * round / (ROUNDS - 1);
        asj_probabilities(set, &model->view, loose, &scratch->score, probability);
        if (!asj_adjust_held(set, model, probability, loose))
            return;
    }
}
