/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches at one place in both images. */
#ifndef ASJ_SRC_SAME_PLACE_H
#define ASJ_SRC_SAME_PLACE_H

#include "match_result.h"

/* Of matches that lie within a pixel of each other in both images the best one stays. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED; then
 * nothing has changed. */
asj_status asj_same_place(asj_context *context, asj_match_result *shown);

#endif
