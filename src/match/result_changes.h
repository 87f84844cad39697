/* SPDX-License-Identifier: BSD-2-Clause */
/* A result that another one of the same images changes, or another view of what it is in. */
#ifndef ASJ_SRC_RESULT_CHANGES_H
#define ASJ_SRC_RESULT_CHANGES_H

#include "match_result.h"

/* The matches whose probability is negative are rejected, others have theirs from now on. Of those that were rejected before, the
 * ones whose own is negative, too, stay so (NULL: none), and the others are forgotten. ASJ_ERROR_MEMORY. */
asj_status asj_match_result_judge(asj_context *context, asj_match_result *shown, const float *probability,
                                  const float *of_rejected);

/* Adds the matches and rejected ones of another result of the same images that are wanted, with their L-junctions and numbers of
 * junctions of their own, unless both have the same lists. Without a match at one place twice: see upsampled.c.
 * ASJ_ERROR_MEMORY. */
asj_status asj_match_result_join(asj_context *context, asj_match_result *shown, const asj_match_result *other,
                                 const uint8_t *wanted, const uint8_t *wanted_rejected, int32_t same_lists);

/* Numbers the L-junctions of image 1 (side 0) or 2 as asj_decompose() does those of all junctions, where the result knows those of
 * octaves 0 and up alone. ASJ_ERROR_MEMORY. */
asj_status asj_match_result_number(asj_context *context, asj_match_result *shown, int32_t side, double minimum_opening,
                                   const asj_junction *junctions, size_t count);

/* A result of stretched images -> one of the images themselves (unstretch.h). */
void asj_match_result_unstretch(asj_match_result *shown, const asj_stretch by[2]);

#endif
