/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, agreement of two candidates: two points of one scene, as far as their places and affine maps tell.
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

#define LEAST_WAY 10.0 /* px: nearer corners say nothing of an edge's direction; as LEAST_START of corners.c */

static float biweight(double r2)
{
    const double w = r2 < ASJ_AGREEMENT_REACH ? 1 - r2 / ASJ_AGREEMENT_REACH : 0;
    return (float)(w * w);
}

asj_way asj_way_between(const asj_view *view1, const asj_view *view2, const asj_candidate *c, const asj_candidate *d)
{
    const asj_l_junction *c1 = &view1->corners.l[c->i], *d1 = &view1->corners.l[d->i];
    const asj_l_junction *c2 = &view2->corners.l[c->j], *d2 = &view2->corners.l[d->j];
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

/* Two corners of one image on one place of the other. */
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

/* r^2 of the two branches in one image, as much as ends agreement when they do not share an edge: s of `from` and t of `to`, which
 * lies (ex, ey) away. *sides tells which way they lead. */
static double shared(const asj_corners *corners, uint32_t from, uint32_t s, uint32_t to, uint32_t t, double ex, double ey,
                     double tolerance, int32_t *sides)
{
    int32_t ahead, onwards;
    const double off_s = off_line(corners->direction + 4 * (size_t)from + 2 * s, ex, ey, &ahead);
    const double off_t = off_line(corners->direction + 4 * (size_t)to + 2 * t, ex, ey, &onwards);
    const double covered = (ahead ? (double)corners->lengths[2 * (size_t)from + s].length[0] : 0) +
                           (onwards ? 0 : (double)corners->lengths[2 * (size_t)to + t].length[0]);
    *sides = 2 * ahead + onwards;
    return covered >= (1 - tolerance) * sqrt(ex * ex + ey * ey) ? 0.5 * (off_s + off_t) : ASJ_AGREEMENT_REACH;
}

float asj_edge_agreement(const asj_match_options *options, const asj_corners *k1, const asj_corners *k2, const asj_candidate *c,
                         const asj_candidate *d, const asj_way *e)
{
    const double square1 = e->x1 * e->x1 + e->y1 * e->y1, square2 = e->x2 * e->x2 + e->y2 * e->y2;
    double least = ASJ_AGREEMENT_REACH;
    if (square1 < LEAST_WAY * LEAST_WAY || square2 < LEAST_WAY * LEAST_WAY || k1->stem[c->i] || k1->stem[d->i] || k2->stem[c->j] ||
        k2->stem[d->j])
        return 0;
    for (uint32_t s = 0; s < 2; s++)
        for (uint32_t t = 0; t < 2; t++) {
            int32_t sides1, sides2 = -1;
            const double r1 = shared(k1, c->i, s, d->i, t, e->x1, e->y1, options->end_tolerance, &sides1);
            const double r2 = r1 < least ? shared(k2, c->j, s, d->j, t, e->x2, e->y2, options->end_tolerance, &sides2)
                                         : ASJ_AGREEMENT_REACH;
            const double larger = r1 > r2 ? r1 : r2;
            least = larger < least && sides1 == sides2 ? larger : least;
        }
    if (least >= ASJ_AGREEMENT_REACH)
        return 0;
    const double cx = c->map.to[0] * e->x1 + c->map.to[1] * e->y1, cy = c->map.to[2] * e->x1 + c->map.to[3] * e->y1;
    const double dx = d->map.to[0] * e->x1 + d->map.to[1] * e->y1, dy = d->map.to[2] * e->x1 + d->map.to[3] * e->y1;
    const double power = (cx * cx + cy * cy) * (dx * dx + dy * dy) / (square2 * square2); /* (|p| / |e2|)^4 */
    if (!(power > 0))
        return 0;
    const double unequal = 0.25 * log(power) / options->map_tolerance;
    return biweight(least + unequal * unequal);
}

/* --- first looks at many ---------------------------------------------------------------------------------------------------- */

uint64_t asj_look_at(const asj_look *look, const asj_spots *spots, uint32_t first, uint32_t count)
{
    uint64_t seen = 0;
    for (uint32_t n = 0; n < count; n++) {
        const uint32_t m = first + n;
        const float ex = spots->x[m] - look->x, ey = spots->y[m] - look->y;
        const float most = (float)ASJ_LOOK_MOST + look->slope * (ex * ex + ey * ey);
        const float cx = look->px - ex, cy = look->py - ey;
        const float dx = spots->map[0][m] * look->way_x + spots->map[1][m] * look->way_y - ex;
        const float dy = spots->map[2][m] * look->way_x + spots->map[3][m] * look->way_y - ey;
        int32_t may = cx * cx + cy * cy <= most && dx * dx + dy * dy <= most;
        for (uint32_t t = 0; t < 2; t++)
            if (look->edges >> t & 1)
                may |= fabsf(look->branch[t][0] * ey - look->branch[t][1] * ex) <= (float)ASJ_LOOK_ACROSS;
        seen |= (uint64_t)may << n;
    }
    return seen;
}

uint32_t asj_edges_through(const asj_corners *corners, uint32_t l, uint32_t among, double ex, double ey)
{
    const double *u = corners->direction + 4 * (size_t)l;
    if (among == 0 || corners->stem[l])
        return 0;
    const uint32_t a = fabs(u[0] * ey - u[1] * ex) <= ASJ_LOOK_ACROSS, b = fabs(u[2] * ey - u[3] * ex) <= ASJ_LOOK_ACROSS;
    return among & (a | b << 1);
}

const asj_agreement_ops asj_agreement_reference = {.look_at = asj_look_at};
