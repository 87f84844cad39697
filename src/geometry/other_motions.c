/* SPDX-License-Identifier: BSD-2-Clause */
/* What other motions are beside a settled one: the same one, or another one that may be right as well, by which the pose is known
 * less well than the candidates around it say. */
#include "other_motions.h"
#include "core/angle.h"
#include "manhattan.h"
#include "posterior.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define MOTION 5         /* parameters */
#define LEAST_SD 1e-3    /* rad: nearer motions are one */
#define WITHIN 4.0       /* standard deviations */
#define MOST_TURN 0.6    /* rad */
#define BESIDE 0.14      /* rad: 8 degrees, turn and translation together */
#define LEAST_WEIGHT 0.01

/* The other motion in the parameters of the first; 0 when it is too far away for that. */
static int32_t difference(const asj_model *model, const asj_model *other, double at[MOTION])
{
    double turn[9], axes[2][3];
    asj_multiply3_transposed(other->rotation, model->rotation, turn);
    const double along = asj_dot3(other->translation, model->translation);
    if (asj_rotation_angle(turn) > MOST_TURN || !(along > cos(MOST_TURN)))
        return 0;
    asj_vector_of_rotation(turn, at);
    asj_translation_axes(model->translation, axes[0], axes[1]);
    for (int32_t k = 0; k < 2; k++)
        at[3 + k] = asj_dot3(axes[k], other->translation) / along;
    return 1;
}

int32_t asj_is_within(const asj_model *settled, const asj_model *other)
{
    double at[MOTION], covariance[MOTION * MOTION], y[MOTION], square = 0;
    if (!settled->settled || !difference(settled, other, at))
        return 0;
    memcpy(covariance, settled->covariance, sizeof covariance);
    for (int32_t k = 0; k < MOTION; k++)
        covariance[k * (MOTION + 1)] += LEAST_SD * LEAST_SD;
    memcpy(y, at, sizeof y);
    if (!asj_cholesky_solve(covariance, MOTION, y, NULL))
        return 0;
    for (int32_t k = 0; k < MOTION; k++)
        square += at[k] * y[k];
    return square < WITHIN * WITHIN;
}

/* How likely another motion is, of the best one. What is beside that explains the same candidates, and a few more by how these are
 * out together: exp(ASJ_TEMPER evidence), with the density of rotations in full (posterior.c). What is far away has other
 * candidates. (A rendered room whose matches lie on one wall: of two motions 2.2 degrees apart the wrong one has 330 nats for 320,
 * and 6 fewer for its rotation. It was told to .4 degrees.) */
static double weight_beside(const asj_pairs *set, const asj_model *best, const asj_model *other, int32_t is_near)
{
    const double more = other->evidence - (other->settled ? best->evidence : fmin(best->peak, best->evidence));
    const double rotation = is_near ? asj_rotation_prior(set, other->rotation) - asj_rotation_prior(set, best->rotation) : 0;
    return fmin(1, exp(ASJ_TEMPER * more + (1 - ASJ_TEMPER) * rotation));
}

/* The square of how far it is. */
static double size_of(const double at[MOTION])
{
    double square = 0;
    for (int32_t k = 0; k < MOTION; k++)
        square += at[k] * at[k];
    return square;
}

double asj_motion_covariance(const asj_pairs *set, const asj_model *models, int32_t count, int32_t best, double covariance[25])
{
    const asj_model *m = &models[best];
    double at[MOTION];
    memcpy(covariance, m->covariance, sizeof m->covariance);
    for (int32_t n = 0; n < count; n++) {
        const asj_model *o = &models[n];
        if (n == best || o->kind != m->kind || o->struck != ASJ_NOT_STRUCK || asj_is_within(m, o))
            continue;
        const int32_t in_reach = difference(m, o, at), is_near = in_reach && size_of(at) < BESIDE * BESIDE;
        const double weight = weight_beside(set, m, o, is_near);
        if (!(weight > LEAST_WEIGHT))
            continue;
        if (!in_reach) { /* in no direction rather than another */
            for (int32_t k = 0; k < MOTION; k++)
                covariance[k * (MOTION + 1)] += weight * MOTION * MOST_TURN * MOST_TURN;
            continue;
        }
        for (int32_t i = 0; i < MOTION; i++)
            for (int32_t k = 0; k < MOTION; k++)
                covariance[i * MOTION + k] += weight * at[i] * at[k];
    }
    return m->settled ? asj_largest_sd(covariance, MOTION) : HUGE_VAL;
}
