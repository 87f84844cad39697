/* SPDX-License-Identifier: BSD-2-Clause */
/* Do two candidates show two points of one scene? */
#ifndef ASJ_SRC_AGREEMENT_H
#define ASJ_SRC_AGREEMENT_H

#include "distance.h"

#define ASJ_AGREEMENT_PIXELS 3.0 /* px, error allowed anywhere: location errors of two junctions and their map; as in corners.c */
#define ASJ_AGREEMENT_REACH 5.0  /* r^2 at which agreement ends: where exp(-r^2 / 2) is below a tenth */

/* Of points on one surface, and of corners on one edge: 0 .. 1, symmetric in the candidates. */
float asj_surface_agreement(const asj_match_options *options, const asj_view *view1, const asj_view *view2, const asj_candidate *c,
                            const asj_candidate *d);
float asj_edge_agreement(const asj_match_options *options, const asj_view *view1, const asj_view *view2, const asj_candidate *c,
                         const asj_candidate *d);

/* --- first looks at many ---------------------------------------------------------------------------------------------------- */

/* From c to d in image 1 and in image 2, px. */
typedef struct asj_way {
    double x1, y1, x2, y2;
} asj_way;

/* 4 REACH (PIXELS + tolerance |e|)^2 at most, without a root, since (a + b)^2 <= 2 (a^2 + b^2); a little more for rounding. A map
 * that misses by twice what both together may belongs to nothing near, whatever the other one says. */
static inline double asj_most_square(double ex, double ey, double tolerance)
{
    const double pixels = ASJ_AGREEMENT_PIXELS;
    return 8.001 * ASJ_AGREEMENT_REACH * (pixels * pixels + tolerance * tolerance * (ex * ex + ey * ey));
}

/* Is asj_surface_agreement() 0 for certain? */
static inline int32_t asj_way_misses(const asj_match_options *options, const asj_candidate *c, const asj_way *way)
{
    const double *map = c->map.to;
    const double x = map[0] * way->x1 + map[1] * way->y1 - way->x2, y = map[2] * way->x1 + map[3] * way->y1 - way->y2;
    return x * x + y * y > asj_most_square(way->x2, way->y2, options->neighbour_tolerance);
}

/* [ distance of the way's end from the branch's line / 3 px ]^2; *ahead: does the branch lead towards it? */
static inline double asj_off_line(const double u[2], double ex, double ey, int32_t *ahead)
{
    const double across = (u[0] * ey - u[1] * ex) / ASJ_AGREEMENT_PIXELS;
    *ahead = u[0] * ex + u[1] * ey > 0;
    return across * across;
}

/* Which of the branches `among` (bit 0: a, bit 1: b) of an L-junction pass what lies (ex, ey) away, so that both may be corners of
 * one edge. Without a branch that does in both images asj_edge_agreement() is 0. */
static inline uint32_t asj_edges_through(const asj_corners *corners, uint32_t l, uint32_t among, double ex, double ey)
{
    const double *u = corners->direction + 4 * (size_t)l;
    int32_t ahead;
    if (among == 0 || corners->stem[l])
        return 0;
    return ((among & 1) && asj_off_line(u, ex, ey, &ahead) < 2 * ASJ_AGREEMENT_REACH ? 1u : 0) |
           ((among & 2) && asj_off_line(u + 2, ex, ey, &ahead) < 2 * ASJ_AGREEMENT_REACH ? 2u : 0);
}

#endif
