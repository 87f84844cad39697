/* SPDX-License-Identifier: BSD-2-Clause */
/* How meaningful a part of a branch is: what edges between two junctions are judged by. */
#ifndef ASJ_SRC_EDGE_EVIDENCE_H
#define ASJ_SRC_EDGE_EVIDENCE_H

#include "core/image.h"
#include "hypothesis.h"

/* Measures the strips along all branches, over their whole length. */
void asj_edge_evidence_measure(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                               asj_hypothesis *hypothesis);

/* ln NFA of the strip from the junction `distance` px along the branch, all in pixels of the octave that found it; what lies beyond
 * the branch has not been looked at and counts for nothing. `log_tests`: asj_strip_log_tests() of that octave. */
double asj_edge_evidence_log_nfa(const asj_context *context, const asj_evidence *evidence, double distance, double log_tests);

#endif
