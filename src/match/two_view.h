/* SPDX-License-Identifier: BSD-2-Clause */
/* The geometry of the pair, and what it does to the matches. */
#ifndef ASJ_SRC_MATCH_TWO_VIEW_H
#define ASJ_SRC_MATCH_TWO_VIEW_H

#include "match_run.h"

/* Sets *may to 0 where fewer candidates show that there is none, and run->geometry to what they show: for images of which
 * asj_related() says that they have little in common. */
asj_status asj_geometry_may_be(asj_match_run *run, int32_t *may);

/* Estimates it; where one is accepted it decides (verdict.h). */
asj_status asj_apply_geometry(asj_match_run *run);

#endif
