/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_EVIDENCE_H
#define ASJ_SRC_EVIDENCE_H

#include "adjust.h"

/* Natural log of the evidence for a geometry of the model's kind near the model: evidence.c. -HUGE_VAL when there is
 * none. */
double asj_log_evidence(const asj_pairs *set, const asj_model *model, asj_adjust_scratch *scratch);

#endif
