/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_RESULT_H
#define ASJ_SRC_RESULT_H

#include "draft.h"

/* Turns drafts (most meaningful first) into a result with its L-junctions. NULL when out of memory. The result does not depend on
 * the context afterwards. */
asj_detection *asj_result_create(const asj_context *context, const asj_draft *drafts, size_t count, double minimum_opening);

#endif
