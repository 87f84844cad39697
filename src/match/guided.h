/* SPDX-License-Identifier: BSD-2-Clause */
/* Guided matching: matches propose matches near them. */
#ifndef ASJ_SRC_GUIDED_H
#define ASJ_SRC_GUIDED_H

#include "match_run.h"

/* Appends the pairs that chosen matches propose and that are not candidates yet: compared, aligned, in order. Of guests
 * where the run says what is taken, else of the others. */
asj_status asj_guided(asj_match_run *run);

#endif
