/* SPDX-License-Identifier: BSD-2-Clause */
/* What an estimation says in the end. */
#ifndef ASJ_SRC_GEOMETRY_ANSWER_H
#define ASJ_SRC_GEOMETRY_ANSWER_H

#include "estimation.h"
#include "judge.h"

/* judge: NULL, or written where the geometry is accepted. What is told is e->first then, with the probabilities of candidates,
 * unless nothing was found. Errors: CANCELLED, MEMORY. */
asj_status asj_answer(asj_estimation *e, asj_judge *judge, asj_geometry *result);

#endif
