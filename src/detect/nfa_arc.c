/* SPDX-License-Identifier: BSD-2-Clause */
/* Tails of sums of gamma~, the junction-ness of an arc's pixels (nfa.c): a table, and a parabola beyond its end. */
#include "nfa_tables.h"

#include <float.h>
#include <math.h>

/* Beyond the table a parabola goes on from it: the tail of the sum behaves as exp(-s^2/(2n)). Not below -DBL_MAX. 0
 * for s <= 0, which is no event, for an s that is not a number, and for n out of range. */
double asj_nfa_log_arc_tail(const asj_nfa *nfa, double s, int32_t n)
{
    const double end = ASJ_NFA_STEP * ASJ_NFA_ARC_CELLS;
    if (!(s > 0) || n < 1 || n > ASJ_MAX_ARC)
        return 0;
    const double *table = nfa->arc[n];
    if (s < end)
        return asj_nfa_interpolate(table, s);
    double beyond = s - end, slope = (table[ASJ_NFA_ARC_CELLS] - table[ASJ_NFA_ARC_CELLS - 1]) / ASJ_NFA_STEP;
    return fmax(table[ASJ_NFA_ARC_CELLS] + beyond * (slope - beyond / (2 * n)), -DBL_MAX);
}
