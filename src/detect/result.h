/* SPDX-License-Identifier: BSD-2-Clause */
/* The result of asj_detect(), filled from hypotheses. */
#ifndef ASJ_SRC_RESULT_H
#define ASJ_SRC_RESULT_H

#include "hypothesis.h"

/* What the steps have found: hypotheses, most meaningful first, and edges between them. */
typedef struct asj_findings {
    const asj_hypothesis *hypotheses;
    size_t count;
    const asj_edge *edges;
    size_t edge_count;
} asj_findings;

/* Turns hypotheses into a result with its L-junctions and edges: into *detection, whose memory is used again, or into
 * a new one when that is NULL. The result does not depend on the context afterwards. ASJ_ERROR_MEMORY leaves an empty result, or
 * NULL as it was. */
asj_status asj_result_fill(const asj_context *context, const asj_findings *findings, double minimum_opening,
                           asj_detection **detection);

/* Makes it the result of nothing. */
void asj_result_clear(asj_detection *detection);

#endif
