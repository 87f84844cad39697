/* SPDX-License-Identifier: BSD-2-Clause */
/* Planes of the frame on the device: the whole image where a buffer may be so large, else the rows that are worked on. */
#include "planes.h"
#include "detect.h"
#include "state.h"

int32_t asj_cl_plane_rows(const asj_context *context, const asj_frame *frame)
{
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    const uint64_t row = (uint64_t)frame->stride * sizeof(int16_t), all = (uint64_t)frame->height + 2 * ASJ_MARGIN;
    const uint64_t share = limits->global_memory / 8; /* four planes in half of the memory */
    const uint64_t rows = (share < limits->largest_buffer ? share : limits->largest_buffer) / row;
    return (int32_t)(rows <= all ? rows > 0 ? rows - 1 : 0 : all); /* a row to spare: asj_cl_plane_reserve() */
}

/* The copy of a row of samples may begin at x = 0 and be as long as a row, so the last one needs more than its own. */
asj_status asj_cl_plane_reserve(asj_context *context, asj_cl_buffer *plane, const asj_frame *frame, int32_t rows)
{
    return asj_cl_reserve(context, plane, ((size_t)rows + 1) * (size_t)frame->stride * sizeof(int16_t));
}

size_t asj_cl_plane_at(const asj_frame *frame, int32_t first, int32_t y)
{
    return ((size_t)(y - first) * (size_t)frame->stride + ASJ_MARGIN) * sizeof(int16_t);
}

static asj_status upload(asj_context *context, struct asj_cl_detect *detect, const asj_frame *frame, int32_t first, int32_t last)
{
    const ptrdiff_t from = first * frame->stride - ASJ_MARGIN;
    const size_t bytes = (size_t)(last - first) * (size_t)frame->stride * sizeof(int16_t);
    asj_status status = asj_cl_plane_reserve(context, &detect->gradient_x, frame, last - first);
    if (status == ASJ_OK)
        status = asj_cl_plane_reserve(context, &detect->gradient_y, frame, last - first);
    if (status == ASJ_OK)
        status = asj_cl_write(context, &detect->gradient_x, 0, frame->gradient_x + from, bytes);
    if (status == ASJ_OK)
        status = asj_cl_write(context, &detect->gradient_y, 0, frame->gradient_y + from, bytes);
    return status;
}

asj_status asj_cl_planes_need(asj_context *context, const asj_frame *frame, int32_t top, int32_t bottom)
{
    struct asj_cl_detect *detect;
    asj_status status = asj_cl_detect_get(context, &detect);
    if (status != ASJ_OK)
        return status;
    int32_t first = top - ASJ_MARGIN, last = bottom + ASJ_MARGIN;
    if (detect->frame == frame && detect->width == frame->width && detect->height == frame->height && detect->first <= first &&
        detect->last >= last)
        return ASJ_OK;
    if (asj_cl_plane_rows(context, frame) == frame->height + 2 * ASJ_MARGIN) {
        first = -ASJ_MARGIN;
        last = frame->height + ASJ_MARGIN;
    }
    asj_cl_planes_forget(context);
    status = upload(context, detect, frame, first, last);
    if (status != ASJ_OK)
        return status;
    detect->frame = frame;
    detect->width = frame->width;
    detect->height = frame->height;
    detect->first = first;
    detect->last = last;
    return ASJ_OK;
}

void asj_cl_planes_forget(asj_context *context)
{
    if (context->cl && context->cl->detect) {
        context->cl->detect->frame = NULL;
        context->cl->detect->generation++;
    }
}
