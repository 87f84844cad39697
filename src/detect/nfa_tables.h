/* SPDX-License-Identifier: BSD-2-Clause */
/* What stands behind asj_nfa: tables of ln tails, filled while the library is built (nfa_fill.h). */
#ifndef ASJ_SRC_NFA_TABLES_H
#define ASJ_SRC_NFA_TABLES_H

#include "null_model.h"

enum {
    ASJ_NFA_PER_UNIT = 32,                      /* nodes per unit of every table: a power of two, so that finding a cell is exact */
    ASJ_NFA_DIRECT = 6,                         /* sums of up to this many gamma have a table; longer ones use the saddlepoint */
    ASJ_NFA_SECTOR_CELLS = 16 * ASJ_NFA_PER_UNIT,
    ASJ_NFA_RATE_CELLS = 4 * ASJ_NFA_PER_UNIT,  /* saddlepoint: in u = sqrt(t / n) */
    ASJ_NFA_ARC_CELLS = 12 * ASJ_NFA_PER_UNIT,  /* sums of gamma~ */
    ASJ_NFA_TAIL_TERMS = 32,                    /* tails of sums of up to this many gamma are stored: sectors of radius 14 */
    ASJ_NFA_TAILS = 7800                        /* room for them */
};
#define ASJ_NFA_STEP (1.0 / ASJ_NFA_PER_UNIT)

/* A node of the saddlepoint table and its derivatives with respect to u (nfa_sector.c). */
typedef struct asj_nfa_rate {
    double root, root_slope, correction, correction_slope;
} asj_nfa_rate;

struct asj_nfa {
    asj_nfa_rate rate[ASJ_NFA_RATE_CELLS + 1];
    /* ln F(i step; n) and ln G(i step; n); first entries are the limits from above */
    double sector[ASJ_NFA_DIRECT + 1][ASJ_NFA_SECTOR_CELLS + 1];
    double arc[ASJ_MAX_ARC + 1][ASJ_NFA_ARC_CELLS + 1];
    double tails[ASJ_NFA_TAILS]; /* asj_nfa_tail() of 1, 2, .. terms, one behind the other */
};

/* Written into the library by the program nfa_store.c. */
extern const asj_nfa asj_nfa_stored;

/* Linear in a table of ln P against i * step, so that it falls wherever the table falls. The error, step^2/8 |(ln P)''| at most, is
 * below 6e-5 decades, save next to the infinite density of gamma~ at 0: there 3e-3 decades in the first cell of G, 6e-4 in the
 * second, 6e-5 from s = 0.25 on. */
static inline double asj_nfa_interpolate(const double *table, double x)
{
    const double place = x * ASJ_NFA_PER_UNIT;
    const int cell = (int)place;
    return table[cell] + (table[cell + 1] - table[cell]) * (place - cell);
}

#endif
