/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 6: junctions -> ordered L-junctions (paper section "ASJ Matching", first half).
 *
 * Every pair of branches that are not parallel gives an L-junction. The order (the paper's partial order, whose two lines both read
 * "<"): a comes before b when (theta_b - theta_a) mod 2 pi < pi. With y down that is clockwise on the screen. Exactly one order of
 * a pair satisfies it, and an affine map that does not mirror preserves it. */
#include "core/angle.h"

#include <asj/detect.h>

#include <math.h>

#define PARALLEL 1e-6 /* rad: angles are rounded to single precision */

static asj_l_junction make(const asj_junction *junction, uint32_t index, int32_t a, int32_t b)
{
    const asj_branch *p = &junction->branches[a], *q = &junction->branches[b];
    asj_l_junction l;
    l.junction = index;
    l.branch_a = (uint16_t)a;
    l.branch_b = (uint16_t)b;
    l.x = junction->x;
    l.y = junction->y;
    l.ax = (float)(junction->x + p->length * cos((double)p->angle));
    l.ay = (float)(junction->y + p->length * sin((double)p->angle));
    l.bx = (float)(junction->x + q->length * cos((double)q->angle));
    l.by = (float)(junction->y + q->length * sin((double)q->angle));
    return l;
}

size_t asj_decompose(const asj_junction *junctions, size_t junction_count, double minimum_opening,
                     asj_l_junction *l_junctions, size_t capacity)
{
    const double least = minimum_opening * ASJ_DEGREE;
    size_t count = 0;
    for (size_t n = 0; junctions && n < junction_count; n++) {
        const asj_junction *junction = &junctions[n];
        if (junction->branch_count < 0 || junction->branch_count > ASJ_MAX_BRANCHES)
            continue;
        for (int32_t i = 0; i < junction->branch_count; i++)
            for (int32_t j = i + 1; j < junction->branch_count; j++) {
                double turn = fmod((double)junction->branches[j].angle - (double)junction->branches[i].angle, ASJ_TWO_PI);
                turn = turn < 0 ? turn + ASJ_TWO_PI : turn;
                double opening = turn < ASJ_PI ? turn : ASJ_TWO_PI - turn;
                if (!(opening > PARALLEL && opening < ASJ_PI - PARALLEL && opening >= least && opening <= ASJ_PI - least))
                    continue;
                if (l_junctions && count < capacity)
                    l_junctions[count] = turn < ASJ_PI ? make(junction, (uint32_t)n, i, j) : make(junction, (uint32_t)n, j, i);
                count++;
            }
    }
    return count;
}
