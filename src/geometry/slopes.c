/* SPDX-License-Identifier: BSD-2-Clause */
/* Derivatives, in two steps: of a model's matrices along its parameters (model.c says how they move), and of the residuals
 * (likelihood.c) along a change M' of the matrix. A factor of the matrix changes no residual.
 *
 * essential       E' = [t']x R + [t]x R',  R' = [e]x R for a turn about e, t' an axis at right angles to t
 * its planes      N' = R' + t' n' + t n'',  H' = K2 N' K1^-1
 * fundamental     E = U diag(1, s, 0) V':  U' = U [e]x, V' = V [e]x, s' = s
 * homography      an entry of K2^-1 H K1, times the largest one; of a camera that only turns R' = [e]x R
 *
 * Epipolar residuals depend on e = x2' F x1, n2 and n1, which are linear in F, and on m = A' n2:
 *
 *     (e / |n|)' = (e' - e (n n') / n^2) / |n|                 n: n1 or n2, the shorter one
 *     with c = m x n1, d = -m n1, tan of the angle c / d:  (c / sqrt(m^2 n1^2))'
 *     (log |m| - log |n1|)' = m m' / m^2 - n1 n1' / n1^2
 *
 * Planar ones on the place p = (h1 x1, h2 x1) / w, w = h3 x1, and on its derivative J (J_ik = (h_ik - p_i h_3k) / w):
 *
 *     p' = (h1' x1 - px w', h2' x1 - py w') / w,   J_ik' = (h_ik' - p_i' h_3k - p_i h_3k') / w - J_ik w' / w,
 *     B = J^-1 A:  B' = -(J^-1 J') B,   (1/2 log det B)' = -1/2 trace(J^-1 J'). */
#include "slopes.h"
#include "small_matrix.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* --- of a model -------------------------------------------------------------------------------------------------------------- */

/* The turn number k: [e_k]x R. */
static void turned(const double rotation[9], int32_t k, double out[9])
{
    double e[3] = {0, 0, 0}, skew[9];
    e[k] = 1;
    asj_skew3(e, skew);
    asj_multiply3(skew, rotation, out);
}

static double norm_of(const double m[9])
{
    double sum = 0;
    for (int32_t k = 0; k < 9; k++)
        sum += m[k] * m[k];
    return sqrt(sum);
}

static int32_t slopes_of_essential(const asj_model *m, asj_model_slopes *s)
{
    double skew[9], e[9], f[9], axes[2][3];
    asj_skew3(m->translation, skew);
    asj_multiply3(skew, m->rotation, e);
    asj_pixel_fundamental(e, m->cameras, f);
    const double size = norm_of(f);
    asj_translation_axes(m->translation, axes[0], axes[1]);
    for (int32_t p = 0; p < 5; p++) {
        double turn[9] = {0}, moving[9];
        if (p < 3) {
            turned(m->rotation, p, turn);
            asj_multiply3(skew, turn, moving);
        } else {
            asj_skew3(axes[p - 3], moving);
            asj_multiply3(moving, m->rotation, moving);
        }
        asj_pixel_fundamental(moving, m->cameras, s->along[0][p]);
        for (int32_t k = 0; k < 9; k++)
            s->along[0][p][k] /= size;
        for (int32_t n = 0; n < m->view.plane_count; n++) {
            for (ptrdiff_t k = 0; k < 9; k++)
                moving[k] = p < 3 ? turn[k] : axes[p - 3][k / 3] * m->planes[n][k % 3];
            asj_pixel_homography(moving, m->cameras, s->along[1 + n][p]);
        }
    }
    for (int32_t n = 0; n < m->view.plane_count; n++)
        for (int32_t i = 0; i < 3; i++) {
            double moving[9] = {0};
            for (int32_t k = 0; k < 3; k++)
                moving[3 * k + i] = m->translation[k];
            asj_pixel_homography(moving, m->cameras, s->along[1 + n][5 + i]);
        }
    for (int32_t n = 0; n <= m->view.plane_count; n++) {
        s->count[n] = n == 0 ? 5 : 8;
        for (int32_t p = 0; p < s->count[n]; p++)
            s->parameter[n][p] = p < 5 ? p : 5 + 3 * (n - 1) + p - 5;
    }
    return size > 0;
}

/* U diag(1, s, 0) V' for matrices near rotations. */
static void compose(const double u[9], const double diagonal[2], const double v[9], double out[9])
{
    for (ptrdiff_t i = 0; i < 9; i++)
        out[i] = diagonal[0] * u[i / 3 * 3] * v[i % 3 * 3] + diagonal[1] * u[i / 3 * 3 + 1] * v[i % 3 * 3 + 1];
}

