/* SPDX-License-Identifier: BSD-2-Clause */
/* A point p of image n is at T_n p = S_n p + c_n of the stretched image, S = diag(s_x, s_y), c = (S - 1) / 2 (1, 1). So
 *     points      S^-1 (q - c)
 *     affine maps x2 = A x1 + t   ->  S_2^-1 A S_1,  S_2^-1 (A c_1 + t - c_2)
 *     homography  H -> T_2^-1 H T_1;  fundamental matrix F -> T_2' F T_1 (Hartley and Zisserman, section 4.4 and 11.1)
 * and a rotation, a translation and their covariance are what they are: the stretch belongs to the camera's matrix. */
#include "unstretch.h"

#include <math.h>
#include <string.h>

static double back(double q, double s)
{
    return (q + 0.5) / s - 0.5;
}

static double forth(double p, double s)
{
    return s * (p + 0.5) - 0.5;
}

static void point_back(float *x, float *y, const asj_stretch *by)
{
    *x = (float)back((double)*x, by->x);
    *y = (float)back((double)*y, by->y);
}

static void map_back(double h[6], const asj_stretch by[2])
{
    const double c1[2] = {0.5 * (by[0].x - 1), 0.5 * (by[0].y - 1)}, c2[2] = {0.5 * (by[1].x - 1), 0.5 * (by[1].y - 1)};
    for (int32_t row = 0; row < 2; row++) {
        const double s2 = row ? by[1].y : by[1].x;
        double *a = h + 3 * row;
        a[2] = (a[0] * c1[0] + a[1] * c1[1] + a[2] - c2[row]) / s2;
        a[0] *= by[0].x / s2;
        a[1] *= by[0].y / s2;
    }
}

void asj_unstretch_matches(asj_junction_match *matches, size_t count, const asj_stretch by[2])
{
    for (size_t k = 0; k < count; k++) {
        asj_junction_match *m = &matches[k];
        map_back(m->affine, by);
        point_back(&m->x1, &m->y1, &by[0]);
        point_back(&m->ax1, &m->ay1, &by[0]);
        point_back(&m->bx1, &m->by1, &by[0]);
        point_back(&m->x2, &m->y2, &by[1]);
        point_back(&m->ax2, &m->ay2, &by[1]);
        point_back(&m->bx2, &m->by2, &by[1]);
    }
}

void asj_unstretch_l_junctions(asj_l_junction *list, uint32_t count, const asj_stretch *by)
{
    for (uint32_t k = 0; k < count; k++) {
        point_back(&list[k].x, &list[k].y, by);
        point_back(&list[k].ax, &list[k].ay, by);
        point_back(&list[k].bx, &list[k].by, by);
    }
}

void asj_stretch_candidate(asj_geometry_candidate *g, const asj_stretch by[2])
{
    g->x1 = forth(g->x1, by[0].x);
    g->y1 = forth(g->y1, by[0].y);
    g->x2 = forth(g->x2, by[1].x);
    g->y2 = forth(g->y2, by[1].y);
    for (int32_t k = 0; k < 4; k++) /* rows: along x, along y */
        g->affine[k] *= (k < 2 ? by[1].x : by[1].y) / (k % 2 == 0 ? by[0].x : by[0].y);
}

/* m T: T = [s_x 0 c_x; 0 s_y c_y; 0 0 1] */
static void times_stretch(double m[9], const asj_stretch *by)
{
    for (int32_t row = 0; row < 3; row++) {
        double *a = m + 3 * row;
        a[2] += a[0] * 0.5 * (by->x - 1) + a[1] * 0.5 * (by->y - 1);
        a[0] *= by->x;
        a[1] *= by->y;
    }
}

/* T^-1 m for a homography, T' m for a fundamental matrix. */
static void from_the_left(double m[9], const asj_stretch *by, int32_t homography)
{
    const double s[2] = {by->x, by->y}, c[2] = {0.5 * (by->x - 1), 0.5 * (by->y - 1)};
    for (int32_t column = 0; column < 3; column++) {
        double *a = m + column;
        if (!homography)
            a[6] += c[0] * a[0] + c[1] * a[3];
        for (int32_t row = 0; row < 2; row++)
            a[3 * row] = homography ? (a[3 * row] - c[row] * a[6]) / s[row] : a[3 * row] * s[row];
    }
}

static void unstretch_matrix(double m[9], const asj_stretch by[2], int32_t homography)
{
    double norm = 0;
    times_stretch(m, &by[0]);
    from_the_left(m, &by[1], homography);
    for (int32_t k = 0; k < 9; k++)
        norm += m[k] * m[k];
    for (int32_t k = 0; k < 9 && norm > 0; k++)
        m[k] /= sqrt(norm);
}

void asj_unstretch_fundamental(double matrix[9], const asj_stretch by[2])
{
    unstretch_matrix(matrix, by, 0);
}

static void unstretch_camera(asj_camera *c, const asj_stretch *by)
{
    *c = (asj_camera){c->fx / by->x, c->fy / by->y, (c->cx + 0.5) / by->x - 0.5, (c->cy + 0.5) / by->y - 0.5};
}

void asj_unstretch_geometry(asj_geometry *geometry, const asj_stretch by[2])
{
    unstretch_matrix(geometry->matrix, by, geometry->model == ASJ_GEOMETRY_HOMOGRAPHY);
    for (int32_t v = 0; v < 2; v++)
        if (geometry->cameras[v].fx > 0)
            unstretch_camera(&geometry->cameras[v], &by[v]);
}

asj_camera asj_stretch_camera(const asj_camera *camera, const asj_stretch *by)
{
    return (asj_camera){camera->fx * by->x, camera->fy * by->y, (camera->cx + 0.5) * by->x - 0.5, (camera->cy + 0.5) * by->y - 0.5};
}
