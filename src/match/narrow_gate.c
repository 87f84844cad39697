/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, the gate once more: of twenty candidates that the wide gate lets through one agrees, and agreement.c, in double precision
 * and with all that is known of both, takes as long for the others. Here too in single precision, and a little wider than there:
 *
 *     |A_c - A_d|^2 <= REACH map_tolerance^2 |A_c| |A_d|, the unlikeness of the maps alone, and
 *     |p - e2|^2 <= REACH (3 px + neighbour_tolerance |e2|)^2, the misprediction alone; or
 *     |log(|p| / |e2|)| <= sqrt(REACH) map_tolerance, the wrong length of an edge alone.
 *
 * Where A_c e1 and A_d e1 are nearly opposite the direction of p hangs on rounding: these pass. */
#include "narrow_gate.h"

#include <math.h>

#define WIDER 1.02f     /* for squares of px and of norms: single precision is off by a millionth of the largest numbers */
#define OPPOSITE 1e-3f  /* of the square of the sum, over that of what it is of */
#define LEAST_SQUARE 1e-30f
#define MOST_POWER 1e18 /* floats end at 1e38 */

asj_narrow_maps asj_narrow_maps_of(const asj_candidate *list, uint32_t candidate, int32_t side)
{
    asj_narrow_maps maps = {.candidate = candidate};
    for (int k = 0; k < 4; k++) {
        maps.here[k] = (float)asj_candidate_map(&list[candidate], side)[k];
        maps.to[k] = (float)list[candidate].map.to[k];
        maps.size += maps.here[k] * maps.here[k];
    }
    return maps;
}

asj_narrow_query asj_narrow_query_of(const asj_match_options *options, const asj_candidate *c, int32_t side)
{
    const double unlike = ASJ_AGREEMENT_REACH * options->map_tolerance * options->map_tolerance;
    const double power = exp(4 * sqrt(ASJ_AGREEMENT_REACH) * options->map_tolerance);
    asj_narrow_query narrow = {asj_narrow_maps_of(c, 0, side), side, 0, WIDER * (float)(power < MOST_POWER ? power : MOST_POWER),
                               (float)options->neighbour_tolerance};
    narrow.unlike = WIDER * (float)(unlike * unlike) * narrow.own.size;
    return narrow;
}

static float square(float x, float y)
{
    return x * x + y * y;
}

/* Of a way when a map has turned it. */
static float turned_square(const float map[4], float x, float y)
{
    return square(map[0] * x + map[1] * y, map[2] * x + map[3] * y);
}

static int are_alike(const asj_narrow_query *n, const asj_narrow_maps *d)
{
    float off = 0;
    for (int k = 0; k < 4; k++)
        off += (n->own.here[k] - d->here[k]) * (n->own.here[k] - d->here[k]);
    return off * off <= n->unlike * d->size + LEAST_SQUARE;
}

static int predict(const asj_gate_query *q, const asj_narrow_query *n, const asj_narrow_maps *d, float ex, float ey)
{
    const float tx = d->here[0] * q->way_x + d->here[1] * q->way_y, ty = d->here[2] * q->way_x + d->here[3] * q->way_y;
    const float c = sqrtf(square(q->px, q->py)), t = sqrtf(square(tx, ty)), product = c * t;
    const float sx = q->px * t + tx * c, sy = q->py * t + ty * c, sum = square(sx, sy);
    if (sum <= OPPOSITE * product * product + LEAST_SQUARE)
        return 1;
    const float scale = sqrtf(product / sum), allowed = (float)ASJ_AGREEMENT_PIXELS + n->tolerance * sqrtf(square(ex, ey));
    return square(sx * scale - ex, sy * scale - ey) <= WIDER * (float)ASJ_AGREEMENT_REACH * allowed * allowed;
}

/* Have the ways from c to d the right length for an edge? */
static int are_as_long(const asj_narrow_query *n, const asj_narrow_maps *d, float x1, float y1, float x2, float y2)
{
    const float both = turned_square(n->own.to, x1, y1) * turned_square(d->to, x1, y1), way = square(x2, y2), power = way * way;
    return both <= n->power * power && power <= n->power * both;
}

uint32_t asj_narrow_gate(const asj_gate_query *query, const asj_narrow_query *narrow, const asj_narrow_maps *d, float ex, float ey)
{
    const float x = query->way_x, y = query->way_y;
    uint32_t may = are_alike(narrow, d) && predict(query, narrow, d, ex, ey) ? ASJ_NARROW_SURFACE : 0;
    if (query->edges && (narrow->side == 0 ? are_as_long(narrow, d, x, y, ex, ey) : are_as_long(narrow, d, ex, ey, x, y)))
        may |= ASJ_NARROW_EDGE;
    return may;
}
