/* SPDX-License-Identifier: BSD-2-Clause */
/* Chosen candidates as the caller sees them. */
#ifndef ASJ_SRC_MATCH_RESULT_H
#define ASJ_SRC_MATCH_RESULT_H

#include "match_run.h"

/* Turns the choices into a result, smallest distance first. NULL when out of memory. The result does not depend on the context
 * afterwards. */
asj_match_result *asj_match_result_create(const asj_match_run *run);

#endif
