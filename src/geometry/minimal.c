/* SPDX-License-Identifier: BSD-2-Clause */
/* Minimal sets of affine correspondences.
 *
 * essential: an affine correspondence stands for three pairs of points x1 + d, x2 + A d with |d| = REACH px at 0, 120 and 240
 * degrees (the map is known as far as its disc was aligned). Two give six; five go into the five-point solver, and of its
 * solutions the one stays that fits both correspondences best in all their residuals. Of its four motions the one with all six
 * points in front of both cameras.
 *
 * fundamental: x2' F x1 = 0 and A' n2 + n1 = 0 are linear in F (likelihood.c), so three correspondences give nine equations: least
 * squares (vector of the smallest eigenvalue of their normal matrix), then the nearest matrix of rank 2.
 *
 * homography (Barath and Hajder, "A theory of point-wise homography estimation", Pattern Recognition Letters 2017): with h3 x1 the
 * third coordinate, (h1 - x2 h3) (x1, y1, 1)' = 0, (h2 - y2 h3) (x1, y1, 1)' = 0 and their derivatives
 *
 *     h_1j - x2 h_3j - a_1j (h3 (x1, y1, 1)') = 0,     h_2j - y2 h_3j - a_2j (h3 (x1, y1, 1)') = 0,     j = 1, 2:
 *
 * six equations a correspondence, twelve for eight unknowns. Derivatives weigh as much as points REACH px away.
 *
 * All in coordinates K^-1 x of cameras known or assumed, so that the numbers are near 1. */
#include "minimal.h"
#include "five_point.h"
#include "small_matrix.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define REACH 12.0 /* px */
#define CONTRADICTION 136.0 /* squared residual, in standard deviations: twice what likelihood.c looks at */

/* The correspondence in normalised coordinates. */
typedef struct normal_pair {
    double x1, y1, x2, y2;
    double a[4];
    double weight; /* of derivatives: REACH px in these units */
} normal_pair;

static normal_pair normalise(const asj_pair *c, const asj_camera cameras[2])
{
    const asj_camera *k1 = &cameras[0], *k2 = &cameras[1];
    const normal_pair n = {(c->x1 - k1->cx) / k1->fx, (c->y1 - k1->cy) / k1->fy, (c->x2 - k2->cx) / k2->fx,
                           (c->y2 - k2->cy) / k2->fy,
                           {c->affine[0] * k1->fx / k2->fx, c->affine[1] * k1->fy / k2->fx, c->affine[2] * k1->fx / k2->fy,
                            c->affine[3] * k1->fy / k2->fy},
                           REACH / k1->fx};
    return n;
}

/* --- essential --------------------------------------------------------------------------------------------------------------- */

void asj_rays_beside(const asj_pair *c, const asj_camera cameras[2], int32_t k, double ray1[3], double ray2[3])
{
    static const double direction[3][2] = {{1, 0}, {-0.5, 0.8660254037844386}, {-0.5, -0.8660254037844386}};
    const double dx = REACH * direction[k][0], dy = REACH * direction[k][1];
    const double x2 = c->x2 + c->affine[0] * dx + c->affine[1] * dy, y2 = c->y2 + c->affine[2] * dx + c->affine[3] * dy;
    asj_ray(&cameras[0], c->x1 + dx, c->y1 + dy, ray1);
    asj_ray(&cameras[1], x2, y2, ray2);
}

static asj_ray_pair point_of(const asj_pair *c, const asj_camera cameras[2], int32_t k)
{
    double r1[3], r2[3];
    asj_rays_beside(c, cameras, k, r1, r2);
    return (asj_ray_pair){r1[0], r1[1], r2[0], r2[1]};
}

