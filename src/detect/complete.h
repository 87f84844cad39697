/* SPDX-License-Identifier: BSD-2-Clause */
/* Option complete_junctions: where around a junction that is known there may be branches that its test has missed. */
#ifndef ASJ_SRC_COMPLETE_H
#define ASJ_SRC_COMPLETE_H

#include "hypothesis.h"

/* Whether it is asked for. The search (search.c) finds lengths and orientations in another way. */
static inline int asj_complete_is_asked(const asj_detect_options *options)
{
    return options->complete_junctions && options->refinement == ASJ_REFINE_LINE_FIT;
}

typedef struct asj_missed_direction {
    double angle;   /* rad */
    double meaning; /* -ln of the number of false alarms of the strip that way */
} asj_missed_direction;

/* At one junction, the most meaningful first. */
typedef struct asj_missed {
    int32_t count;
    asj_missed_direction list[ASJ_MAX_BRANCHES];
} asj_missed;

/* None when the junction has max_branches already. */
void asj_complete_look(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                       const asj_hypothesis *hypothesis, asj_missed *missed);

/* A hypothesis at that junction with nothing but a branch that way: its log_nfa is that of the strip, its length only says how
 * far to look for its line first. */
void asj_complete_start(const asj_hypothesis *hypothesis, const asj_missed_direction *direction, asj_hypothesis *branch_only);

/* Adds the branch of `branch_only` when its line, length and orientation are known, if the junction has it (validate.c). */
void asj_complete_add(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                      const asj_hypothesis *branch_only, asj_hypothesis *hypothesis);

#endif
