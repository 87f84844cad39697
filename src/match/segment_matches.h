/* SPDX-License-Identifier: BSD-2-Clause */
/* The matches of a result as segment matches. */
#ifndef ASJ_SRC_SEGMENT_MATCHES_H
#define ASJ_SRC_SEGMENT_MATCHES_H

#include "places.h"

/* asj_match_segments() with the places of the result's matches, which may be more than it has now; without them (NULL) every
 * segment is compared with every match. */
size_t asj_segment_matches(const asj_match_result *result, const asj_place *places, uint32_t place_count, int32_t minimum_end,
                           asj_segment_match *segments, size_t capacity);

#endif
