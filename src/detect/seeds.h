/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 of preset paper: where line segments say that a junction may be. */
#ifndef ASJ_SRC_SEEDS_H
#define ASJ_SRC_SEEDS_H

#include "segments/line_segments.h"

/* Fills `masks`, one bit for each pixel of the frame: run b of row y at [y * frame->blocks + b]. A pixel is a candidate when one of
 * the image's line segments, or two of them, put a seed within options->seed_radius of it (seeds.c). */
asj_status asj_seeds_mark(asj_context *context, const asj_frame *frame, const asj_detect_options *options, uint16_t *masks);

/* ---- parts of it ---- */

/* Whether the lines of two segments that open enough meet no farther than `gap` px from either segment, and where. */
int asj_seeds_meet(const asj_line_segment *a, const asj_line_segment *b, double gap, double *x, double *y);

/* Whether an end of segment a, (x, y), is no farther than `gap` px from segment b, which opens enough from it. */
int asj_seeds_ends_at(const asj_line_segment *a, double x, double y, const asj_line_segment *b, double gap);

#endif
