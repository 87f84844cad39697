/* SPDX-License-Identifier: BSD-2-Clause */
/* Whether two images have anything in common, told from a part of the work. */
#ifndef ASJ_SRC_RELATED_H
#define ASJ_SRC_RELATED_H

#include "match_run.h"

/* Sets *related to 0 when nothing speaks for it; the images as the run has them, of which nothing else is read or set. 1 where
 * option related_support is 0, or nothing can be said. */
asj_status asj_related(const asj_match_run *run, int32_t *related);

#endif
