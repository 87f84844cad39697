/* SPDX-License-Identifier: BSD-2-Clause */
/* The candidates of a geometry, before they are aligned. */
#ifndef ASJ_SRC_MATCH_WIDE_SHORTLIST_H
#define ASJ_SRC_MATCH_WIDE_SHORTLIST_H

#include "match_run.h"

/* Those of options->shortlist best partners of every L-junction of either image, by colours where both images have some: then
 * run->colours are there, too, until asj_wide_shortlist_free(), also after a failure. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED,
 * ASJ_ERROR_DEVICE. */
asj_status asj_wide_shortlist(asj_match_run *run);
void asj_wide_shortlist_free(asj_match_run *run);

#endif
