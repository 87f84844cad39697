/* SPDX-License-Identifier: BSD-2-Clause */
/* How the geometries move.
 *
 * essential: R <- exp([w]x) R, and t turned about the two axes at right angles to it; each plane's n by its entries. fundamental:
 * E' = K2' F K1 = U diag(1, s, 0) V', which has seven degrees of freedom: U and V turned, s <- s exp(d) (Bartoli and Sturm,
 * "Nonlinear estimation of the fundamental matrix with minimal parameters", PAMI 2004). homography: the entries of K2^-1 H K1 but
 * the largest, which is 1; of a camera that only turns, K2 R K1^-1: R as above. */
#include "model.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define RELIEF 0.003 /* location_sd for each px of parallax: of 1.5 px .0045 of the distance, 1 cm at 2.2 m */
#define THINNEST 0.3 /* location_sd: without parallax .45 px */
#define PARALLAX 0.006 /* rad between rays: a location is out by 1.5 px of 600, each of two */

static int32_t unit_norm(double m[9])
{
    double sum = 0;
    for (int32_t k = 0; k < 9; k++)
        sum += m[k] * m[k];
    if (!(sum > 0) || !isfinite(sum))
        return 0;
    for (int32_t k = 0; k < 9; k++)
        m[k] /= sqrt(sum);
    return 1;
}

/* K = [fx 0 cx; 0 fy cy; 0 0 1] */
static void matrix_of(const asj_camera *c, double k[9])
{
    const double m[9] = {c->fx, 0, c->cx, 0, c->fy, c->cy, 0, 0, 1};
    memcpy(k, m, sizeof m);
}

static void inverse_of(const asj_camera *c, double k[9])
{
    const double m[9] = {1 / c->fx, 0, -c->cx / c->fx, 0, 1 / c->fy, -c->cy / c->fy, 0, 0, 1};
    memcpy(k, m, sizeof m);
}

void asj_pixel_fundamental(const double essential[9], const asj_camera cameras[2], double f[9])
{
    double k1[9], k2[9], half[9];
    inverse_of(&cameras[0], k1);
    inverse_of(&cameras[1], k2);
    asj_multiply3(essential, k1, half);
    asj_transposed_multiply3(k2, half, f);
}

void asj_fundamental_of(const double essential[9], const asj_camera cameras[2], double f[9])
{
    asj_pixel_fundamental(essential, cameras, f);
    unit_norm(f);
}

void asj_essential_of(const double f[9], const asj_camera cameras[2], double essential[9])
{
    double k1[9], k2[9], half[9];
    matrix_of(&cameras[0], k1);
    matrix_of(&cameras[1], k2);
    asj_multiply3(f, k1, half);
    asj_transposed_multiply3(k2, half, essential);
    unit_norm(essential);
}

void asj_pixel_homography(const double normal[9], const asj_camera cameras[2], double h[9])
{
    double k1[9], k2[9], half[9];
    inverse_of(&cameras[0], k1);
    matrix_of(&cameras[1], k2);
    asj_multiply3(normal, k1, half);
    asj_multiply3(k2, half, h);
}

void asj_normal_homography(const double h[9], const asj_camera cameras[2], double normal[9])
{
    double k1[9], k2[9], half[9];
    matrix_of(&cameras[0], k1);
    inverse_of(&cameras[1], k2);
    asj_multiply3(h, k1, half);
    asj_multiply3(k2, half, normal);
}

int32_t asj_motions_of(const double essential[9], double rotations[2][9], double translation[3])
{
    /* R = U W V' or U W' V', t = the third column of U; W turns by 90 degrees about z. U and V are rotations already. */
    static const double w[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1}, back[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1};
    double u[9], s[3], v[9], half[9];
    asj_svd3(essential, u, s, v);
    if (!(s[1] > 1e-9 * s[0]) || !isfinite(s[0]))
        return 0;
    asj_multiply3(u, w, half);
    asj_multiply3_transposed(half, v, rotations[0]);
    asj_multiply3(u, back, half);
    asj_multiply3_transposed(half, v, rotations[1]);
    for (int32_t i = 0; i < 3; i++)
        translation[i] = u[3 * i + 2];
    return 1;
}

