/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, last but one test: the fundamental matrix of the matches themselves. */
#ifndef ASJ_SRC_EPIPOLAR_H
#define ASJ_SRC_EPIPOLAR_H

#include "match_run.h"

/* Drops choices that the fundamental matrix of all of them contradicts. */
asj_status asj_verify_epipolar(asj_match_run *run);

/* Drops the choices from number `first` on that do. */
void asj_drop_off_lines(asj_match_run *run, size_t first);

#endif
