/* SPDX-License-Identifier: BSD-2-Clause */
/* Most candidates are far from a geometry, and a hypothesis is judged by thousands of them, so the first look is made in single
 * precision, on coordinates side by side, in loops without a branch, which compilers turn into vectors, and in image 2 alone. Those
 * that may be near are looked at exactly, here or where likelihoods are taken.
 *
 * Coordinates are taken from the images' middles. A sum of products in floats is out by less than ROUNDING times the sum of the
 * largest products; call that b for e, the distance times the length n of its normal, and c for each entry of the normal. What is
 * nearer than d = sqrt(limit) has |e| <= b + d (n + 2 c) as computed, and since (x + y)^2 <= (1 + t) x^2 + (1 + 1/t) y^2,
 *
 *     e^2 <= (1 + t)^2 d^2 n^2 + (1 + 1/t) (b^2 + (1 + t) d^2 4 c^2),    t = SLACK:
 *
 * rounding lets too many through, never too few. That is an operation (core/ops.h); here is its reference. */
#include "near.h"

#include <math.h>
#include <stddef.h>

#define ROUNDING 1e-6 /* 8 roundings of 2^-24 and as much again */
#define SLACK 1e-3
#define BLOCK 128   /* candidates, */
#define AT_ONCE 8   /* of which so many are passed over at once: divides BLOCK */

int32_t asj_near_prepare(asj_memory *memory, const asj_near_ops *ops, asj_pairs *set)
{
    const size_t count = (size_t)set->count;
    set->near = ops;
    set->at = asj_allocate_zero(memory, 4 * count + ASJ_NEAR_PADDING, sizeof *set->at);
    for (size_t k = 0; set->at && k < count; k++) {
        const asj_pair *c = &set->list[k];
        const double from_middle[4] = {c->x1 - set->middle[0][0], c->y1 - set->middle[0][1], c->x2 - set->middle[1][0],
                                       c->y2 - set->middle[1][1]};
        for (size_t n = 0; n < 4; n++) {
            set->at[n * count + k] = (float)from_middle[n];
            set->farthest[n] = fmax(set->farthest[n], fabs(from_middle[n]));
        }
    }
    return set->at != NULL;
}

/* The matrix for coordinates from the middles. */
static void move_matrix(const asj_pairs *set, const asj_two_view *view, double m[9])
{
    const double *a = set->middle[0], *b = set->middle[1];
    for (ptrdiff_t i = 0; i < 3; i++) { /* x1 = x + a */
        const double *r = view->matrix + 3 * i;
        m[3 * i] = r[0];
        m[3 * i + 1] = r[1];
        m[3 * i + 2] = r[0] * a[0] + r[1] * a[1] + r[2];
    }
    for (ptrdiff_t k = 0; k < 3; k++) { /* x2 = x + b: x2 (b) of a homography, or x2' F */
        if (view->planar) {
            m[k] -= b[0] * m[6 + k];
            m[3 + k] -= b[1] * m[6 + k];
        } else {
            m[6 + k] += b[0] * m[k] + b[1] * m[3 + k];
        }
    }
}

static double bound_of(const double row[3], double x, double y)
{
    return fabs(row[0]) * x + fabs(row[1]) * y + fabs(row[2]);
}

/* The largest products of the distance and of its normal: b and c are ROUNDING times these. */
typedef struct largest {
    double compared, normal;
} largest;

static largest largest_of(const asj_pairs *set, const asj_two_view *view, const double m[9])
{
    const double *far = set->farthest;
    double row[3];
    for (ptrdiff_t k = 0; k < 3; k++)
        row[k] = bound_of(m + 3 * k, far[0], far[1]);
    if (view->planar) /* both coordinates */
        return (largest){row[0] + far[2] * row[2] + row[1] + far[3] * row[2], row[2]};
    const double columns[2] = {fabs(m[0]) * far[2] + fabs(m[3]) * far[3] + fabs(m[6]),
                               fabs(m[1]) * far[2] + fabs(m[4]) * far[3] + fabs(m[7])};
    return (largest){row[0] * far[2] + row[1] * far[3] + row[2], fmax(fmax(row[0], row[1]), fmax(columns[0], columns[1]))};
}

static asj_near_plan plan_of(const asj_pairs *set, const asj_two_view *view, double limit)
{
    double m[9];
    asj_near_plan p;
    move_matrix(set, view, m);
    const largest l = largest_of(set, view, m);
    const double b = ROUNDING * l.compared, c = ROUNDING * l.normal;
    for (ptrdiff_t k = 0; k < 9; k++)
        p.m[k] = (float)m[k];
    p.factor = (float)((1 + SLACK) * (1 + SLACK) * limit);
    p.extra = (float)((1 + 1 / SLACK) * (b * b + (1 + SLACK) * limit * 4 * c * c));
    return p;
}

