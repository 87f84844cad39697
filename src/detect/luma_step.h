/* SPDX-License-Identifier: BSD-2-Clause */
/* What the detector finds in an image's luma, kept for another pass over the same image that looks at its colours, too. */
#ifndef ASJ_SRC_LUMA_STEP_H
#define ASJ_SRC_LUMA_STEP_H

#include "hypothesis.h"
#include "edge_evidence.h"
#include "core/context.h"

/* All zeros: nothing yet. */
typedef struct asj_luma_found {
    int32_t is_known;
    asj_hypothesis *found; /* in pixels of the image, */
    asj_evidence *evidence; /* which their branches name */
    size_t found_count, evidence_count, candidates, isotropic;
} asj_luma_found;

/* asj_detect() of an image whose luma is known with these options but for `colours`; without colours it is known afterwards, where
 * it can be kept (luma_step.c). luma is to be freed, whatever is returned. */
asj_status asj_detect_with_luma(asj_context *context, const asj_image *image, const asj_detect_options *options,
                                asj_luma_found *luma, asj_detection **result);
void asj_luma_found_free(asj_memory *memory, asj_luma_found *luma);

#endif
