/* SPDX-License-Identifier: BSD-2-Clause */
/* How probable a candidate is before any geometry. */
#ifndef ASJ_SRC_MATCH_PRIOR_H
#define ASJ_SRC_MATCH_PRIOR_H

#include "match_run.h"

/* One number for each candidate of the run: see prior.c. colours: how well its colours agree (colour_prior.c); 0 where images have
 * none. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_candidate_priors(const asj_match_run *run, double *prior, double *colours);

#endif
