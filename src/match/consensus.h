/* SPDX-License-Identifier: BSD-2-Clause */
/* Relaxation: candidates that agree with their neighbours gain. */
#ifndef ASJ_SRC_CONSENSUS_H
#define ASJ_SRC_CONSENSUS_H

#include "match_run.h"

/* The support that a match needs between images with so many locations: see consensus.c. */
float asj_needed_support(const asj_match_run *run);

/* Fills support and score of every candidate from run->support. Without neighbours the score is 1 / distance. */
asj_status asj_consensus(asj_match_run *run);

#endif
