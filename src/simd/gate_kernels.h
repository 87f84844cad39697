/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_support_gate() of support_gate.c in vectors of 128 bits. */
#ifndef ASJ_SRC_SIMD_GATE_KERNELS_H
#define ASJ_SRC_SIMD_GATE_KERNELS_H

#include "disc_kernels.h"
#include "match/support_gate.h"

/* One bit for each lane. */
static inline uint32_t bits_of(ints mask)
{
    const ints bits = mask & (ints){1, 2, 4, 8};
    return (uint32_t)((bits[0] | bits[1]) | (bits[2] | bits[3]));
}

/* Whether any lane is not 0. */
static inline int any_of(ints mask)
{
    const fours halves = (fours)mask;
    return (halves[0] | halves[1]) != 0;
}

/* Four candidates; few maps of c lead near any of them, so their own maps are seldom needed. */
static inline uint32_t gate_four(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t m)
{
    const floats ex = floats_at(list->x + m) - query->x, ey = floats_at(list->y + m) - query->y;
    const floats way = ex * ex + ey * ey, most = (float)ASJ_GATE_MOST + query->slope * way;
    const floats cx = query->px - ex, cy = query->py - ey;
    ints may = cx * cx + cy * cy <= most;
    if (any_of(may)) {
        const floats dx = floats_at(list->map[0] + m) * query->way_x + floats_at(list->map[1] + m) * query->way_y - ex;
        const floats dy = floats_at(list->map[2] + m) * query->way_x + floats_at(list->map[3] + m) * query->way_y - ey;
        may &= dx * dx + dy * dy <= most;
    }
    for (uint32_t t = 0; t < 2; t++)
        if (query->edges >> t & 1) {
            const floats both = query->length[t] + floats_at(list->length[1] + m);
            may |= (magnitude(query->branch[t][0] * ey - query->branch[t][1] * ex) <= floats_of((float)ASJ_GATE_ACROSS)) &
                   (floats_at(list->length[0] + m) >= query->least[t]) & (both * both >= query->cover * way);
        }
    return any_of(may) ? bits_of(may) : 0;
}

static uint64_t support_gate(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t first, uint32_t count)
{
    uint64_t passed = 0;
    for (uint32_t n = 0; n < count; n += 4)
        passed |= (uint64_t)gate_four(query, list, first + n) << n;
    return passed & ~(uint64_t)0 >> (64 - count);
}

static void fill_gate(const asj_ops *ops)
{
    ops->gate->pass = support_gate;
}

#endif
