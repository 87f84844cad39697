/* SPDX-License-Identifier: BSD-2-Clause */
/* The choice of matches among the candidates. */
#ifndef ASJ_SRC_ASSIGN_H
#define ASJ_SRC_ASSIGN_H

#include "match_run.h"

/* Chooses matches by score: run->choices. See assign.c. */
asj_status asj_assign(asj_match_run *run);

#endif
