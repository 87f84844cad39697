/* SPDX-License-Identifier: BSD-2-Clause */
/* The operations that a device takes over, and what frees what their files keep. Each file keeps its buffers in a struct of its
 * own, which it allocates at first use and hangs into struct asj_cl (state.h). */
#ifndef ASJ_SRC_CL_OVERRIDES_H
#define ASJ_SRC_CL_OVERRIDES_H

#include "detect/isotropic.h"
#include "detect/scan.h"
#include "match/describe.h"
#include "match/shortlist.h"

/* gradient_ops.c, field_ops.c, isotropic_ops.c; for what they keep see detect.h */
asj_status asj_cl_gradient(asj_context *context, asj_frame *frame, const asj_detect_options *options);
asj_status asj_cl_field_rows(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                             const asj_scratch *scratch, uint16_t *masks);
asj_status asj_cl_isotropic_rows(asj_context *context, const asj_isotropic *test, const asj_frame *frame,
                                 const asj_candidate_rows *rows, const asj_scratch *scratch, asj_isotropic_junction *junctions);

/* scan_ops.c; struct asj_cl_scan in context->cl->scan */
asj_status asj_cl_field_branches(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                                 const asj_scratch *scratch, asj_field_branch (*branches)[ASJ_FIELD_BRANCHES]);
asj_status asj_cl_scan_rays(asj_context *context, const asj_scan *scan, const asj_frame *frame, const asj_scratch *scratch,
                            asj_ray *rays, size_t count);
void asj_cl_free_scan(asj_context *context);

/* match_ops.c; struct asj_cl_match in context->cl->match */
asj_status asj_cl_describe_frames(asj_context *context, const asj_match_options *options, asj_image_features *features);
asj_status asj_cl_rank_partners(const asj_match_run *run, asj_partner *rows, asj_partner *columns);
void asj_cl_free_match(asj_context *context);

#endif
