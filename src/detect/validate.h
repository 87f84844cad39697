/* SPDX-License-Identifier: BSD-2-Clause */
/* After step 5: which branches, and which junctions, are reported; and which cannot be, long before. */
#ifndef ASJ_SRC_VALIDATE_H
#define ASJ_SRC_VALIDATE_H

#include "hypothesis.h"

/* Slack of decisions that are taken before angles are known as well as later: natural logarithm of a number of false alarms.
 * Chosen: more passes noise on to the scan, which costs time; less begins to reject what would become meaningful. */
#define ASJ_EARLY_LOG_NFA 6.0

/* Drops branches that asj_validate() would drop whatever their length, before they are scanned; branch_count becomes 0 when no two
 * that open enough are left. */
void asj_reject_early(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                      asj_hypothesis *hypothesis);

/* The same once branches are oriented, before they are scanned again: those that begin px away from the junction, and junctions
 * that have moved far. */
void asj_reject_oriented(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         asj_hypothesis *hypothesis);

/* Drops branches that are too short, off the junction, not meaningful, or twins of a better one; branch_count becomes 0 when no two
 * branches open enough, when it would hardly be found again (steady.h), or on an arc. Sorts the branches by angle. */
void asj_validate(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                  asj_hypothesis *hypothesis);

/* Whether a validated junction has this branch, too: one that is beyond doubt, passes the junction, and points elsewhere than its
 * others. Sets the branch's number of false alarms. */
int asj_validate_another(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         const asj_hypothesis *hypothesis, asj_hypothesis_branch *branch);

/* The same as asj_validate() for lengths alone, which have changed since. */
void asj_validate_lengths(const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis);

#endif
