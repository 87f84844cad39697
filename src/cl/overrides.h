/* SPDX-License-Identifier: BSD-2-Clause */
/* The operations that a device takes over, by file. Each file keeps its buffers in a struct of its own, which it allocates at first
 * use, hangs into struct asj_cl (state.h) and frees here. */
#ifndef ASJ_SRC_CL_OVERRIDES_H
#define ASJ_SRC_CL_OVERRIDES_H

#include "ops.h"

/* detect_ops.c: gradient, field_rows, isotropic_rows; struct asj_cl_detect in context->cl->detect */
void asj_cl_fill_detect(asj_ops *ops);
void asj_cl_free_detect(asj_context *context);

/* scan_ops.c: scan_rays; struct asj_cl_scan in context->cl->scan */
void asj_cl_fill_scan(asj_ops *ops);
void asj_cl_free_scan(asj_context *context);

/* match_ops.c: patches, distances; struct asj_cl_match in context->cl->match */
void asj_cl_fill_match(asj_ops *ops);
void asj_cl_free_match(asj_context *context);

#endif
