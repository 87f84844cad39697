/* SPDX-License-Identifier: BSD-2-Clause */
/* Buffers of the device, and transfers to and from them. */
#include "command.h"
#include "error.h"
#include "state.h"

#include <stdio.h>

asj_status asj_cl_reserve(asj_context *context, asj_cl_buffer *buffer, size_t bytes)
{
    struct asj_cl *cl = context->cl;
    char subject[48];
    cl_int error = CL_SUCCESS;
    if (bytes == 0)
        bytes = 1;
    if (buffer->size >= bytes)
        return ASJ_OK;
    asj_cl_release(context, buffer);
    snprintf(subject, sizeof subject, "%zu bytes", bytes);
    if (bytes > cl->limits.largest_buffer)
        return asj_cl_fail(context, "CreateBuffer", subject, CL_INVALID_BUFFER_SIZE);
    buffer->memory = cl->api.CreateBuffer(cl->context, CL_MEM_READ_WRITE, bytes, NULL, &error);
    if (!buffer->memory)
        return asj_cl_fail(context, "CreateBuffer", subject, error);
    buffer->size = bytes;
    return ASJ_OK;
}

void asj_cl_release(asj_context *context, asj_cl_buffer *buffer)
{
    if (buffer->memory)
        context->cl->api.ReleaseMemObject(buffer->memory);
    buffer->memory = NULL;
    buffer->size = 0;
}

/* ---- transfers ---- */

asj_status asj_cl_write(asj_context *context, asj_cl_buffer *buffer, size_t offset, const void *data, size_t bytes)
{
    struct asj_cl *cl = context->cl;
    cl_event event;
    if (bytes == 0)
        return ASJ_OK;
    const cl_int error = cl->api.EnqueueWriteBuffer(cl->queue, buffer->memory, CL_TRUE, offset, bytes, data, 0, NULL,
                                                    asj_cl_timed(context, &event));
    return asj_cl_end(context, "EnqueueWriteBuffer", NULL, ASJ_CL_WRITE, bytes, error, event);
}

asj_status asj_cl_read(asj_context *context, const asj_cl_buffer *buffer, size_t offset, void *data, size_t bytes)
{
    struct asj_cl *cl = context->cl;
    cl_event event;
    if (bytes == 0)
        return ASJ_OK;
    const cl_int error = cl->api.EnqueueReadBuffer(cl->queue, buffer->memory, CL_TRUE, offset, bytes, data, 0, NULL,
                                                   asj_cl_timed(context, &event));
    return asj_cl_end(context, "EnqueueReadBuffer", NULL, ASJ_CL_READ, bytes, error, event);
}

asj_status asj_cl_write_rows(asj_context *context, asj_cl_buffer *buffer, size_t offset, size_t pitch, const void *data,
                             size_t data_pitch, size_t row_bytes, size_t rows)
{
    struct asj_cl *cl = context->cl;
    const size_t host[3] = {0, 0, 0}, region[3] = {row_bytes, rows, 1};
    cl_event event;
    if (rows <= 1 || row_bytes == 0 || (pitch == row_bytes && data_pitch == row_bytes))
        return asj_cl_write(context, buffer, offset, data, rows * row_bytes);
    const size_t origin[3] = {offset % pitch, offset / pitch, 0};
    const cl_int error = cl->api.EnqueueWriteBufferRect(cl->queue, buffer->memory, CL_TRUE, origin, host, region, pitch, 0,
                                                        data_pitch, 0, data, 0, NULL, asj_cl_timed(context, &event));
    return asj_cl_end(context, "EnqueueWriteBufferRect", NULL, ASJ_CL_WRITE, rows * row_bytes, error, event);
}

asj_status asj_cl_read_rows(asj_context *context, const asj_cl_buffer *buffer, size_t offset, size_t pitch, void *data,
                            size_t data_pitch, size_t row_bytes, size_t rows)
{
    struct asj_cl *cl = context->cl;
    const size_t host[3] = {0, 0, 0}, region[3] = {row_bytes, rows, 1};
    cl_event event;
    if (rows <= 1 || row_bytes == 0 || (pitch == row_bytes && data_pitch == row_bytes))
        return asj_cl_read(context, buffer, offset, data, rows * row_bytes);
    const size_t origin[3] = {offset % pitch, offset / pitch, 0};
    const cl_int error = cl->api.EnqueueReadBufferRect(cl->queue, buffer->memory, CL_TRUE, origin, host, region, pitch, 0,
                                                       data_pitch, 0, data, 0, NULL, asj_cl_timed(context, &event));
    return asj_cl_end(context, "EnqueueReadBufferRect", NULL, ASJ_CL_READ, rows * row_bytes, error, event);
}

asj_status asj_cl_zero(asj_context *context, asj_cl_buffer *buffer, size_t offset, size_t bytes)
{
    static const cl_uchar zero = 0;
    struct asj_cl *cl = context->cl;
    cl_event event;
    if (bytes == 0)
        return ASJ_OK;
    const cl_int error = cl->api.EnqueueFillBuffer(cl->queue, buffer->memory, &zero, sizeof zero, offset, bytes, 0, NULL,
                                                   asj_cl_timed(context, &event));
    return asj_cl_end(context, "EnqueueFillBuffer", NULL, ASJ_CL_ZERO, bytes, error, event);
}
