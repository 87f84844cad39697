/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 4: branch lengths (paper sections "Differential Junction-ness Model" to "Modified Probabilistic Distribution").
 *
 * At radius r the ray's arc is sampled at  a_d = theta + d / r,  d = -w .. w  (w = arc_half_width, about one pixel apart):
 *     q_d = p + r (cos a_d, sin a_d), rounded to a pixel,
 *     gamma~_d = omega_q^i max(|cos(theta_q^i - a_d)| - |sin(theta_q^i - a_d)|, 0)      (eq. junction-ness-pairwise-modified)
 * where (theta_q^i, omega_q^i) is that branch of the local junction at q whose angle is closest to theta. The derivative of the
 * junction-ness along r is S_r = sum of gamma~_d (the terms in delta'(r) are dropped, as in the paper). The step belongs to the
 * branch when  sqrt(NM) P(S >= S_r) <= scan_epsilon  with P the (2 w + 1)-fold tail of p~ (nfa.c, eq. probability-updated); that is
 * a threshold on S_r, computed once. A step without any local branch never passes (the threshold is positive).
 *
 * Using local junctions instead of gradients is what lets a branch cross other junctions: at a crossing most pixels still have one
 * branch along the ray.
 *
 * Departures (options that restore the paper in brackets):
 *   - the ray survives one failing step (scan_tolerance = 0), which random crossings need;
 *   - it starts at radius 3, not at the isotropic scale (scan_start = 0), so that the length depends on nothing else;
 *   - "closest" is taken twice, modulo 2 pi (forward) and modulo pi (axial), and the length is the mean of both (scan_axial = no).
 *     The forward branch of a pixel dies about 2.6 px before the edge's end, when its sector leaves the edge; the axial one, which
 *     may look back, lives about 4 px longer. Their mean is within a pixel of the truth. While the axial test passes, the forward
 *     one may fail for up to the field's radius and come back: at the crossing of two thin lines no branch looks forward for a few
 *     pixels. A branch that looks back along the ray does not count as forward then, though |cos| would let it;
 *   - not every step is looked at, since most of a long edge is beyond doubt (scan_tolerance = 0). While nothing fails, steps with
 *     a plain edge under them pass: sum of gamma, as in sector.c, over three pixels across, of at least 1.2. So do steps before one
 *     that passes, four farther on. In the sample room and four photographs about one in a hundred of the steps that pass unseen
 *     would have failed, and one in five hundred together with the next, which alone would have ended the ray.
 *
 * A scan may be rough, where the ray is followed again later: without axes, and it ends where two strides fail, at radii next to
 * each other, as it does where two steps do.
 *
 * Whole numbers throughout, so that every back end takes the same decisions: positions in 1/65536 px, unit vectors in 2^-30 for
 * positions and 2^-14 for angles, angles in 1/65536 of a turn. */
#include "ray_walk.h"
#include "core/angle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* d / r turned into a rotation: cos and sin in 2^-30. One table of them for all rays, since r is a whole number; beyond the table
 * the arc is straight to within 0.01 px. */
static void place(const asj_scan *scan, const asj_ray_direction *ray, int32_t r, int32_t d, asj_arc *arc)
{
    const int32_t lane = d + scan->half_width;
    const int32_t size = d < 0 ? -d : d;
    const int in_table = r < ASJ_SCAN_TABLE_RADIUS;
    const int64_t c = in_table ? scan->arc_cosine[r][size] : (int64_t)1 << 30;
    int64_t s = in_table ? scan->arc_sine[r][size] : ((int64_t)size << 30) / r;
    if (d < 0)
        s = -s;
    /* (cos a_d, sin a_d) = (c ux - s uy, c uy + s ux) */
    int64_t ex = (c * ray->ux - s * ray->uy) >> 30, ey = (c * ray->uy + s * ray->ux) >> 30;
    arc->x[lane] = (int32_t)((ray->x + ((r * ex) >> 14) + 32768) >> 16);
    arc->y[lane] = (int32_t)((ray->y + ((r * ey) >> 14) + 32768) >> 16);
    arc->unit[lane][0] = (int16_t)(ex >> 16);
    arc->unit[lane][1] = (int16_t)(ey >> 16);
}

static void place_arc(const asj_scan *scan, const asj_ray_direction *way, int32_t r, asj_arc *arc)
{
    for (int32_t d = -scan->half_width; d <= scan->half_width; d++)
        place(scan, way, r, d, arc);
}

/* gamma~ of one local branch seen from the ray, in 1/256 standard deviations; *ahead tells whether it points along the ray. */
static int32_t junctionness(const asj_scan *scan, asj_field_branch branch, const int16_t at[2], int *ahead)
{
    const int16_t *unit = scan->unit[(branch.angle + 32) >> 6 & 1023];
    const int32_t along = unit[0] * at[0] + unit[1] * at[1];
    const int32_t across = unit[0] * at[1] - unit[1] * at[0];
    const int32_t gamma = ((abs(along) - abs(across)) >> 14) * branch.strength >> 14;
    *ahead = along > 0;
    return gamma > 0 ? gamma : 0;
}

/* Which branches are closest to the ray's direction, modulo 2 pi and modulo pi; of equals the strongest. Branches that are none
 * come last. No jumps: which branch it is cannot be predicted. */
static void closest(const asj_field_branch *list, uint16_t angle, int32_t *forward, int32_t *axial)
{
    int32_t nearest = INT32_MAX, nearest_axis = INT32_MAX; /* 4 x distance + index */
    for (int32_t i = 0; i < ASJ_FIELD_BRANCHES; i++) {
        const int32_t turn = (int16_t)(list[i].angle - angle), none = list[i].strength ? 0 : 1 << 20;
        const int32_t distance = abs(turn), axis = 16384 - abs(16384 - distance);
        const int32_t order = (distance | none) * ASJ_FIELD_BRANCHES + i, axis_order = (axis | none) * ASJ_FIELD_BRANCHES + i;
        nearest = order < nearest ? order : nearest;
        nearest_axis = axis_order < nearest_axis ? axis_order : nearest_axis;
    }
    *forward = nearest % ASJ_FIELD_BRANCHES;
    *axial = nearest_axis % ASJ_FIELD_BRANCHES;
}

static void sum_arc(const asj_scan *scan, const asj_ray_direction *way, const asj_arc *arc, asj_arc_branches branches,
                    asj_arc_sums *to)
{
    asj_arc_sums sums = {0, 0, 0};
    for (int32_t i = 0; i <= 2 * scan->half_width; i++) {
        const asj_field_branch *list = branches[i];
        int32_t forward, axial;
        int ahead, ignored;
        closest(list, way->angle, &forward, &axial);
        const int32_t gamma = junctionness(scan, list[forward], arc->unit[i], &ahead);
        sums.forward += gamma;
        sums.ahead += ahead ? gamma : 0;
        sums.axial += axial == forward ? gamma : junctionness(scan, list[axial], arc->unit[i], &ignored);
    }
    sums.axial = scan->axial ? sums.axial : 0;
    *to = sums;
}

const asj_arc_ops asj_arc_reference = {.place = place_arc, .sum = sum_arc};

/* Takes the step to radius r; 0 when the ray ends. */
static int advance(const asj_scan *scan, const asj_arc_sums *sums, int32_t bridge, int32_t r, asj_ray_progress *p, asj_ray *ray)
{
    p->ahead_passes = sums->ahead >= scan->threshold ? p->ahead_passes + 1 : 0;
    p->ahead_failures = p->ahead_passes ? 0 : p->ahead_failures + 1;
    p->axial_failures = sums->axial >= scan->threshold ? 0 : p->axial_failures + 1;
    if (p->ahead_passes >= ASJ_RAY_REOPEN)
        p->forward_failures = 0; /* back after a crossing */
    else if (sums->forward < scan->threshold || p->forward_failures > scan->tolerance)
        p->forward_failures++;
    else
        p->forward_failures = 0;
    if (p->forward_failures == 0)
        ray->forward = r;
    if (p->axial_failures == 0)
        ray->axial = r;
    return p->forward_failures <= scan->tolerance || (p->ahead_failures <= bridge && p->axial_failures <= scan->tolerance);
}

/* Whether a step passes in every way. */
static int passes(const asj_scan *scan, const asj_arc_sums *sums)
{
    return sums->ahead >= scan->threshold && (!scan->axial || sums->axial >= scan->threshold);
}

asj_ray_direction asj_ray_walk_direction(const asj_ray *ray)
{
    const double one = (double)((int64_t)1 << 30);
    return (asj_ray_direction){llrint(ray->x * 65536), llrint(ray->y * 65536), llrint(cos(ray->angle) * one),
                               llrint(sin(ray->angle) * one), (uint16_t)llrint(ray->angle * (65536 / ASJ_TWO_PI))};
}

void asj_ray_walk_finish(const asj_scan *scan, asj_ray *ray)
{
    const int32_t bridge = scan->field->sectors.radius;
    if (scan->axial && ray->axial > ray->forward + bridge)
        ray->axial = ray->forward + bridge;
}

/* gamma of the pixel at a place, 1/65536 px, in 2^-24. The border's margin is zero. */
static inline int32_t gamma_at(const asj_frame *frame, int64_t x, int64_t y, int32_t ux, int32_t uy)
{
    const ptrdiff_t at = (ptrdiff_t)(y >> 16) * frame->stride + (ptrdiff_t)(x >> 16);
    const int32_t gx = frame->gradient_x[at], gy = frame->gradient_y[at];
    const int32_t gamma = abs(gy * ux - gx * uy) - abs(gx * ux + gy * uy);
    return gamma > 0 ? gamma : 0;
}

/* The first step from radius r on, before `last`, that has no edge along the ray under it: three pixels across, rounded, of which
 * the middle one is mostly enough. */
static int32_t end_of_edge(const asj_frame *frame, const asj_ray_direction *way, int32_t r, int32_t last)
{
    const asj_frame planes = *frame; /* in registers */
    const int64_t across_x = -(way->uy >> 14), across_y = way->ux >> 14, start_x = way->x + 32768, start_y = way->y + 32768;
    const int32_t ux = (int32_t)(way->ux >> 16), uy = (int32_t)(way->uy >> 16);
    for (int64_t to_x = r * way->ux, to_y = r * way->uy; r < last; r++, to_x += way->ux, to_y += way->uy) {
        const int64_t x = start_x + (to_x >> 14), y = start_y + (to_y >> 14);
        if ((uint64_t)(x >> 16) >= (uint64_t)planes.width || (uint64_t)(y >> 16) >= (uint64_t)planes.height)
            break; /* outside, on either side */
        int32_t sum = gamma_at(&planes, x, y, ux, uy);
        for (int32_t d = -1; d <= 1 && sum < ASJ_SCAN_EDGE; d += 2)
            sum += gamma_at(&planes, x + d * across_x, y + d * across_y, ux, uy);
        if (sum < ASJ_SCAN_EDGE)
            break;
    }
    return r;
}

/* Passes over the steps from here on that have an edge under them beyond doubt. */
static void pass_over(const asj_scan *scan, const asj_frame *frame, asj_ray_walk *walk)
{
    const int32_t last = scan->longest > 0 ? scan->longest + ASJ_RAY_PLAIN : INT32_MAX;
    const int32_t end = end_of_edge(frame, &walk->way, walk->r, last);
    if (end - walk->r <= ASJ_RAY_PLAIN)
        return;
    walk->r = end - ASJ_RAY_PLAIN;
    walk->ray->forward = walk->r - 1;
    walk->ray->axial = scan->axial ? walk->ray->forward : 0;
    walk->progress.ahead_failures = 0;
}

void asj_ray_walk_start(asj_ray *ray, asj_ray_walk *walk)
{
    memset(walk, 0, sizeof *walk);
    ray->forward = ray->axial = 0;
    walk->ray = ray;
    walk->way = asj_ray_walk_direction(ray);
    walk->r = ray->start > 0 ? ray->start : 1;
}

int32_t asj_ray_walk_next(const asj_scan *scan, const asj_frame *frame, asj_ray_walk *walk)
{
    walk->strides = walk->r > walk->looked && scan->tolerance > 0 && walk->progress.forward_failures == 0 &&
                    (!scan->axial || walk->progress.axial_failures == 0);
    if (!walk->strides)
        return walk->r;
    pass_over(scan, frame, walk);
    walk->looked = walk->r + ASJ_RAY_STRIDE - 1;
    return walk->looked;
}

/* The step to the current radius, and on to the next. */
static int step(const asj_scan *scan, const asj_arc_sums *sums, asj_ray_walk *walk)
{
    const int32_t bridge = scan->axial ? scan->field->sectors.radius : -1;
    const int goes_on = advance(scan, sums, bridge, walk->r, &walk->progress, walk->ray);
    walk->r++;
    return goes_on;
}

/* After a stride that fails: the steps before it, one by one; of a rough scan that is on its way, the next stride if it was the
 * first to fail. */
static int go_back(const asj_scan *scan, asj_ray_walk *walk)
{
    if (!scan->rough || walk->ray->forward == 0)
        return 1;
    if (walk->missed)
        return 0;
    walk->missed = 1;
    walk->looked = walk->r++;
    return 1;
}

int asj_ray_walk_take(const asj_scan *scan, const asj_arc_sums *sums, asj_ray_walk *walk)
{
    int goes_on = 1;
    if (walk->strides) {
        walk->far = *sums;
        if (passes(scan, sums)) {
            walk->missed = 0;
            walk->r = walk->looked;
            goes_on = step(scan, sums, walk);
        } else
            goes_on = go_back(scan, walk);
    } else {
        goes_on = step(scan, sums, walk);
        if (goes_on && walk->r == walk->looked)
            goes_on = step(scan, &walk->far, walk);
    }
    goes_on = goes_on && (scan->longest == 0 || walk->r <= scan->longest);
    if (!goes_on)
        asj_ray_walk_finish(scan, walk->ray);
    return goes_on;
}
