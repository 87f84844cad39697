/* SPDX-License-Identifier: BSD-2-Clause */
/* What the detector keeps on the device between its steps and from image to image. */
#ifndef ASJ_SRC_CL_DETECT_H
#define ASJ_SRC_CL_DETECT_H

#include "core/image.h"
#include "table.h"

/* Planes have the layout of asj_frame, margins included: sample (x, y) at [(y - first) * stride + x + ASJ_MARGIN]. */
struct asj_cl_detect {
    asj_cl_buffer gray, norms;
    asj_cl_buffer gradient_x, gradient_y; /* those of `frame`, rows first .. last - 1; frame NULL = of none */
    const asj_frame *frame;
    int32_t width, height, first, last;
    uint64_t generation; /* of the gradient on the device: another number whenever it may have changed */
    asj_cl_table field_table, isotropic_table;
    asj_cl_buffer masks, candidates, peaks;
    asj_cl_host_buffer host_candidates, host_peaks;
};

/* The struct, made at the first call. */
asj_status asj_cl_detect_get(asj_context *context, struct asj_cl_detect **detect);

void asj_cl_free_detect(asj_context *context);

#endif
