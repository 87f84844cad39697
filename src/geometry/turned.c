/* SPDX-License-Identifier: BSD-2-Clause */
/* Where the directions of a room give the rotation R, but for the 24 ways to name them (manhattan.c), the translation t is all that
 * is left. A match with the rays y1 and y2 asks that
 *
 *     t . n = 0,    n = R y1 x y2:
 *
 * t lies on a great circle. Two right matches give it, but where one candidate in ten is right that is one sample in a hundred,
 * times 24 rotations. So one candidate is drawn, and all others vote for the place on its great circle (a Hough transform of one
 * dimension): with a, b at right angles to n and to each other, t = a cos u + b sin u, and another candidate's normal m says
 *
 *     tan u = - (m . a) / (m . b),    u in [0, pi).
 *
 * A location that is out by e rad moves the normal by e / |m|, and its vote by that over the sine s of the angle between the
 * normals: where |m| s is less than CLEAR, a vote is spread over so many bins that each receives |m| s / CLEAR of it.
 * Else the votes weigh as the priors, times what labels (labels.c) say of the candidate under the rotation. Bins are of equal
 * width in
 *
 *     d = s / (s + |c|) for c >= 0,   2 - s / (s + |c|) for c < 0,   (c, s) = (m . b, - m . a) or, where that has s < 0, minus it,
 *
 * which rises with u and needs no arc tangent. Great circles of wrong candidates go between their two rays, so they
 * all vote for where the cameras look to: what counts is by how much a bin, with half of its neighbours, is above the mean of those
 * around it, in units of the root of that mean, as for numbers of chance. */
#include "turned.h"
#include "labels.h"
#include "small_matrix.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define BINS 128
#define CLEAR 0.05 /* a pixel of 600 over the width of a bin */
#define BLOCK 128
#define AROUND 10 /* bins */

int32_t asj_turned_create(asj_memory *memory, const asj_pairs *set, int32_t count, const double *weights,
                          const asj_camera cameras[2], asj_turned *turned)
{
    turned->count = count;
    turned->normal = asj_allocate(memory, (size_t)count, 3 * (size_t)set->rotation_count * sizeof *turned->normal);
    turned->weight = asj_allocate(memory, (size_t)count, (size_t)set->rotation_count * sizeof *turned->weight);
    if (!turned->normal || !turned->weight)
        return 0;
    for (int32_t k = 0; k < count; k++) {
        const asj_pair *c = &set->list[k];
        double y1[3], y2[3];
        asj_ray(&cameras[0], c->x1, c->y1, y1);
        asj_ray(&cameras[1], c->x2, c->y2, y2);
        const double weight = c->prior * (weights ? weights[k] : 1);
        for (int32_t r = 0; r < set->rotation_count; r++) {
            const double labels = set->has_labels ? asj_label_ratio(&set->rotations[r], c) : 1;
            turned->weight[(ptrdiff_t)count * r + k] = (float)(weight * labels);
            float *normal = turned->normal + 3 * (ptrdiff_t)count * r + k;
            double rotated[3], n[3];
            asj_apply3(set->rotations[r].matrix, y1, rotated);
            asj_cross3(rotated, y2, n);
            const double factor = 1 / (CLEAR * sqrt(asj_dot3(y1, y1) * asj_dot3(y2, y2)));
            for (int32_t i = 0; i < 3; i++)
                normal[(ptrdiff_t)i * count] = (float)(factor * n[i]);
        }
    }
    return 1;
}

void asj_turned_free(asj_memory *memory, asj_turned *turned)
{
    asj_release(memory, turned->normal);
    asj_release(memory, turned->weight);
}

/* The bin of each of `count` normals, and how much of its vote. Choices are between constants: which it will be cannot be foreseen,
 * and compilers make vectors of the loop then. */
