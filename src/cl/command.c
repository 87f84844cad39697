/* SPDX-License-Identifier: BSD-2-Clause */
/* Kernels in the queue, waiting for them, and their times. */
#include "command.h"
#include "error.h"
#include "program.h"
#include "state.h"

#include <stdio.h>
#include <string.h>

enum { TRANSFERS = 3 };

cl_event *asj_cl_timed(asj_context *context, cl_event *event)
{
    *event = NULL;
    return context->cl->times ? event : NULL;
}

static cl_int measure(struct asj_cl *cl, cl_event event, asj_cl_time *time, size_t bytes)
{
    cl_ulong start = 0, end = 0;
    cl_int error = cl->api.WaitForEvents(1, &event);
    if (error == CL_SUCCESS)
        error = cl->api.GetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, NULL);
    if (error == CL_SUCCESS)
        error = cl->api.GetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL);
    time->runs++;
    time->bytes += bytes;
    time->ms += end > start ? (double)(end - start) * 1e-6 : 0;
    return error;
}

asj_status asj_cl_end(asj_context *context, const char *call, const char *subject, int32_t what, size_t bytes, cl_int error,
                      cl_event event)
{
    struct asj_cl *cl = context->cl;
    char text[48];
    if (error == CL_SUCCESS && event) {
        error = measure(cl, event, &cl->times[what >= 0 ? what : asj_cl_kernel_count - 1 - what], bytes);
        cl->api.ReleaseEvent(event);
    }
    if (error == CL_SUCCESS)
        return ASJ_OK;
    snprintf(text, sizeof text, "%zu bytes", bytes);
    return asj_cl_fail(context, call, subject ? subject : text, error);
}

/* ---- kernels ---- */

static asj_status set_arguments(asj_context *context, int32_t number, asj_cl_arguments arguments)
{
    struct asj_cl *cl = context->cl;
    for (int32_t i = 0; i < arguments.count; i++) {
        const asj_cl_argument *a = &arguments.list[i];
        const void *value = a->kind == ASJ_CL_KIND_NUMBER ? &a->number : a->value;
        const cl_int error = cl->api.SetKernelArg(cl->kernels[number], (cl_uint)i, a->size, value);
        if (error != CL_SUCCESS) {
            char subject[96];
            snprintf(subject, sizeof subject, "%s, %d", asj_cl_kernel_names[number].name, (int)i);
            return asj_cl_fail(context, "SetKernelArg", subject, error);
        }
    }
    return ASJ_OK;
}

asj_status asj_cl_run(asj_context *context, const char *kernel, int32_t dimensions, const size_t *global, const size_t *local,
                      asj_cl_arguments arguments)
{
    struct asj_cl *cl = context->cl;
    int32_t number;
    cl_event event;
    asj_status status = asj_cl_find_kernel(context, kernel, &number);
    if (status == ASJ_OK)
        status = set_arguments(context, number, arguments);
    for (int32_t i = 0; i < dimensions; i++)
        if (global[i] == 0)
            return status;
    if (status != ASJ_OK)
        return status;
    const cl_int error = cl->api.EnqueueNDRangeKernel(cl->queue, cl->kernels[number], (cl_uint)dimensions, NULL, global, local, 0,
                                                      NULL, asj_cl_timed(context, &event));
    return asj_cl_end(context, "EnqueueNDRangeKernel", kernel, number, 0, error, event);
}

asj_status asj_cl_kernel_limits(asj_context *context, const char *kernel, size_t *max_work_group, size_t *multiple)
{
    struct asj_cl *cl = context->cl;
    const struct {
        cl_kernel_work_group_info what;
        size_t *to;
    } questions[] = {{CL_KERNEL_WORK_GROUP_SIZE, max_work_group}, {CL_KERNEL_PREFERRED_WORK_GROUP_SIZE_MULTIPLE, multiple}};
    int32_t number;
    asj_status status = asj_cl_find_kernel(context, kernel, &number);
    for (size_t i = 0; i < 2 && status == ASJ_OK; i++) {
        if (!questions[i].to)
            continue;
        const cl_int error = cl->api.GetKernelWorkGroupInfo(cl->kernels[number], cl->device, questions[i].what, sizeof(size_t),
                                                            questions[i].to, NULL);
        if (error != CL_SUCCESS)
            status = asj_cl_fail(context, "GetKernelWorkGroupInfo", kernel, error);
    }
    return status;
}

asj_status asj_cl_finish(asj_context *context)
{
    const cl_int error = context->cl->api.Finish(context->cl->queue);
    return error == CL_SUCCESS ? ASJ_OK : asj_cl_fail(context, "Finish", "queue", error);
}

/* ---- device time ---- */

static asj_status renew_queue(asj_context *context, cl_command_queue_properties properties)
{
    struct asj_cl *cl = context->cl;
    cl_int error = CL_SUCCESS;
    asj_status status = asj_cl_finish(context);
    if (status != ASJ_OK)
        return status;
    const cl_command_queue queue = cl->api.CreateCommandQueue(cl->context, cl->device, properties, &error);
    if (!queue)
        return asj_cl_fail(context, "CreateCommandQueue", "profiling", error);
    cl->api.ReleaseCommandQueue(cl->queue);
    cl->queue = queue;
    return ASJ_OK;
}

asj_status asj_cl_profile(asj_context *context, int32_t on)
{
    struct asj_cl *cl = context->cl;
    static const char *const transfers[TRANSFERS] = {"write", "read", "zero"};
    const size_t count = (size_t)asj_cl_kernel_count + TRANSFERS;
    if (!on == !cl->times && !on)
        return ASJ_OK;
    if (!on != !cl->times) {
        asj_cl_time *times = on ? asj_allocate(&context->memory, count, sizeof *times) : NULL;
        if (on && !times)
            return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the times of %zu kernels", count);
        asj_status status = renew_queue(context, on ? CL_QUEUE_PROFILING_ENABLE : 0);
        asj_release(&context->memory, status == ASJ_OK ? cl->times : times);
        if (status != ASJ_OK)
            return status;
        cl->times = times;
    }
    for (size_t i = 0; on && i < count; i++) {
        const size_t k = (size_t)asj_cl_kernel_count;
        cl->times[i] = (asj_cl_time){i < k ? asj_cl_kernel_names[i].name : transfers[i - k], 0, 0, 0};
    }
    return ASJ_OK;
}

int32_t asj_cl_get_times(const asj_context *context, asj_cl_time *times, int32_t capacity)
{
    const asj_cl_time *all = context->cl->times;
    int32_t used = 0;
    for (int32_t i = 0; all && i < asj_cl_kernel_count + TRANSFERS; i++)
        if (all[i].runs > 0) {
            if (used < capacity)
                times[used] = all[i];
            used++;
        }
    return used;
}
