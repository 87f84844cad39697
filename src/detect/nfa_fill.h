/* SPDX-License-Identifier: BSD-2-Clause */
/* What fills the tables of nfa_tables.h. It runs while the library is built (nfa_store.c) and is no part of it: at run time it
 * would take 4 ms in every process. */
#ifndef ASJ_SRC_NFA_FILL_H
#define ASJ_SRC_NFA_FILL_H

#include "nfa_tables.h"

void asj_nfa_fill_sector(asj_nfa *nfa);
void asj_nfa_fill_arc(asj_nfa *nfa);
void asj_nfa_fill_tails(asj_nfa *nfa); /* from the sectors' table */

/* Gauss-Legendre, 16 points: positive half of the nodes on [-1, 1], weights (Abramowitz and Stegun, table 25.4). */
#define ASJ_NFA_GAUSS 8
extern const double asj_nfa_gauss_node[ASJ_NFA_GAUSS], asj_nfa_gauss_weight[ASJ_NFA_GAUSS];

#endif
