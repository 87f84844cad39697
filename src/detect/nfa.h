/* SPDX-License-Identifier: BSD-2-Clause */
/* The a-contrario machinery: null distributions, tails of their n-fold sums, numbers of tests. See nfa.c for the formulas. */
#ifndef ASJ_SRC_NFA_H
#define ASJ_SRC_NFA_H

#include "core/context.h"
#include "null_model.h"

/* The tables; the same for all contexts. */
const asj_nfa *asj_nfa_tables(void);

/* Smallest s > 0 with ln G(s; n) <= log_p, by bisection. A result > 0 even when every s passes: an arc without any junction is no
 * event. */
double asj_nfa_arc_threshold(const asj_nfa *nfa, double log_p, int32_t n);

/* ln #J(M): natural logarithm of the number of tests for isotropic junctions of `branches` branches: width x height pixels, the
 * radii whose bits are set, sectors of half-width tau pixels. -HUGE_VAL when no such junction fits. */
double asj_nfa_log_junction_tests(int32_t width, int32_t height, uint32_t radii, double tau, int32_t branches);

#endif
