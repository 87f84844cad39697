/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_OTHER_MOTIONS_H
#define ASJ_SRC_GEOMETRY_OTHER_MOTIONS_H

#include "model.h"

/* Essential matrices: is the other motion one of those that the settled one stands for? */
int32_t asj_is_within(const asj_model *settled, const asj_model *other);

/* Covariance of the motion's five parameters: that of the best model, and what others of its kind that stand are likely besides.
 * Returns the largest standard deviation of a combination of them, rad. */
double asj_motion_covariance(const asj_pairs *set, const asj_model *models, int32_t count, int32_t best, double covariance[25]);

#endif
