/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 1 on the device (kernels/gradient.cl). The planes stay there for the steps that follow, when they fit; the host has them
 * too, for the steps that look at single junctions. */
#include "kernels/contract.h"
#include "detect.h"
#include "detect/gradient.h"
#include "overrides.h"
#include "planes.h"
#include "state.h"

#include <math.h>

/* Runs a kernel of gradient.cl for whole rows, margins included, so many by each work item. */
static asj_status run(asj_context *context, const char *kernel, const asj_frame *frame, int32_t row_count, int32_t by_item,
                      asj_cl_arguments arguments)
{
    static const size_t local[2] = {16, 4};
    const size_t columns = (size_t)frame->stride / GRADIENT_PIXELS, rows = (size_t)((row_count + by_item - 1) / by_item);
    const size_t global[2] = {(columns + local[0] - 1) / local[0] * local[0], (rows + local[1] - 1) / local[1] * local[1]};
    return asj_cl_run(context, kernel, 2, global, local, arguments);
}

/* The gradient of rows top .. bottom - 1, on the device. With `margins` those too, so that the planes are complete. */
static asj_status calculate(asj_context *context, struct asj_cl_detect *detect, const asj_frame *frame, int32_t top, int32_t bottom,
                            int32_t margins, int32_t epsilon)
{
    const int32_t base = top - ASJ_MARGIN, reach = margins ? ASJ_MARGIN : 2, more = margins ? ASJ_MARGIN : 0;
    const int32_t stride = (int32_t)frame->stride;
    const asj_cl_argument norms[] = {
        ASJ_CL_BUFFER(&detect->gray), ASJ_CL_BUFFER(&detect->norms), ASJ_CL_INT(frame->width), ASJ_CL_INT(frame->height),
        ASJ_CL_INT(stride), ASJ_CL_INT(base), ASJ_CL_INT(top - reach), ASJ_CL_INT(bottom + reach)};
    const asj_cl_argument normalise[] = {
        ASJ_CL_BUFFER(&detect->gray), ASJ_CL_BUFFER(&detect->norms), ASJ_CL_BUFFER(&detect->gradient_x),
        ASJ_CL_BUFFER(&detect->gradient_y), ASJ_CL_INT(frame->width), ASJ_CL_INT(frame->height), ASJ_CL_INT(stride),
        ASJ_CL_INT(base), ASJ_CL_INT(top - more), ASJ_CL_INT(bottom + more), ASJ_CL_INT(epsilon)};
    asj_status status = run(context, "gradient_norms", frame, bottom - top + 2 * reach, 1, ASJ_CL_ARGUMENTS(norms));
    if (status == ASJ_OK)
        status = run(context, "gradient_normalise", frame, bottom - top + 2 * more, GRADIENT_ROWS,
                     ASJ_CL_ARGUMENTS(normalise));
    return status;
}

static asj_status read_band(asj_context *context, const asj_cl_buffer *plane, const asj_frame *frame, int32_t top, int32_t bottom,
                            int16_t *to)
{
    const size_t pitch = (size_t)frame->stride * sizeof *to;
    return asj_cl_read_rows(context, plane, asj_cl_plane_at(frame, top - ASJ_MARGIN, top), pitch, to + top * frame->stride, pitch,
                            (size_t)frame->width * sizeof *to, (size_t)(bottom - top));
}

/* Rows top .. bottom - 1: gray there, gradient back. Differences of the window's rows look at three rows around. */
static asj_status make_band(asj_context *context, struct asj_cl_detect *detect, asj_frame *frame, int32_t top, int32_t bottom,
                            int32_t margins, int32_t epsilon)
{
    const int32_t rows = bottom - top + 2 * ASJ_MARGIN, base = top - ASJ_MARGIN;
    const int32_t first = top > 3 ? top - 3 : 0, last = bottom + 3 < frame->height ? bottom + 3 : frame->height;
    const size_t pitch = (size_t)frame->stride * sizeof *frame->gray;
    asj_cl_buffer *const planes[] = {&detect->gray, &detect->norms, &detect->gradient_x, &detect->gradient_y};
    asj_status status = ASJ_OK;
    for (int i = 0; i < 4 && status == ASJ_OK; i++)
        status = asj_cl_plane_reserve(context, planes[i], frame, rows);
    if (status == ASJ_OK)
        status = asj_cl_write_rows(context, &detect->gray, asj_cl_plane_at(frame, base, first), pitch,
                                   frame->gray + first * frame->stride, pitch, (size_t)frame->width * sizeof *frame->gray,
                                   (size_t)(last - first));
    if (status == ASJ_OK)
        status = calculate(context, detect, frame, top, bottom, margins, epsilon);
    if (status == ASJ_OK)
        status = read_band(context, &detect->gradient_x, frame, top, bottom, frame->gradient_x);
    if (status == ASJ_OK)
        status = read_band(context, &detect->gradient_y, frame, top, bottom, frame->gradient_y);
    return status;
}

/* Standardising needs sums over the image and is left to the host, as are images of which not even a row fits. */
asj_status asj_cl_gradient(asj_context *context, asj_frame *frame, const asj_detect_options *options)
{
    const int32_t epsilon = (int32_t)lrint(256 * options->gradient_epsilon), rows = asj_cl_plane_rows(context, frame);
    const int32_t whole = rows == frame->height + 2 * ASJ_MARGIN, band = rows - 2 * ASJ_MARGIN;
    struct asj_cl_detect *detect;
    asj_status status = asj_cl_detect_get(context, &detect);
    asj_cl_planes_forget(context);
    if (status != ASJ_OK)
        return status;
    if (options->standardise || band < 1)
        return asj_gradient(context, frame, options);
    for (int32_t top = 0; top < frame->height && status == ASJ_OK; top += band) {
        const int32_t bottom = frame->height - top < band ? frame->height : top + band;
        status = make_band(context, detect, frame, top, bottom, whole, epsilon);
    }
    if (status != ASJ_OK || !whole)
        return status;
    detect->frame = frame;
    detect->width = frame->width;
    detect->height = frame->height;
    detect->first = -ASJ_MARGIN;
    detect->last = frame->height + ASJ_MARGIN;
    return ASJ_OK;
}