/* The motion of an essential matrix that has all points in front; 0 when none has. */
static int32_t choose_motion(const double essential[9], const asj_ray_pair rays[6], asj_model *model)
{
    double rotations[2][9], t[3];
    if (!asj_motions_of(essential, rotations, t))
        return 0;
    for (int32_t m = 0; m < 4; m++) {
        const double sign = m < 2 ? 1 : -1, translation[3] = {sign * t[0], sign * t[1], sign * t[2]};
        int32_t front = 0, behind = 0;
        for (int32_t k = 0; k < 6; k++) {
            const double r1[3] = {rays[k].x1, rays[k].y1, 1}, r2[3] = {rays[k].x2, rays[k].y2, 1};
            const int32_t side = asj_in_front(rotations[m % 2], translation, r1, r2);
            front += side > 0;
            behind += side < 0;
        }
        if (behind == 0 && front > 0) {
            memcpy(model->rotation, rotations[m % 2], sizeof model->rotation);
            memcpy(model->translation, translation, sizeof translation);
            return 1;
        }
    }
    return 0;
}

int32_t asj_essential_from_two(const asj_pairs *set, const asj_pair *const pairs[2], const asj_camera cameras[2], asj_model *model)
{
    asj_ray_pair rays[6];
    double solutions[ASJ_FIVE_POINT_SOLUTIONS][9], best = HUGE_VAL;
    int32_t chosen = -1;
    for (int32_t k = 0; k < 6; k++)
        rays[k] = point_of(pairs[k / 3], cameras, k % 3);
    const int32_t count = asj_five_point(rays, solutions);
    for (int32_t s = 0; s < count; s++) {
        double f[9], sum = 0;
        asj_residuals r;
        asj_fundamental_of(solutions[s], cameras, f);
        for (int32_t k = 0; k < 2; k++) {
            asj_epipolar_residuals(f, set, pairs[k], &r);
            sum += r.square;
        }
        if (sum < best) {
            best = sum;
            chosen = s;
        }
    }
    if (chosen < 0 || !(best < CONTRADICTION) || !choose_motion(solutions[chosen], rays, model))
        return 0;
    model->kind = ASJ_GEOMETRY_ESSENTIAL;
    model->parameters = 5;
    memcpy(model->cameras, cameras, sizeof model->cameras);
    return asj_model_complete(model);
}

/* y2 (t x R y1) = 0 says that t is at right angles to R y1 x y2: two give it. Of its signs the one that has both in front. */
int32_t asj_translation_from_two(const asj_pair *const pairs[2], const double rotation[9], const asj_camera cameras[2],
                                 asj_model *model)
{
    double rays[2][2][3], normal[2][3], *t = model->translation;
    for (int32_t k = 0; k < 2; k++) {
        double turned[3];
        asj_ray(&cameras[0], pairs[k]->x1, pairs[k]->y1, rays[k][0]);
        asj_ray(&cameras[1], pairs[k]->x2, pairs[k]->y2, rays[k][1]);
        asj_apply3(rotation, rays[k][0], turned);
        asj_cross3(turned, rays[k][1], normal[k]);
        if (!asj_normalise3(normal[k]))
            return 0;
    }
    asj_cross3(normal[0], normal[1], t);
    if (!(asj_dot3(t, t) > 1e-6) || !asj_normalise3(t))
        return 0;
    if (asj_in_front(rotation, t, rays[0][0], rays[0][1]) < 0)
        for (int32_t k = 0; k < 3; k++)
            t[k] = -t[k];
    for (int32_t k = 0; k < 2; k++)
        if (asj_in_front(rotation, t, rays[k][0], rays[k][1]) < 0)
            return 0;
    model->kind = ASJ_GEOMETRY_ESSENTIAL;
    model->parameters = 5;
    memcpy(model->rotation, rotation, sizeof model->rotation);
    memcpy(model->cameras, cameras, sizeof model->cameras);
    return asj_model_complete(model);
}

/* --- linear ------------------------------------------------------------------------------------------------------------------ */

static void add_row(double normal[81], const double row[9])
{
    for (int32_t i = 0; i < 9; i++)
        for (int32_t k = 0; k < 9; k++)
            normal[9 * i + k] += row[i] * row[k];
}

