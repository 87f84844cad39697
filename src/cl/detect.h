/* SPDX-License-Identifier: BSD-2-Clause */
/* What the detector keeps on the device between its steps and from image to image. */
#ifndef ASJ_SRC_CL_DETECT_H
#define ASJ_SRC_CL_DETECT_H

#include "detect/isotropic.h"
#include "runtime.h"

/* Numbers that a kernel looks up, kept on the device until they change. */
typedef struct asj_cl_table {
    asj_cl_buffer buffer;
    void *held;  /* what the buffer holds: `held_count` numbers */
    void *draft; /* where new ones are written: asj_cl_table_begin() */
    size_t held_count, held_capacity, draft_capacity;
} asj_cl_table;

/* Memory of the host that only grows. */
typedef struct asj_cl_host_buffer {
    void *memory;
    size_t capacity; /* bytes */
} asj_cl_host_buffer;

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

/* ---- planes.c ---- */

/* How many rows of a plane, margins included, a buffer of the device may hold; at most those of the frame. */
int32_t asj_cl_plane_rows(const asj_context *context, const asj_frame *frame);

/* Room for that many rows of a plane. */
asj_status asj_cl_plane_reserve(asj_context *context, asj_cl_buffer *plane, const asj_frame *frame, int32_t rows);

/* Where in a plane that starts with row `first` sample (0, y) stands, in bytes. */
size_t asj_cl_plane_at(const asj_frame *frame, int32_t first, int32_t y);

/* Makes sure that the gradient of rows top - ASJ_MARGIN .. bottom + ASJ_MARGIN - 1 is on the device: where it does not hold that of
 * this frame, it is taken from the host. The frame's gradient must be what asj_ops.gradient made of it with this context, or
 * asj_cl_planes_forget() be called first. */
asj_status asj_cl_planes_need(asj_context *context, const asj_frame *frame, int32_t top, int32_t bottom);

/* The gradient on the device is no frame's. */
void asj_cl_planes_forget(asj_context *context);

/* ---- table.c ---- */

/* `most` numbers to be filled. */
asj_status asj_cl_table_begin(asj_context *context, asj_cl_table *table, size_t most, int32_t **numbers);

/* The first `count` of them are the table. */
asj_status asj_cl_table_end(asj_context *context, asj_cl_table *table, size_t count);
void asj_cl_table_free(asj_context *context, asj_cl_table *table);

/* Makes it at least that large; its contents are lost. */
asj_status asj_cl_host_reserve(asj_context *context, asj_cl_host_buffer *buffer, size_t bytes);

/* ---- asj_ops ---- */

asj_status asj_cl_gradient(asj_context *context, asj_frame *frame, const asj_detect_options *options); /* gradient_ops.c */

asj_status asj_cl_field_rows(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                             uint16_t *scratch, size_t scratch_size, uint16_t *masks); /* field_ops.c */

asj_status asj_cl_isotropic_rows(asj_context *context, const asj_isotropic *test, const asj_frame *frame, int32_t top,
                                 int32_t bottom, const uint16_t *masks, const size_t *starts, uint16_t *scratch,
                                 size_t scratch_size, asj_isotropic_junction *junctions); /* isotropic_ops.c */

#endif
