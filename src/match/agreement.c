/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, agreement of two candidates: two points of one scene, as far as their locations and affine maps tell.
 *
 * On one surface (asj_surface_agreement). A homography takes the line through both points to a line, by x -> a x / (1 + b x). Its
 * derivatives at the points are a and a / (1 + b x)^2, and the distance of the points is magnified by a / (1 + b x): by the
 * geometric mean. So with e1, e2 the ways from c to d in either image, both maps turn e1 into the direction of e2, and
 *
 *     p = sqrt(|A_c e1| |A_d e1|) x the direction between A_c e1 and A_d e1
 *
 * is e2 itself: maps of both ends make up for what perspective does to the map of one. With E the Frobenius norm,
 *
 *     r^2 = max over both images of [ |p - e2| / (3 px + neighbour_tolerance |e2|) ]^2
 *         + max over both directions of  |A_c - A_d|_E^2 / (map_tolerance^2 |A_c|_E |A_d|_E),
 *     w = (1 - r^2 / 5)^2 for r^2 < 5, else 0  (Tukey's biweight, about exp(-r^2 / 2), but it ends and needs no exponential).
 *
 * Along one edge. Where rooms are bare, corners are few, far from each other and on different surfaces; what joins them are the
 * edges between them. Two corners share an edge when a branch of either lies on the line through both, the same two branches in
 * both images, and together they cover the way but for `end_tolerance` of it. Then the geometric mean holds for the distance, and
 *
 *     r^2 = max over both images of the mean of [ distance from the line / 3 px ]^2 + [ log(|p| / |e2|) / map_tolerance ]^2.
 *
 * T-junctions do not count: where one thing hides another, they slide along edges when the viewpoint moves. */
#include "agreement.h"

#include <math.h>

static float biweight(double r2)
{
    const double w = r2 < ASJ_AGREEMENT_REACH ? 1 - r2 / ASJ_AGREEMENT_REACH : 0;
    return (float)(w * w);
}

asj_way asj_way_between(const asj_match_run *run, const asj_candidate *c, const asj_candidate *d)
{
    const asj_l_junction *c1 = asj_match_run_l(run, c, 0), *d1 = asj_match_run_l(run, d, 0);
    const asj_l_junction *c2 = asj_match_run_l(run, c, 1), *d2 = asj_match_run_l(run, d, 1);
    return (asj_way){(double)d1->x - (double)c1->x, (double)d1->y - (double)c1->y,
                     (double)d2->x - (double)c2->x, (double)d2->y - (double)c2->y};
}

/* --- on one surface --------------------------------------------------------------------------------------------------------- */

/* The square of how far a map may miss: one that misses by twice what both together may belongs to nothing near, whatever the other
 * one says. 4 REACH (PIXELS + tolerance |e|)^2 at most, without a root, since (a + b)^2 <= 2 (a^2 + b^2). */
static double most_square(double ex, double ey, double tolerance)
{
    const double pixels = ASJ_AGREEMENT_PIXELS;
    return 8.001 * ASJ_AGREEMENT_REACH * (pixels * pixels + tolerance * tolerance * (ex * ex + ey * ey));
}

/* [ |p - e| / allowed ]^2. (dx, dy) leads from c to d in the image that the maps start from, e in the other. */
static double misprediction(const double *map_c, const double *map_d, double dx, double dy, double ex, double ey, double tolerance)
{
    const double cx = map_c[0] * dx + map_c[1] * dy, cy = map_c[2] * dx + map_c[3] * dy;
    const double tx = map_d[0] * dx + map_d[1] * dy, ty = map_d[2] * dx + map_d[3] * dy;
    const double most = most_square(ex, ey, tolerance);
    if ((cx - ex) * (cx - ex) + (cy - ey) * (cy - ey) > most || (tx - ex) * (tx - ex) + (ty - ey) * (ty - ey) > most)
        return ASJ_AGREEMENT_REACH;
    const double c = sqrt(cx * cx + cy * cy), t = sqrt(tx * tx + ty * ty);
    const double allowed = ASJ_AGREEMENT_PIXELS + tolerance * sqrt(ex * ex + ey * ey);
    const double sx = cx * t + tx * c, sy = cy * t + ty * c, s = sqrt(sx * sx + sy * sy);
    const double scale = s > 0 ? sqrt(c * t) / s : 0, px = sx * scale - ex, py = sy * scale - ey;
    return (px * px + py * py) / (allowed * allowed);
}

static double unlikeness(const double *a, const double *b)
{
    double difference = 0, size_a = 0, size_b = 0;
    for (int i = 0; i < 4; i++) {
        difference += (a[i] - b[i]) * (a[i] - b[i]);
        size_a += a[i] * a[i];
        size_b += b[i] * b[i];
    }
    return difference / sqrt(size_a * size_b);
}

/* Two corners of one image on one location of the other. */
static int32_t together(const asj_way *way)
{
    return way->x1 * way->x1 + way->y1 * way->y1 < 1 || way->x2 * way->x2 + way->y2 * way->y2 < 1;
}

float asj_surface_agreement(const asj_match_options *options, const asj_candidate *c, const asj_candidate *d, const asj_way *way)
{
    if (together(way))
        return 0;
    const double there = misprediction(c->map.to, d->map.to, way->x1, way->y1, way->x2, way->y2, options->neighbour_tolerance);
    if (there >= ASJ_AGREEMENT_REACH)
        return 0;
    const double back = misprediction(c->map.from, d->map.from, way->x2, way->y2, way->x1, way->y1, options->neighbour_tolerance);
    const double to = unlikeness(c->map.to, d->map.to), from = unlikeness(c->map.from, d->map.from);
    return biweight((there > back ? there : back) + (to > from ? to : from) / (options->map_tolerance * options->map_tolerance));
}

/* --- along one edge --------------------------------------------------------------------------------------------------------- */

/* [ distance of the way's end from the branch's line / 3 px ]^2; *ahead: does the branch lead towards it? */
static double off_line(const double u[2], double ex, double ey, int32_t *ahead)
{
    const double across = (u[0] * ey - u[1] * ex) / ASJ_AGREEMENT_PIXELS;
    *ahead = u[0] * ex + u[1] * ey > 0;
    return across * across;
}

/* A branch of an L-junction: 0 = a, 1 = b. */
typedef struct branch {
    const double *u; /* unit vector */
    double length;
} branch;

static branch branch_of(const asj_l_junctions *l_junctions, uint32_t l, uint32_t which)
{
    return (branch){l_junctions->direction + 4 * (size_t)l + 2 * which,
                    (double)l_junctions->lengths[2 * (size_t)l + which].length[0]};
}

/* r^2 of two branches in one image, as much as ends agreement when they do not share an edge: s, and t of a location that lies
 * (ex, ey) away. *sides tells which way they lead. */
static double shared(branch s, branch t, double ex, double ey, double tolerance, int32_t *sides)
{
    int32_t ahead, onwards;
    const double off_s = off_line(s.u, ex, ey, &ahead), off_t = off_line(t.u, ex, ey, &onwards);
    const double covered = (ahead ? s.length : 0) + (onwards ? 0 : t.length);
    *sides = 2 * ahead + onwards;
    return covered >= (1 - tolerance) * sqrt(ex * ex + ey * ey) ? 0.5 * (off_s + off_t) : ASJ_AGREEMENT_REACH;
}

/* The least r^2 of branches that the corners may share in both images; both lead the same way in either. */
static double least_off_edge(const asj_match_run *run, const asj_candidate *c, const asj_candidate *d, const asj_way *e)
{
    const asj_l_junctions *in1 = &run->image[0]->l_junctions, *in2 = &run->image[1]->l_junctions;
    const double tolerance = run->options->end_tolerance;
    double least = ASJ_AGREEMENT_REACH;
    for (uint32_t s = 0; s < 2; s++)
        for (uint32_t t = 0; t < 2; t++) {
            int32_t sides1, sides2 = -1;
            const double r1 = shared(branch_of(in1, c->i, s), branch_of(in1, d->i, t), e->x1, e->y1, tolerance, &sides1);
            const double r2 = r1 >= least ? ASJ_AGREEMENT_REACH
                : shared(branch_of(in2, c->j, s), branch_of(in2, d->j, t), e->x2, e->y2, tolerance, &sides2);
            const double larger = r1 > r2 ? r1 : r2;
            least = larger < least && sides1 == sides2 ? larger : least;
        }
    return least;
}

float asj_edge_agreement(const asj_match_run *run, const asj_candidate *c, const asj_candidate *d, const asj_way *e)
{
    const uint8_t *t1 = run->image[0]->l_junctions.t_junction, *t2 = run->image[1]->l_junctions.t_junction;
    const double square1 = e->x1 * e->x1 + e->y1 * e->y1, square2 = e->x2 * e->x2 + e->y2 * e->y2;
    const double least_square = ASJ_AGREEMENT_LEAST_WAY * ASJ_AGREEMENT_LEAST_WAY;
    if (square1 < least_square || square2 < least_square || t1[c->i] || t1[d->i] || t2[c->j] || t2[d->j])
        return 0;
    const double least = least_off_edge(run, c, d, e);
    if (least >= ASJ_AGREEMENT_REACH)
        return 0;
    const double cx = c->map.to[0] * e->x1 + c->map.to[1] * e->y1, cy = c->map.to[2] * e->x1 + c->map.to[3] * e->y1;
    const double dx = d->map.to[0] * e->x1 + d->map.to[1] * e->y1, dy = d->map.to[2] * e->x1 + d->map.to[3] * e->y1;
    const double power = (cx * cx + cy * cy) * (dx * dx + dy * dy) / (square2 * square2); /* (|p| / |e2|)^4 */
    if (!(power > 0))
        return 0;
    const double unequal = 0.25 * log(power) / run->options->map_tolerance;
    return biweight(least + unequal * unequal);
}
