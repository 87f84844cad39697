/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_MATCH_RESULT_H
#define ASJ_SRC_MATCH_RESULT_H

#include "assign.h"

/* Turns choices into a result, smallest distance first. NULL when out of memory. The result does not depend on the context
 * afterwards. */
asj_match_result *asj_match_result_create(const asj_context *context, const asj_match_options *options, const asj_view *view1,
                                          const asj_view *view2, const asj_candidates *candidates, const asj_choice *choices,
                                          size_t count);

#endif
