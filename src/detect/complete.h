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

/* Directions at one junction. */
typedef struct asj_missed {
    int32_t count;
    double angles[ASJ_MAX_BRANCHES]; /* rad */
} asj_missed;

/* At most as many as the junction has room for. */
void asj_complete_look(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                       const asj_hypothesis *hypothesis, asj_missed *missed);

/* A hypothesis at that junction with nothing but a branch that way, whose line and length are not known yet. */
void asj_complete_start(const asj_hypothesis *hypothesis, double angle, asj_hypothesis *branch_only);

/* Adds the branch of `branch_only` when its line, length and orientation are known, if the junction has it (validate.c). */
void asj_complete_add(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                      const asj_hypothesis *branch_only, asj_hypothesis *hypothesis);

#endif
