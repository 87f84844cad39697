/* SPDX-License-Identifier: BSD-2-Clause */
/* The matches of a result as segment matches. */
#ifndef ASJ_SRC_SEGMENT_MATCHES_H
#define ASJ_SRC_SEGMENT_MATCHES_H

#include "around.h"

/* asj_match_segments(). `around` holds the result's matches; its places may be of more than these; without them every segment is
 * compared with every match. */
size_t asj_segment_matches(const asj_match_result *result, const asj_around *around, int32_t minimum_end,
                           asj_segment_match *segments, size_t capacity);

#endif
