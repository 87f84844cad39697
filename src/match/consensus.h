/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_CONSENSUS_H
#define ASJ_SRC_CONSENSUS_H

#include "support.h"

/* The support that a match needs between images with so many places: see consensus.c. */
float asj_needed_support(const asj_match_options *options, const asj_corners *corners1, const asj_corners *corners2);

/* Fills support and score of every candidate. Without neighbours the score is 1 / distance. `supporters` is kept between calls of
 * one match. */
asj_status asj_consensus(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         asj_candidates *candidates, asj_support *supporters);

#endif
