/* SPDX-License-Identifier: BSD-2-Clause */
#include "backend.h"

int32_t asj_context_backend(const asj_context *context)
{
    return context && context->cl ? ASJ_BACKEND_OPENCL : ASJ_BACKEND_CPU;
}

const char *asj_context_device(const asj_context *context)
{
    return context && context->cl ? context->device->name(context) : NULL;
}

asj_status asj_backend_prepare(asj_context *context)
{
    return context->cl ? context->device->prepare(context) : ASJ_OK;
}

static asj_status run(asj_context *context, asj_status (*call)(asj_context *context, void *arguments), void *arguments)
{
    asj_status status = call(context, arguments);
    if (status != ASJ_ERROR_DEVICE || !context->cl || context->options.backend != ASJ_BACKEND_AUTO)
        return status;
    const int for_good = ++context->device_failures >= ASJ_BACKEND_FAILURES;
    asj_log(context, ASJ_LOG_WARNING, "%s; done on the CPU%s", context->message, for_good ? ", as all that follows" : " instead");
    context->message[0] = '\0';
    if (for_good)
        context->device->free(context);
    struct asj_cl *device = context->cl;
    const asj_ops *ops = context->ops;
    context->cl = NULL;
    context->ops = context->cpu_ops;
    status = call(context, arguments);
    if (!for_good) {
        context->cl = device;
        context->ops = ops;
    }
    return status;
}

asj_status asj_backend_run(asj_context *context, asj_status (*call)(asj_context *context, void *arguments), void *arguments)
{
    asj_memory_open(&context->memory);
    const asj_status status = run(context, call, arguments);
    asj_memory_close(&context->memory);
    return status;
}
