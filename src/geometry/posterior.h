/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_POSTERIOR_H
#define ASJ_SRC_GEOMETRY_POSTERIOR_H

#include "adjust.h"
#include "core/context.h"

/* Moves an essential matrix, or a camera that only turns, to the middle of what the candidates allow around it, with the evidence
 * of all that and the covariance of the parameters of its motion, five or three: posterior.c. scratch: one for each thread. */
void asj_settle(asj_context *context, const asj_pairs *set, uint64_t seed, asj_adjust_scratch *scratch, asj_model *model);

/* Essential matrices: is the other motion one of those that the settled one stands for? */
int32_t asj_is_within(const asj_model *settled, const asj_model *other);

/* Covariance of the motion's five parameters: that of the best model, and what others of its kind that stand are likely besides.
 * Returns the largest standard deviation of a combination of them, rad. */
double asj_motion_covariance(const asj_pairs *set, const asj_model *models, int32_t count, int32_t best, double covariance[25]);

#endif
