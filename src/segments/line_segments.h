/* SPDX-License-Identifier: BSD-2-Clause */
/* Straight line segments of an image: where preset paper looks for junctions, and what tells the directions of a room. */
#ifndef ASJ_SRC_LINE_SEGMENTS_H
#define ASJ_SRC_LINE_SEGMENTS_H

#include "core/image.h"

typedef struct asj_line_segment {
    double x1, y1, x2, y2; /* px; from 1 to 2 the dark side is on the right */
    double width;          /* px */
    double log_nfa;        /* natural logarithm */
} asj_line_segment;

typedef struct asj_line_segments {
    asj_line_segment *list;
    size_t count;
} asj_line_segments;

/* The segments of the image in frame->gray with at most `epsilon` false alarms, those with the steepest gradient first; of the
 * frame nothing else is looked at but its size and stride. stage: ASJ_STAGE_..., of which the caller hears. The list is the
 * caller's, to be released with the context's memory; NULL when there is none.
 * ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED: nothing is held then. */
asj_status asj_line_segments_find(asj_context *context, const asj_frame *frame, int32_t stage, double epsilon,
                                  asj_line_segment **segments, size_t *count);

/* The same of one or two images, each by a thread; a list for each. */
#define ASJ_SEGMENT_IMAGES 2
asj_status asj_line_segments_find_each(asj_context *context, const asj_frame *frames, int32_t count, int32_t stage, double epsilon,
                                       asj_line_segments *found);

#endif
