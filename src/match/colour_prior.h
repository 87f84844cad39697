/* SPDX-License-Identifier: BSD-2-Clause */
/* How well the colours of candidates agree. */
#ifndef ASJ_SRC_MATCH_COLOUR_PRIOR_H
#define ASJ_SRC_MATCH_COLOUR_PRIOR_H

#include "match_run.h"

/* One number for each candidate of the run, both of whose images have colours; 0: as well as most do, or nothing to compare.
 * probability: that it is right, as far as is known before. ASJ_ERROR_MEMORY. */
asj_status asj_colour_agreement(const asj_match_run *run, const double *probability, double *agreement);

#endif
