/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 4: the length of a branch by the a-contrario test along a ray. */
#ifndef ASJ_SRC_SCAN_H
#define ASJ_SRC_SCAN_H

#include "ray.h"

/* All but the numbers of tests. */
void asj_scan_prepare(const asj_detect_options *options, const asj_field *field, const struct asj_scan_cache *cache,
                      asj_scan *scan);

/* Sets the number of tests for an image of this size, and the threshold that follows from it. */
void asj_scan_set_size(const asj_detect_options *options, int32_t width, int32_t height, asj_scan *scan);

/* Follows `count` rays. Scratch: asj_field_scratch() for as many threads as the context has. */
asj_status asj_scan_rays(asj_context *context, const asj_scan *scan, const asj_frame *frame, const asj_scratch *scratch,
                         asj_ray *rays, size_t count);

/* Operations (core/ops.h). */
typedef struct asj_scan_ops {
    /* asj_scan_rays() */
    asj_status (*rays)(asj_context *context, const asj_scan *scan, const asj_frame *frame, const asj_scratch *scratch,
                       asj_ray *rays, size_t count);
} asj_scan_ops;
extern const asj_scan_ops asj_scan_reference;

#endif
