/* SPDX-License-Identifier: BSD-2-Clause */
/* What an estimation says in the end. */
#ifndef ASJ_SRC_GEOMETRY_ANSWER_H
#define ASJ_SRC_GEOMETRY_ANSWER_H

#include "estimation.h"
#include "judge.h"

/* probabilities: of the caller's candidates, or NULL. judge: NULL, or written where the geometry is accepted. */
void asj_answer(asj_estimation *e, double *probabilities, asj_judge *judge, asj_geometry *result);

#endif