static int32_t slopes_of_fundamental(const asj_model *m, asj_model_slopes *s)
{
    double e[9], u[9], v[9], values[3], f[9];
    asj_essential_of(m->view.matrix, m->cameras, e);
    asj_svd3(e, u, values, v);
    if (!(values[1] > 1e-9 * values[0]))
        return 0;
    asj_pixel_fundamental(e, m->cameras, f);
    const double factor = values[0] / norm_of(f), diagonal[2] = {1, values[1] / values[0]}, grown[2] = {0, diagonal[1]};
    s->count[0] = 7;
    for (int32_t p = 0; p < 7; p++) {
        double axis[3] = {0, 0, 0}, skew[9], moved[9];
        if (p < 6) {
            axis[p % 3] = 1;
            asj_skew3(axis, skew);
            asj_multiply3(p < 3 ? u : v, skew, moved);
        }
        compose(p < 3 ? moved : u, p < 6 ? diagonal : grown, p >= 3 && p < 6 ? moved : v, e);
        asj_pixel_fundamental(e, m->cameras, s->along[0][p]);
        for (int32_t k = 0; k < 9; k++)
            s->along[0][p][k] *= factor;
        s->parameter[0][p] = p;
    }
    return 1;
}

static int32_t slopes_of_homography(const asj_model *m, asj_model_slopes *s)
{
    double n[9];
    int32_t largest = 0, at = 0;
    asj_normal_homography(m->view.matrix, m->cameras, n);
    for (int32_t k = 1; k < 9; k++)
        if (fabs(n[k]) > fabs(n[largest]))
            largest = k;
    for (int32_t k = 0; k < 9; k++) {
        double moving[9] = {0};
        if (k == largest)
            continue;
        moving[k] = n[largest];
        s->parameter[0][at] = at;
        asj_pixel_homography(moving, m->cameras, s->along[0][at++]);
    }
    s->count[0] = 8;
    return n[largest] != 0;
}

/* All parts obey the same homography. */
static int32_t slopes_of_turn(const asj_model *m, asj_model_slopes *s)
{
    for (int32_t part = 0; part <= m->view.plane_count; part++) {
        s->count[part] = 3;
        for (int32_t p = 0; p < 3; p++) {
            double moving[9];
            turned(m->rotation, p, moving);
            s->parameter[part][p] = p;
            asj_pixel_homography(moving, m->cameras, s->along[part][p]);
        }
    }
    return 1;
}

int32_t asj_model_slopes_of(const asj_model *model, asj_model_slopes *slopes)
{
    if (model->kind == ASJ_GEOMETRY_ESSENTIAL)
        return slopes_of_essential(model, slopes);
    if (asj_model_only_turns(model))
        return slopes_of_turn(model, slopes);
    return model->kind == ASJ_GEOMETRY_FUNDAMENTAL ? slopes_of_fundamental(model, slopes) : slopes_of_homography(model, slopes);
}

/* --- of residuals ------------------------------------------------------------------------------------------------------------ */

static void epipolar_slopes(const double f[9], const asj_pairs *set, const asj_pair *c, int32_t count, const double (*along)[9],
                            double slope[ASJ_PART_PARAMETERS][6])
{
    const double x1 = c->x1, y1 = c->y1, x2 = c->x2, y2 = c->y2, *a = c->affine, sd = set->location_sd;
    const double n2x = f[0] * x1 + f[1] * y1 + f[2], n2y = f[3] * x1 + f[4] * y1 + f[5];
    const double n1x = f[0] * x2 + f[3] * y2 + f[6], n1y = f[1] * x2 + f[4] * y2 + f[7];
    const double e = x2 * n2x + y2 * n2y + f[6] * x1 + f[7] * y1 + f[8];
    const double s1 = n1x * n1x + n1y * n1y, s2 = n2x * n2x + n2y * n2y;
    const double mx = a[0] * n2x + a[2] * n2y, my = a[1] * n2x + a[3] * n2y, s = mx * mx + my * my;
    const int32_t first = s1 < s2;
    const double least = first ? s1 : s2, cross = my * n1x - mx * n1y, over_s = 1 / s, over_s1 = 1 / s1, over_s2 = 1 / s2;
    const double root = 1 / (sqrt(least) * sd), product = 1 / (sqrt(s * s1) * set->angle_sd), over_scale = 1 / set->scale_sd;
    for (int32_t p = 0; p < count; p++) {
        const double *d = along[p];
        const double d2x = d[0] * x1 + d[1] * y1 + d[2], d2y = d[3] * x1 + d[4] * y1 + d[5];
        const double d1x = d[0] * x2 + d[3] * y2 + d[6], d1y = d[1] * x2 + d[4] * y2 + d[7];
        const double de = x2 * d2x + y2 * d2y + d[6] * x1 + d[7] * y1 + d[8];
        const double ex = a[0] * d2x + a[2] * d2y, ey = a[1] * d2x + a[3] * d2y;
        const double log_m = (mx * ex + my * ey) * over_s, log_n1 = (n1x * d1x + n1y * d1y) * over_s1;
        const double log_n = first ? log_n1 : (n2x * d2x + n2y * d2y) * over_s2;
        slope[p][0] = (de - e * log_n) * root;
        slope[p][1] = (ey * n1x + my * d1x - ex * n1y - mx * d1y - cross * (log_m + log_n1)) * product;
        slope[p][2] = (log_m - log_n1) * over_scale;
    }
}

