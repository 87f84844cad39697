/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_EVIDENCE_H
#define ASJ_SRC_EVIDENCE_H

#include "adjust.h"

/* The score of score.c with what candidates of near places share counted once: evidence.c. scratch->probability is lost. */
double asj_score_apart(const asj_pairs *set, const asj_two_view *view, asj_adjust_scratch *scratch);

/* The same with a weight for what each place says, in place of that: scratch->weights after asj_weigh_places() are those of a view.
 * scratch->probability is lost. */
void asj_weigh_places(const asj_pairs *set, const asj_two_view *view, asj_adjust_scratch *scratch);
double asj_score_weighed(const asj_pairs *set, const asj_two_view *view, double *const weights[2], asj_adjust_scratch *scratch);

/* Of a parameter: the information of its prior, and what Laplace's method adds to the log of the evidence for it. */
double asj_prior_information(const asj_model *model, int32_t parameter);
double asj_log_volume(const asj_model *model, int32_t parameter);

/* Log of the share that the form of the model has: of a camera that only turns there are two (pure_rotation.c). */
double asj_log_form(const asj_model *model);

/* Natural log of the evidence for a geometry of the model's kind near the model: evidence.c. -HUGE_VAL when there is
 * none. */
double asj_log_evidence(const asj_pairs *set, const asj_model *model, asj_adjust_scratch *scratch);

#endif
