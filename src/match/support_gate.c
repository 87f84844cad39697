/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, the gate before agreement: of millions of pairs of candidates a few in a hundred may agree. A test in single precision,
 * a little wider than agreement.c, lets these through:
 *
 *     |A_c e1 - e2|^2 and |A_d e1 - e2|^2 <= 8 REACH (3 px)^2 + 8 REACH neighbour_tolerance^2 |e2|^2, or
 *     a branch of c leads past d in both images, within 3 sqrt(2 REACH) px, and with the longer one of d's it covers the way but
 *     for end_tolerance of it.
 *
 * The first is what misprediction() of agreement.c asks of either map; the second is necessary for shared() to be below REACH
 * (ASJ_AGREEMENT_REACH). */
#include "support_gate.h"

#include <math.h>

uint64_t asj_support_gate(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t first, uint32_t count)
{
    uint64_t passed = 0;
    for (uint32_t n = 0; n < count; n++) {
        const uint32_t m = first + n;
        const float ex = list->x[m] - query->x, ey = list->y[m] - query->y;
        const float way = ex * ex + ey * ey, most = (float)ASJ_GATE_MOST + query->slope * way;
        const float cx = query->px - ex, cy = query->py - ey;
        const float dx = list->map[0][m] * query->way_x + list->map[1][m] * query->way_y - ex;
        const float dy = list->map[2][m] * query->way_x + list->map[3][m] * query->way_y - ey;
        int32_t may = cx * cx + cy * cy <= most && dx * dx + dy * dy <= most;
        for (uint32_t t = 0; t < 2; t++)
            if (query->edges >> t & 1) {
                const float both = query->length[t] + list->length[1][m];
                may |= fabsf(query->branch[t][0] * ey - query->branch[t][1] * ex) <= (float)ASJ_GATE_ACROSS &&
                       list->length[0][m] >= query->least[t] && both * both >= query->cover * way;
            }
        passed |= (uint64_t)may << n;
    }
    return passed;
}

static float longer_branch(const asj_l_junctions *l_junctions, uint32_t l)
{
    const asj_lengths *branches = l_junctions->lengths + 2 * (size_t)l;
    return branches[0].length[0] > branches[1].length[0] ? branches[0].length[0] : branches[1].length[0];
}

void asj_gate_lengths(const asj_match_run *run, const asj_candidate *c, int32_t side, float *here, float *there)
{
    const asj_l_junctions *asked = &run->image[side]->l_junctions, *others = &run->image[1 - side]->l_junctions;
    const uint32_t l = asj_candidate_l(c, side), k = asj_candidate_l(c, 1 - side);
    *here = asked->t_junction[l] || others->t_junction[k] ? ASJ_GATE_NO_EDGE : longer_branch(asked, l);
    *there = longer_branch(others, k);
}

uint32_t asj_edges_through(const asj_l_junctions *l_junctions, uint32_t l, uint32_t among, double ex, double ey)
{
    const double *u = l_junctions->direction + 4 * (size_t)l;
    if (among == 0 || l_junctions->t_junction[l] || ex * ex + ey * ey < ASJ_AGREEMENT_LEAST_WAY * ASJ_AGREEMENT_LEAST_WAY)
        return 0;
    const uint32_t a = fabs(u[0] * ey - u[1] * ex) <= ASJ_GATE_ACROSS, b = fabs(u[2] * ey - u[3] * ex) <= ASJ_GATE_ACROSS;
    return among & (a | b << 1);
}

const asj_gate_ops asj_gate_reference = {.pass = asj_support_gate};