static void planar_slopes(const double h[9], const asj_pairs *set, double sd, const asj_pair *c, const asj_residuals *at,
                          int32_t count, const double (*along)[9], double slope[ASJ_PART_PARAMETERS][6])
{
    const double x1 = c->x1, y1 = c->y1, *a = c->affine, w = 1 / (h[6] * x1 + h[7] * y1 + h[8]);
    const double x = (h[0] * x1 + h[1] * y1 + h[2]) * w, y = (h[3] * x1 + h[4] * y1 + h[5]) * w, dx = c->x2 - x, dy = c->y2 - y;
    const double j0 = (h[0] - x * h[6]) * w, j1 = (h[1] - x * h[7]) * w, j2 = (h[3] - y * h[6]) * w, j3 = (h[4] - y * h[7]) * w;
    const double inverse = 1 / (j0 * j3 - j1 * j2);
    const double b0 = (j3 * a[0] - j1 * a[2]) * inverse, b1 = (j3 * a[1] - j1 * a[3]) * inverse;
    const double b2 = (j0 * a[2] - j2 * a[0]) * inverse, b3 = (j0 * a[3] - j2 * a[1]) * inverse;
    const double scale = sqrt(b0 * b3 - b1 * b2), sine = b2 - b1, cosine = b0 + b3;
    const double ex = (j3 * dx - j1 * dy) * inverse, ey = (j0 * dy - j2 * dx) * inverse;
    const int32_t back = ex * ex + ey * ey > dx * dx + dy * dy;
    const double over_sd = 1 / sd, over_scale = 1 / set->scale_sd, over_shear = 0.5 / (scale * ASJ_SHEAR_SD);
    const double over_angle = 1 / ((sine * sine + cosine * cosine) * set->angle_sd);
    for (int32_t p = 0; p < count; p++) {
        const double *d = along[p], dw = (d[6] * x1 + d[7] * y1 + d[8]) * w;
        const double px = (d[0] * x1 + d[1] * y1 + d[2]) * w - x * dw, py = (d[3] * x1 + d[4] * y1 + d[5]) * w - y * dw;
        const double k0 = (d[0] - px * h[6] - x * d[6]) * w - j0 * dw, k1 = (d[1] - px * h[7] - x * d[7]) * w - j1 * dw;
        const double k2 = (d[3] - py * h[6] - y * d[6]) * w - j2 * dw, k3 = (d[4] - py * h[7] - y * d[7]) * w - j3 * dw;
        /* J^-1 J' */
        const double g0 = (j3 * k0 - j1 * k2) * inverse, g1 = (j3 * k1 - j1 * k3) * inverse;
        const double g2 = (j0 * k2 - j2 * k0) * inverse, g3 = (j0 * k3 - j2 * k1) * inverse, grow = -0.5 * (g0 + g3);
        const double q0 = -(g0 * b0 + g1 * b2), q1 = -(g0 * b1 + g1 * b3), q2 = -(g2 * b0 + g3 * b2), q3 = -(g2 * b1 + g3 * b3);
        slope[p][0] = (back ? -(j3 * px - j1 * py) * inverse - (g0 * ex + g1 * ey) : -px) * over_sd;
        slope[p][1] = (back ? -(j0 * py - j2 * px) * inverse - (g2 * ex + g3 * ey) : -py) * over_sd;
        slope[p][2] = (cosine * (q2 - q1) - sine * (q0 + q3)) * over_angle;
        slope[p][3] = grow * over_scale;
        slope[p][4] = (q0 - q3) * over_shear - at->value[4] * grow;
        slope[p][5] = (q1 + q2) * over_shear - at->value[5] * grow;
    }
}

int32_t asj_residual_slopes(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *pair,
                            const asj_model_slopes *slopes, asj_residuals *at, double slope[ASJ_PART_PARAMETERS][6])
{
    const double(*along)[9] = slopes->along[part];
    asj_part_residuals(view, part, set, pair, at);
    if (!isfinite(at->square))
        return 0;
    if (!asj_part_is_planar(view, part)) {
        epipolar_slopes(view->matrix, set, pair, slopes->count[part], along, slope);
        return 3;
    }
    const double *matrix = part > 0 ? view->planes[part - 1] : view->matrix;
    const double sd = asj_part_thickness(view, part) * set->location_sd; /* as if it stayed so */
    planar_slopes(matrix, set, sd, pair, at, slopes->count[part], along, slope);
    return 6;
}
