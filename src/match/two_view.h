/* SPDX-License-Identifier: BSD-2-Clause */
/* The geometry of the pair, and what it does to the matches. */
#ifndef ASJ_SRC_MATCH_TWO_VIEW_H
#define ASJ_SRC_MATCH_TWO_VIEW_H

#include "match_run.h"

/* Estimates it; where one is accepted it decides (verdict.h). */
asj_status asj_apply_geometry(asj_match_run *run);

#endif