/* d2 x2 = d1 R x1 + t. Times x2 and times R x1 (cross products): d1 = -(x2 x t)(x2 x R x1) / |x2 x R x1|^2,
 * d2 = (R x1 x t)(R x1 x x2) / |..|^2; with c = R x1 x x2 the signs are those of (x2 x t) c and (R x1 x t) c. */
int32_t asj_in_front(const double rotation[9], const double translation[3], const double ray1[3], const double ray2[3])
{
    double turned[3], c[3], side1[3], side2[3];
    asj_apply3(rotation, ray1, turned);
    asj_cross3(turned, ray2, c);
    asj_cross3(ray2, translation, side1);
    asj_cross3(turned, translation, side2);
    const double parallel = asj_dot3(c, c) / (asj_dot3(turned, turned) * asj_dot3(ray2, ray2));
    if (!(parallel > 1e-8)) /* rays within 0.006 degrees of each other meet nowhere in particular */
        return 0;
    return asj_dot3(side1, c) > 0 && asj_dot3(side2, c) > 0 ? 1 : -1;
}

/* What belongs to a plane stands a little before or behind it: frames, skirtings, handles. By a share s of its distance it is off
 * by s times its parallax, which is f |n| px at most. Seen from far apart that is as much as locations are off anyway; from 1 to 15
 * degrees apart it is less, and a plane to which all belongs that lies within the errors of locations takes what tells the motion
 * (tests/accuracy/tried/geometry.md, "Near each other"). */
static double thickness_of(const double plane[3], const asj_camera *camera)
{
    return fmin(1, hypot(THINNEST, RELIEF * camera->fx * sqrt(asj_dot3(plane, plane))));
}

/* The homographies of the planes: K2 (R + t n') K1^-1. In front of camera 1 is what has n' K1^-1 (x, y, 1)' > 0. */
static void complete_planes(asj_model *m, const double k1[9])
{
    for (int32_t p = 0; p < m->view.plane_count; p++) {
        double normal[9];
        for (int32_t k = 0; k < 9; k++)
            normal[k] = m->rotation[k] + m->translation[k / 3] * m->planes[p][k % 3];
        asj_pixel_homography(normal, m->cameras, m->view.planes[p]);
        asj_apply3_transposed(k1, m->planes[p], m->view.in_front[p]);
        m->view.thickness[p] = m->thick ? 1 : thickness_of(m->planes[p], &m->cameras[1]);
    }
}

static int32_t complete_essential(asj_model *m)
{
    const asj_camera *c2 = &m->cameras[1];
    double skew[9], essential[9], k1[9];
    if (!asj_normalise3(m->translation))
        return 0;
    asj_skew3(m->translation, skew);
    asj_multiply3(skew, m->rotation, essential);
    asj_fundamental_of(essential, m->cameras, m->view.matrix);
    inverse_of(&m->cameras[0], k1);
    asj_multiply3(m->rotation, k1, m->view.turned);
    memcpy(m->view.rotation, m->rotation, sizeof m->rotation);
    memcpy(m->view.translation, m->translation, sizeof m->translation);
    m->view.ray2[0] = 1 / c2->fx;
    m->view.ray2[1] = 1 / c2->fy;
    m->view.ray2[2] = c2->cx;
    m->view.ray2[3] = c2->cy;
    m->view.parallax2 = PARALLAX * PARALLAX;
    m->view.has_motion = 1;
    complete_planes(m, k1);
    return 1;
}

/* What a camera that only turns sees lies where K2 R K1^-1 puts it, as exactly as locations are known or, with view.plane_count 1,
 * mostly as exactly as on a plane without parallax. */
static void complete_turn(asj_model *m)
{
    static const double everywhere[3] = {0, 0, 1};
    asj_pixel_homography(m->rotation, m->cameras, m->view.matrix);
    memcpy(m->view.planes[0], m->view.matrix, sizeof m->view.matrix);
    memcpy(m->view.in_front[0], everywhere, sizeof everywhere);
    m->view.thickness[0] = THINNEST;
    memcpy(m->view.rotation, m->rotation, sizeof m->rotation);
    m->view.has_motion = 1;
}

