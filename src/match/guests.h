/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches of junctions of other octaves than the finest. */
#ifndef ASJ_SRC_GUESTS_H
#define ASJ_SRC_GUESTS_H

#include "match_run.h"

/* Adds the matches of guests (l_junctions.h) to the choices, which stay as they are and come first: see guests.c. */
asj_status asj_match_guests(asj_match_run *run);

#endif
