/* SPDX-License-Identifier: BSD-2-Clause */
/* The length hypotheses and frames of L-junctions (l_junctions.h). */
#ifndef ASJ_SRC_FRAMES_H
#define ASJ_SRC_FRAMES_H

#include "l_junctions.h"
#include "location_grid.h"

/* Sets lengths (but for what is at the ends), direction, first_frame, frames and frame_count; `grid` has the locations that may
 * lengthen or shorten a branch. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_frames_make(asj_context *context, const asj_match_options *options, const asj_location_grid *grid,
                           asj_l_junctions *all);

#endif