static void near_lines(const asj_near_plan *p, const float *x1, const float *y1, const float *x2, const float *y2, int32_t count,
                       int32_t *near)
{
    const float m0 = p->m[0], m1 = p->m[1], m2 = p->m[2], m3 = p->m[3], m4 = p->m[4], m5 = p->m[5], m6 = p->m[6], m7 = p->m[7];
    const float m8 = p->m[8], factor = p->factor, extra = p->extra;
    for (int32_t k = 0; k < count; k++) {
        const float n2x = m0 * x1[k] + m1 * y1[k] + m2, n2y = m3 * x1[k] + m4 * y1[k] + m5, n2z = m6 * x1[k] + m7 * y1[k] + m8;
        const float e = x2[k] * n2x + y2[k] * n2y + n2z;
        near[k] = e * e <= factor * (n2x * n2x + n2y * n2y) + extra;
    }
}

static void near_places(const asj_near_plan *p, const float *x1, const float *y1, const float *x2, const float *y2, int32_t count,
                        int32_t *near)
{
    const float m0 = p->m[0], m1 = p->m[1], m2 = p->m[2], m3 = p->m[3], m4 = p->m[4], m5 = p->m[5], m6 = p->m[6], m7 = p->m[7];
    const float m8 = p->m[8], factor = p->factor, extra = p->extra;
    for (int32_t k = 0; k < count; k++) {
        const float w = m6 * x1[k] + m7 * y1[k] + m8;
        const float dx = x2[k] * w - (m0 * x1[k] + m1 * y1[k] + m2), dy = y2[k] * w - (m3 * x1[k] + m4 * y1[k] + m5);
        near[k] = dx * dx + dy * dy <= factor * (w * w) + extra;
    }
}

typedef void (*loop)(const asj_near_plan *p, const float *x1, const float *y1, const float *x2, const float *y2, int32_t count,
                     int32_t *near);

static int32_t list(loop of_some, const asj_near_plan *p, const float *const at[4], int32_t count, uint32_t *near)
{
    int32_t found = 0, is_near[BLOCK];
    for (int32_t first = 0; first < count; first += BLOCK) {
        const int32_t some = count - first < BLOCK ? count - first : BLOCK;
        of_some(p, at[0] + first, at[1] + first, at[2] + first, at[3] + first, some, is_near);
        for (int32_t k = some; k % AT_ONCE != 0; k++)
            is_near[k] = 0;
        for (int32_t group = 0; group < some; group += AT_ONCE) {
            int32_t any = 0; /* mostly none */
            for (int32_t k = group; k < group + AT_ONCE; k++)
                any |= is_near[k];
            for (int32_t k = group; any && k < group + AT_ONCE; k++)
                if (is_near[k])
                    near[found++] = (uint32_t)(first + k);
        }
    }
    return found;
}

static int32_t list_near_lines(const asj_near_plan *plan, const float *const at[4], int32_t count, uint32_t *near)
{
    return list(near_lines, plan, at, count, near);
}

static int32_t list_near_places(const asj_near_plan *plan, const float *const at[4], int32_t count, uint32_t *near)
{
    return list(near_places, plan, at, count, near);
}

const asj_near_ops asj_near_reference = {.lines = list_near_lines, .places = list_near_places};

/* Exactly. Likelihoods ask the same of what has no planes (likelihood.c), but what lies on a plane must also be near its line. */
static inline int32_t is_far(const asj_two_view *view, const asj_pair *c, double limit)
{
    const double *f = view->matrix;
    const double n2x = f[0] * c->x1 + f[1] * c->y1 + f[2], n2y = f[3] * c->x1 + f[4] * c->y1 + f[5];
    const double n2z = f[6] * c->x1 + f[7] * c->y1 + f[8];
    const double n1x = f[0] * c->x2 + f[3] * c->y2 + f[6], n1y = f[1] * c->x2 + f[4] * c->y2 + f[7];
    const double e = c->x2 * n2x + c->y2 * n2y + n2z, e2 = e * e;
    return e2 > limit * (n1x * n1x + n1y * n1y) || e2 > limit * (n2x * n2x + n2y * n2y);
}

int32_t asj_near(const asj_pairs *set, int32_t count, const asj_two_view *view, double limit, uint32_t *near)
{
    const asj_near_plan p = plan_of(set, view, limit);
    const float *at[4];
    for (ptrdiff_t n = 0; n < 4; n++)
        at[n] = set->at + n * set->count;
    const int32_t found = (view->planar ? set->near->places : set->near->lines)(&p, at, count, near);
    if (view->planar || view->plane_count == 0)
        return found;
    int32_t kept = 0;
    for (int32_t n = 0; n < found; n++)
        if (!is_far(view, &set->list[near[n]], limit))
            near[kept++] = near[n];
    return kept;
}
