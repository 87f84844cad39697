/* SPDX-License-Identifier: BSD-2-Clause */
/* What the device operations are written with: buffers, transfers, kernel runs. One in-order queue for each context.
 *
 * Every failure ends in asj_fail(context, ASJ_ERROR_DEVICE, ...), which names the call, the kernel, OpenCL's error and the device.
 * Nothing here may be called while context->cl is NULL. */
#ifndef ASJ_SRC_CL_RUNTIME_H
#define ASJ_SRC_CL_RUNTIME_H

#include "core/context.h"

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
#include <CL/cl.h>

/* ---- the device ---- */

typedef struct asj_cl_limits {
    size_t max_work_group;      /* work-items in a work-group */
    size_t max_work_item[3];    /* and along each axis */
    uint64_t local_memory;      /* bytes for a work-group */
    uint64_t largest_buffer;    /* bytes */
    uint64_t global_memory;     /* bytes */
    uint32_t compute_units;
    int32_t type;               /* ASJ_DEVICE_... (asj/device.h) */
} asj_cl_limits;

/* ---- buffers: kept from image to image, grown when needed ---- */

typedef struct asj_cl_buffer { /* all zero = empty */
    cl_mem memory;
    size_t size; /* bytes */
} asj_cl_buffer;

/* Makes it at least `bytes` large (0 = at least one byte); the contents are undefined after growth. */
asj_status asj_cl_reserve(asj_context *context, asj_cl_buffer *buffer, size_t bytes);

/* Releases the memory; an empty one is fine. */
void asj_cl_release(asj_context *context, asj_cl_buffer *buffer);

/* ---- transfers: blocking; 0 bytes or 0 rows are fine ---- */

asj_status asj_cl_write(asj_context *context, asj_cl_buffer *buffer, size_t offset, const void *data, size_t bytes);
asj_status asj_cl_read(asj_context *context, const asj_cl_buffer *buffer, size_t offset, void *data, size_t bytes);

/* `rows` rows of `row_bytes`, `pitch` bytes apart in the buffer from `offset` on, `data_pitch` bytes apart on the host. */
asj_status asj_cl_write_rows(asj_context *context, asj_cl_buffer *buffer, size_t offset, size_t pitch, const void *data,
                             size_t data_pitch, size_t row_bytes, size_t rows);
asj_status asj_cl_read_rows(asj_context *context, const asj_cl_buffer *buffer, size_t offset, size_t pitch, void *data,
                            size_t data_pitch, size_t row_bytes, size_t rows);

/* Fills with zeros; not waited for. */
asj_status asj_cl_zero(asj_context *context, asj_cl_buffer *buffer, size_t offset, size_t bytes);

/* ---- kernels ---- */

enum { ASJ_CL_KIND_MEMORY, ASJ_CL_KIND_NUMBER, ASJ_CL_KIND_LOCAL, ASJ_CL_KIND_VALUE };
typedef struct asj_cl_argument {
    int32_t kind;
    uint32_t number;
    size_t size;
    const void *value;
} asj_cl_argument;

/* One for each parameter of the kernel, in order:
 * const asj_cl_argument arguments[] = {ASJ_CL_BUFFER(&plane), ASJ_CL_INT(width)}; */
#define ASJ_CL_BUFFER(buffer) {ASJ_CL_KIND_MEMORY, 0, sizeof(cl_mem), &(buffer)->memory}      /* __global or __constant */
#define ASJ_CL_INT(integer) {ASJ_CL_KIND_NUMBER, (uint32_t)(int32_t)(integer), 4, NULL}       /* int */
#define ASJ_CL_LOCAL(bytes) {ASJ_CL_KIND_LOCAL, 0, (size_t)(bytes), NULL}                     /* __local */
#define ASJ_CL_STRUCT(pointer, bytes) {ASJ_CL_KIND_VALUE, 0, (size_t)(bytes), (pointer)}      /* anything by value, float too */

typedef struct asj_cl_arguments {
    const asj_cl_argument *list;
    int32_t count;
} asj_cl_arguments;

/* All of an array. */
#define ASJ_CL_ARGUMENTS(array) ((asj_cl_arguments){(array), (int32_t)(sizeof(array) / sizeof *(array))})

/* Puts a kernel of kernels/NAME.cl into the queue and does not wait. Builds its program when this is the first use. `local` NULL =
 * the device chooses; else each global size must be a multiple of the local one. A global size of 0 is fine: nothing runs. */
asj_status asj_cl_run(asj_context *context, const char *kernel, int32_t dimensions, const size_t *global, const size_t *local,
                      asj_cl_arguments arguments);

/* The largest work-group that this kernel can run with on the device, and the preferred multiple of its size. Either pointer may be
 * NULL. Builds the program as well. */
asj_status asj_cl_kernel_limits(asj_context *context, const char *kernel, size_t *max_work_group, size_t *multiple);

/* Waits until everything in the queue is done. */
asj_status asj_cl_finish(asj_context *context);

/* ---- device time: what tests and benchmarks ask; the library itself never does ---- */

typedef struct asj_cl_time {
    const char *name; /* of the kernel, or "write", "read", "zero"; a static string */
    uint64_t runs;
    uint64_t bytes;   /* transfers */
    double ms;        /* on the device, between start and end of the commands */
} asj_cl_time;

/* Switches the measurement on or off (off at first) and sets all sums to zero. While it is on, every command is waited for. */
asj_status asj_cl_profile(asj_context *context, int32_t on);

/* What was used since, in order of the names' first appearance in the program; writes at most `capacity` and returns how many. */
int32_t asj_cl_get_times(const asj_context *context, asj_cl_time *times, int32_t capacity);

#endif
