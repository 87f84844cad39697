/* SPDX-License-Identifier: BSD-2-Clause */
/* The last test of chosen matches: by the matches around them. */
#ifndef ASJ_SRC_VERIFY_H
#define ASJ_SRC_VERIFY_H

#include "match_run.h"

/* Drops choices that the choices around them contradict; the order of the others stays. The first `fixed` of them stay, and if
 * there are any the others are judged by these alone. */
asj_status asj_verify(asj_match_run *run, size_t fixed);

#endif
