/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GUIDED_H
#define ASJ_SRC_GUIDED_H

#include "assign.h"

/* Appends the pairs that accepted matches propose and that are not candidates yet: compared, aligned, in order. *added = how
 * many. */
asj_status asj_guided(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                      asj_candidates *candidates, const asj_choice *choices, size_t choice_count, size_t *added);

#endif
