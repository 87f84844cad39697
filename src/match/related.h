/* SPDX-License-Identifier: BSD-2-Clause */
/* Whether two images have anything in common, told from a part of the work. */
#ifndef ASJ_SRC_RELATED_H
#define ASJ_SRC_RELATED_H

#include "match_run.h"

/* Sets *support to the second largest support of their likeliest candidates: below option related_support nothing speaks for it.
 * The images as the run has them, of which nothing else is read or set. HUGE_VAL where that option is 0, or nothing can be said. */
asj_status asj_related(const asj_match_run *run, double *support);

#endif
