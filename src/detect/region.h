/* SPDX-License-Identifier: BSD-2-Clause */
/* Where junctions are looked for: a rectangle of the image, a mask, or both. */
#ifndef ASJ_SRC_REGION_H
#define ASJ_SRC_REGION_H

#include "detection_run.h"

/* Checks the caller's region: ASJ_OK, or the status and message that asj_detect_region() documents. NULL = everywhere. */
asj_status asj_region_check(asj_context *context, const asj_image *image, const asj_region *region);

/* Rows *top .. *bottom - 1 of the run's octave in which candidates may lie. */
void asj_region_rows(const asj_detection_run *run, int32_t *top, int32_t *bottom);

/* Clears the candidates of the run's octave from which no junction can come to lie in the region. */
asj_status asj_region_clear_candidates(asj_detection_run *run);

/* Drops hypotheses, in pixels of the image, that lie outside. Returns how many stay. */
size_t asj_region_keep(const asj_image *image, const asj_region *region, asj_hypothesis *hypotheses, size_t count);

#endif