static void find_bins(const float *x, const float *y, const float *z, int32_t count, const float a[3], const float b[3],
                      int32_t *bins, float *part)
{
    const float a0 = a[0], a1 = a[1], a2 = a[2], b0 = b[0], b1 = b[1], b2 = b[2];
    for (int32_t k = 0; k < count; k++) {
        const float p = x[k] * a0 + y[k] * a1 + z[k] * a2, q = x[k] * b0 + y[k] * b1 + z[k] * b2;
        const float s = fabsf(p), c = q * (p > 0 ? -1.0F : 1.0F), size = s + fabsf(q); /* (c, s) = +- (q, -p), s >= 0 */
        const float d = s / (size + 1e-20F), start = c < 0 ? 2.0F : 0.0F, way = c < 0 ? -1.0F : 1.0F; /* the turn: d or 2 - d */
        bins[k] = (int32_t)((start + way * d) * (0.5F * BINS));
        part[k] = size < 1 ? size : 1;
    }
}

/* cos u, sin u (but for their length) of the middle of a bin. */
static void middle_of(int32_t bin, double *cosine, double *sine)
{
    const double d = (bin + 0.5) / (0.5 * BINS);
    *sine = d < 1 ? d : 2 - d;
    *cosine = 1 - d;
}

/* The bin that stands out most from those around it. */
static int32_t clearest(const float votes[BINS])
{
    float sums[BINS + 2 * AROUND + 1], most = -HUGE_VALF;
    int32_t best = 0;
    sums[0] = 0;
    for (int32_t k = 0; k < BINS + 2 * AROUND; k++)
        sums[k + 1] = sums[k] + votes[(k + BINS - AROUND) % BINS];
    for (int32_t k = 0; k < BINS; k++) {
        const float sum = 0.5F * (votes[k] + 0.5F * (votes[(k + 1) % BINS] + votes[(k + BINS - 1) % BINS]));
        const float usual = (sums[k + 2 * AROUND + 1] - sums[k]) / (2 * AROUND + 1), clear = (sum - usual) / sqrtf(usual + 1e-6F);
        best = clear > most ? k : best;
        most = clear > most ? clear : most;
    }
    return best;
}

int32_t asj_translation_by_vote(const asj_pairs *set, const asj_turned *turned, int32_t rotation, const asj_pair *pair,
                                const asj_camera cameras[2], asj_model *model)
{
    const ptrdiff_t count = turned->count, at = pair - set->list;
    const float *x = turned->normal + 3 * count * rotation, *y = x + count, *z = y + count;
    const float *weight = turned->weight + count * rotation;
    double n[3] = {(double)x[at], (double)y[at], (double)z[at]}, a[3], b[3], cosine, sine, rays[2][3];
    float votes[BINS + 1] = {0}, part[BLOCK]; /* the last bin is the first one again */
    int32_t bins[BLOCK];
    if (!(asj_dot3(n, n) > 1e-4) || !asj_normalise3(n))
        return 0;
    asj_translation_axes(n, a, b);
    const float af[3] = {(float)a[0], (float)a[1], (float)a[2]}, bf[3] = {(float)b[0], (float)b[1], (float)b[2]};
    for (int32_t first = 0; first < turned->count; first += BLOCK) {
        const int32_t some = turned->count - first < BLOCK ? turned->count - first : BLOCK;
        find_bins(x + first, y + first, z + first, some, af, bf, bins, part);
        for (int32_t k = 0; k < some; k++)
            votes[bins[k]] += part[k] * weight[first + k];
    }
    votes[0] += votes[BINS];
    middle_of(clearest(votes), &cosine, &sine);
    for (int32_t k = 0; k < 3; k++)
        model->translation[k] = cosine * a[k] + sine * b[k];
    if (!asj_normalise3(model->translation))
        return 0;
    asj_ray(&cameras[0], pair->x1, pair->y1, rays[0]);
    asj_ray(&cameras[1], pair->x2, pair->y2, rays[1]);
    if (asj_in_front(set->rotations[rotation].matrix, model->translation, rays[0], rays[1]) < 0)
        for (int32_t k = 0; k < 3; k++)
            model->translation[k] = -model->translation[k];
    model->kind = ASJ_GEOMETRY_ESSENTIAL;
    model->parameters = 5;
    memcpy(model->rotation, set->rotations[rotation].matrix, sizeof model->rotation);
    memcpy(model->cameras, cameras, sizeof model->cameras);
    return asj_model_complete(model);
}
