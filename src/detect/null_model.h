/* SPDX-License-Identifier: BSD-2-Clause */
/* The null model: its constants, and the tails of its n-fold sums, tabulated (nfa_tables.h). */
#ifndef ASJ_SRC_DETECT_NULL_MODEL_H
#define ASJ_SRC_DETECT_NULL_MODEL_H

#include <math.h>
#include <stdint.h>

/* Mean and standard deviation of one pairwise junction-ness gamma under the null model (closed forms in nfa.c). */
#define ASJ_GAMMA_MEAN 0.330494606292647
#define ASJ_GAMMA_SD 0.504136432767844

/* How strong a sum of gamma over so many pixels is: standard deviations above the null model, 0 of no pixel. */
static inline double asj_gamma_strength(double sum, int32_t pixels)
{
    return pixels > 0 ? (sum - pixels * ASJ_GAMMA_MEAN) / (ASJ_GAMMA_SD * sqrt(pixels)) : 0;
}

/* Most samples of an arc: 2 w + 1, w = arc_half_width <= 3. Tails are tabulated for up to as many terms. */
#define ASJ_MAX_ARC 7

/* Nodes for a sum of 1 of tails that are read often; linear interpolation is then good to 0.01 in ln F. */
#define ASJ_TAIL_STEPS 4

/* Tables, only read. */
typedef struct asj_nfa asj_nfa;

/* ln F(t; n): natural logarithm of P(gamma_1 + .. + gamma_n >= t) under the null model, n >= 1. 0 for t <= 0. */
double asj_nfa_log_sector_tail(const asj_nfa *nfa, double t, int32_t n);

/* ln F(i / ASJ_TAIL_STEPS; n), i = 0, 1, .. asj_nfa_tail_length(n) - 1: from 0 to more than any sum. NULL where n is too large to
 * be stored. */
const double *asj_nfa_tail(const asj_nfa *nfa, int32_t n);
int32_t asj_nfa_tail_length(int32_t n);

/* ln G(s; n): natural logarithm of P(gamma~_1 + .. + gamma~_n >= s), 1 <= n <= ASJ_MAX_ARC, s > 0. */
double asj_nfa_log_arc_tail(const asj_nfa *nfa, double s, int32_t n);

#endif
