/* SPDX-License-Identifier: BSD-2-Clause */
/* The geometry of the pair, and what it does to the matches. */
#ifndef ASJ_SRC_MATCH_TWO_VIEW_H
#define ASJ_SRC_MATCH_TWO_VIEW_H

#include "match_run.h"

/* Nothing when options->geometry.model is none: see two_view.c. */
asj_status asj_apply_geometry(asj_match_run *run);

#endif