int32_t asj_fundamental_from_three(const asj_pair *const pairs[3], const asj_camera cameras[2], asj_model *model)
{
    double normal[81] = {0}, e[9], u[9], s[3], v[9];
    for (int32_t k = 0; k < 3; k++) {
        const normal_pair n = normalise(pairs[k], cameras);
        const double x = n.x1, y = n.y1, p = n.x2, q = n.y2, w = n.weight;
        const double point[9] = {p * x, p * y, p, q * x, q * y, q, x, y, 1};
        /* the derivatives of the row before along x1 and y1, with x2 and y2 moving by A */
        const double along[2][9] = {
            {w * (p + n.a[0] * x), w * n.a[0] * y, w * n.a[0], w * (q + n.a[2] * x), w * n.a[2] * y, w * n.a[2], w, 0, 0},
            {w * n.a[1] * x, w * (p + n.a[1] * y), w * n.a[1], w * n.a[3] * x, w * (q + n.a[3] * y), w * n.a[3], 0, w, 0}};
        add_row(normal, point);
        add_row(normal, along[0]);
        add_row(normal, along[1]);
    }
    if (!asj_least_vector9(normal, e))
        return 0;
    asj_svd3(e, u, s, v);
    for (int32_t i = 0; i < 9; i++) /* U diag(s0, s1, 0) V' */
        e[i] = s[0] * u[i / 3 * 3] * v[i % 3 * 3] + s[1] * u[i / 3 * 3 + 1] * v[i % 3 * 3 + 1];
    if (!(s[1] > 1e-6 * s[0]))
        return 0;
    model->kind = ASJ_GEOMETRY_FUNDAMENTAL;
    model->parameters = 7;
    memcpy(model->cameras, cameras, sizeof model->cameras);
    asj_fundamental_of(e, cameras, model->view.matrix);
    return asj_model_complete(model);
}

/* A row of which only the entries of h_i and of h3 are not 0; on and below the diagonal. */
static void add_row_of_six(double normal[81], int32_t i, const double row[6])
{
    for (int32_t p = 0; p < 6; p++)
        for (int32_t q = 0; q <= p; q++)
            normal[9 * (p < 3 ? 3 * i + p : 3 + p) + (q < 3 ? 3 * i + q : 3 + q)] += row[p] * row[q];
}

int32_t asj_homography_from_two(const asj_pairs *set, const asj_pair *const pairs[2], const asj_camera cameras[2], asj_model *model)
{
    double normal[81] = {0}, h[9];
    for (int32_t k = 0; k < 2; k++) {
        const normal_pair n = normalise(pairs[k], cameras);
        for (int32_t i = 0; i < 2; i++) { /* the coordinate of image 2 */
            const double to = i == 0 ? n.x2 : n.y2, *a = n.a + 2 * (ptrdiff_t)i, w = n.weight;
            const double row[6] = {n.x1, n.y1, 1, -to * n.x1, -to * n.y1, -to};
            add_row_of_six(normal, i, row);
            for (int32_t j = 0; j < 2; j++) {
                double along[6] = {0, 0, 0, -w * a[j] * n.x1, -w * a[j] * n.y1, -w * a[j]};
                along[j] = w;
                along[3 + j] -= w * to;
                add_row_of_six(normal, i, along);
            }
        }
    }
    if (!asj_least_vector9(normal, h))
        return 0;
    model->kind = ASJ_GEOMETRY_HOMOGRAPHY;
    model->parameters = 8;
    memcpy(model->cameras, cameras, sizeof model->cameras);
    const double *n3 = h + 6;
    double ray[3];
    asj_ray(&cameras[0], pairs[0]->x1, pairs[0]->y1, ray);
    const double sign = asj_dot3(n3, ray) < 0 ? -1 : 1; /* what is seen has a positive third coordinate */
    for (int32_t k = 0; k < 9; k++)
        h[k] *= sign;
    asj_pixel_homography(h, cameras, model->view.matrix);
    for (int32_t k = 0; k < 2; k++) { /* twelve equations for eight unknowns: most wrong ones contradict each other */
        asj_residuals r;
        asj_planar_residuals(model->view.matrix, set, pairs[k], &r);
        if (!(r.square < CONTRADICTION))
            return 0;
    }
    return asj_model_complete(model);
}
