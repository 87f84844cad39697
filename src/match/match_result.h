/* SPDX-License-Identifier: BSD-2-Clause */
/* Chosen candidates as the caller sees them. */
#ifndef ASJ_SRC_MATCH_RESULT_H
#define ASJ_SRC_MATCH_RESULT_H

#include "match_run.h"
#include "places.h"

/* Turns the choices into a result, smallest distance first. NULL when out of memory. The result does not depend on the context
 * afterwards. */
asj_match_result *asj_match_result_create(const asj_match_run *run);

/* Where the matches are, as many as *count; NULL for a result that the caller has put together or copied, and for one whose
 * matches are no longer those of the call. */
const asj_place *asj_match_result_places(const asj_match_result *shown, uint32_t *count);

#endif
