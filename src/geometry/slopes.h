/* SPDX-License-Identifier: BSD-2-Clause */
/* How residuals change with a model's parameters. */
#ifndef ASJ_SRC_GEOMETRY_SLOPES_H
#define ASJ_SRC_GEOMETRY_SLOPES_H

#include "model.h"

#define ASJ_PART_PARAMETERS 8 /* at most: five of the motion and three of a plane; eight of a homography */

/* Of each part of a model: the derivatives of its matrix along the parameters that move it. */
typedef struct asj_model_slopes {
    int32_t count[ASJ_MOST_PARTS];
    int32_t parameter[ASJ_MOST_PARTS][ASJ_PART_PARAMETERS];
    double along[ASJ_MOST_PARTS][ASJ_PART_PARAMETERS][9];
} asj_model_slopes;

/* The parameters are those of asj_model_move(). 0 when the model is none. */
int32_t asj_model_slopes_of(const asj_model *model, asj_model_slopes *slopes);

/* The residuals of a candidate under a part, and the derivatives of each along the part's parameters. 0 when the residuals are
 * infinite; else 3 (epipolar) or 6 (planar): how many there are. */
int32_t asj_residual_slopes(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *pair,
                            const asj_model_slopes *slopes, asj_residuals *at, double slope[ASJ_PART_PARAMETERS][6]);

#endif
