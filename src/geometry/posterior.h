/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_POSTERIOR_H
#define ASJ_SRC_GEOMETRY_POSTERIOR_H

#include "adjust.h"
#include "core/context.h"

/* Moves an essential matrix, or a camera that only turns, to the middle of what the candidates allow around it, with the evidence
 * of all that and the covariance of the parameters of its motion, five or three: posterior.c. scratch: one for each thread. */
void asj_settle(asj_context *context, const asj_pairs *set, uint64_t seed, asj_adjust_scratch *scratch, asj_model *model);

/* The power of likelihoods with which what candidates allow spreads as widely as poses err: posterior.c. */
#define ASJ_TEMPER 0.5

/* The largest standard deviation of a combination of n parameters, 5 at most, with this n x n covariance. */
double asj_largest_sd(const double covariance[25], int32_t n);

#endif
