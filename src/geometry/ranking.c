/* SPDX-License-Identifier: BSD-2-Clause */
/* Which geometries are one: hypotheses near each other lead to the same optimum, and only the best of them is followed. */
#include "ranking.h"
#include "small_matrix.h"

#include <math.h>

#define SAME_TURN 0.05      /* rad: rotations nearer than this and .. */
#define SAME_DIRECTION 0.1  /* rad: .. translations nearer than this are one hypothesis */
#define SAME_MATRIX 0.05    /* of matrices of norm 1 in normalised coordinates */

int asj_by_score(const void *left, const void *right)
{
    const asj_ranked *p = left, *q = right;
    if (p->score != q->score)
        return p->score > q->score ? -1 : 1;
    return p->index - q->index;
}

static int32_t same(const asj_model *a, const asj_model *b)
{
    if (a->kind == ASJ_GEOMETRY_ESSENTIAL) {
        double turn[9], c[3];
        asj_multiply3_transposed(a->rotation, b->rotation, turn);
        asj_cross3(a->translation, b->translation, c);
        return asj_rotation_angle(turn) < SAME_TURN && asj_dot3(a->translation, b->translation) > 0 &&
               sqrt(asj_dot3(c, c)) < SAME_DIRECTION;
    }
    double p[9], q[9], dot = 0, pp = 0, qq = 0;
    if (a->kind == ASJ_GEOMETRY_HOMOGRAPHY) {
        asj_normal_homography(a->view.matrix, a->cameras, p);
        asj_normal_homography(b->view.matrix, b->cameras, q);
    } else {
        asj_essential_of(a->view.matrix, a->cameras, p);
        asj_essential_of(b->view.matrix, b->cameras, q);
    }
    for (int32_t k = 0; k < 9; k++) {
        dot += p[k] * q[k];
        pp += p[k] * p[k];
        qq += q[k] * q[k];
    }
    return dot * dot > (1 - SAME_MATRIX * SAME_MATRIX) * pp * qq;
}

int32_t asj_pick(const asj_model *models, const asj_ranked *order, int32_t count, int32_t most, asj_model *best)
{
    int32_t picked = 0;
    for (int32_t k = 0; k < count && picked < most; k++) {
        int32_t fresh = order[k].score > -HUGE_VAL;
        for (int32_t m = 0; m < picked && fresh; m++)
            fresh = !same(&best[m], &models[order[k].index]);
        if (fresh)
            best[picked++] = models[order[k].index];
    }
    return picked;
}
