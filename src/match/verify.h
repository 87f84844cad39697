/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_VERIFY_H
#define ASJ_SRC_VERIFY_H

#include "assign.h"

/* Drops choices that the choices around them contradict; the order of the others stays. */
asj_status asj_verify(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                      const asj_candidates *candidates, asj_choice *choices, size_t *count);

#endif