int32_t asj_model_complete(asj_model *m)
{
    double inverse[9];
    if (asj_model_only_turns(m))
        complete_turn(m);
    if (m->kind == ASJ_GEOMETRY_HOMOGRAPHY) {
        m->view.planar = 1;
        return asj_invert3(m->view.matrix, inverse);
    }
    m->view.planar = 0;
    if (m->kind == ASJ_GEOMETRY_ESSENTIAL && !complete_essential(m))
        return 0;
    return unit_norm(m->view.matrix);
}

double asj_motions_apart(const asj_model *a, const asj_model *b)
{
    double turn[9];
    asj_multiply3_transposed(a->rotation, b->rotation, turn);
    return fmax(asj_rotation_angle(turn), acos(fmax(-1, fmin(1, asj_dot3(a->translation, b->translation)))));
}

void asj_translation_axes(const double t[3], double axis[3], double other[3])
{
    const double start[3] = {fabs(t[0]) < 0.6, fabs(t[0]) >= 0.6, 0};
    asj_cross3(t, start, axis);
    asj_normalise3(axis);
    asj_cross3(t, axis, other);
}

static int32_t move_essential(const asj_model *model, const double *delta, asj_model *moved)
{
    double turn[9], axis[3], other[3];
    const double *t = model->translation;
    asj_rotation_of(delta, turn);
    asj_multiply3(turn, model->rotation, moved->rotation);
    asj_translation_axes(t, axis, other);
    for (int32_t k = 0; k < 3; k++)
        moved->translation[k] = t[k] + delta[3] * axis[k] + delta[4] * other[k];
    for (int32_t k = 0; k < 3 * model->view.plane_count; k++)
        moved->planes[k / 3][k % 3] += delta[5 + k];
    return asj_model_complete(moved);
}

static int32_t move_fundamental(const asj_model *model, const double *delta, asj_model *moved)
{
    double e[9], u[9], s[3], v[9], turn[9], half[9];
    asj_essential_of(model->view.matrix, model->cameras, e);
    asj_svd3(e, u, s, v);
    if (!(s[1] > 1e-9 * s[0]))
        return 0;
    asj_rotation_of(delta, turn);
    asj_multiply3(u, turn, u);
    asj_rotation_of(delta + 3, turn);
    asj_multiply3(v, turn, v);
    const double ratio = s[1] / s[0] * exp(delta[6]);
    for (int32_t i = 0; i < 3; i++) {
        half[3 * i] = u[3 * i];
        half[3 * i + 1] = ratio * u[3 * i + 1];
        half[3 * i + 2] = 0;
    }
    asj_multiply3_transposed(half, v, e);
    asj_fundamental_of(e, model->cameras, moved->view.matrix);
    return asj_model_complete(moved);
}

static int32_t move_turn(const asj_model *model, const double *delta, asj_model *moved)
{
    double turn[9];
    asj_rotation_of(delta, turn);
    asj_multiply3(turn, model->rotation, moved->rotation);
    return asj_model_complete(moved);
}

static int32_t move_homography(const asj_model *model, const double *delta, asj_model *moved)
{
    double n[9];
    int32_t largest = 0, at = 0;
    asj_normal_homography(model->view.matrix, model->cameras, n);
    for (int32_t k = 1; k < 9; k++)
        if (fabs(n[k]) > fabs(n[largest]))
            largest = k;
    const double unit = n[largest];
    for (int32_t k = 0; k < 9; k++)
        n[k] = n[k] / unit + (k == largest ? 0 : delta[at++]);
    if (unit < 0) /* the sign says which side of the plane is seen */
        for (int32_t k = 0; k < 9; k++)
            n[k] = -n[k];
    asj_pixel_homography(n, model->cameras, moved->view.matrix);
    return asj_model_complete(moved);
}

int32_t asj_model_move(const asj_model *model, const double *delta, asj_model *moved)
{
    *moved = *model;
    if (model->kind == ASJ_GEOMETRY_ESSENTIAL)
        return move_essential(model, delta, moved);
    if (asj_model_only_turns(model))
        return move_turn(model, delta, moved);
    return model->kind == ASJ_GEOMETRY_FUNDAMENTAL ? move_fundamental(model, delta, moved) : move_homography(model, delta, moved);
}
