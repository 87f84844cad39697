/* SPDX-License-Identifier: BSD-2-Clause */
/* Planes of the frame on the device. */
#ifndef ASJ_SRC_CL_PLANES_H
#define ASJ_SRC_CL_PLANES_H

#include "core/image.h"
#include "runtime.h"

/* How many rows of a plane, margins included, a buffer of the device may hold; at most those of the frame. */
int32_t asj_cl_plane_rows(const asj_context *context, const asj_frame *frame);

/* Room for that many rows of a plane. */
asj_status asj_cl_plane_reserve(asj_context *context, asj_cl_buffer *plane, const asj_frame *frame, int32_t rows);

/* Where in a plane that starts with row `first` sample (0, y) stands, in bytes. */
size_t asj_cl_plane_at(const asj_frame *frame, int32_t first, int32_t y);

/* Makes sure that the gradient of rows top - ASJ_MARGIN .. bottom + ASJ_MARGIN - 1 is on the device: where it does not hold that of
 * this frame, it is taken from the host. The frame's gradient must be what asj_gradient_ops.planes made of it with this context, or
 * asj_cl_planes_forget() be called first. */
asj_status asj_cl_planes_need(asj_context *context, const asj_frame *frame, int32_t top, int32_t bottom);

/* The gradient on the device is no frame's. */
void asj_cl_planes_forget(asj_context *context);

#endif
