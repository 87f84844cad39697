/* SPDX-License-Identifier: BSD-2-Clause */
/* How meaningful a part of a branch is: what edges between two junctions are judged by. */
#ifndef ASJ_SRC_EDGE_EVIDENCE_H
#define ASJ_SRC_EDGE_EVIDENCE_H

#include "core/image.h"
#include "hypothesis.h"

/* What the strip along a whole branch says, in parts of equal length (edge_evidence.c). */
#define ASJ_EVIDENCE_PARTS 8
typedef struct asj_evidence {
    double length;                     /* px of its octave: of all parts; 0 = not measured */
    double gamma[ASJ_EVIDENCE_PARTS];  /* sum of gamma up to the end of each part */
    int32_t pixels[ASJ_EVIDENCE_PARTS];
    double alike;                      /* pixels that are as good as one (strip.c) */
} asj_evidence;

/* Measures the strips along all branches, over their whole length; evidence[branch->evidence] becomes that of the branch. */
void asj_edge_evidence_measure(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                               const asj_hypothesis *hypothesis, asj_evidence *evidence);

/* ln NFA of the strip from the junction `distance` px along the branch, all in pixels of the octave that found it; what lies beyond
 * the branch has not been looked at and counts for nothing. `log_tests`: asj_strip_log_tests() of that octave. */
double asj_edge_evidence_log_nfa(const asj_evidence *evidence, double distance, double log_tests);

#endif
