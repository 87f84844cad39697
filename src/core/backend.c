/* SPDX-License-Identifier: BSD-2-Clause */
/* A call begins on the device; when that fails under `auto`, it is done once more on the CPU. */
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

void asj_backend_begin(asj_context *context)
{
    if (context->progress_part <= 0)
        context->progress = 0;
    else if (context->progress < context->progress_from) /* of a whole that has begun: it may be there already, rounded */
        context->progress = context->progress_from;
    asj_memory_open(&context->memory);
}

int asj_backend_retry(asj_context *context, asj_status status)
{
    if (status == ASJ_ERROR_DEVICE && context->cl && context->options.backend == ASJ_BACKEND_AUTO) {
        const int for_good = ++context->device_failures >= ASJ_BACKEND_FAILURES;
        asj_log(context, ASJ_LOG_WARNING, "%s; done on the CPU%s", context->message,
                for_good ? ", as all that follows" : " instead");
        context->message[0] = '\0';
        if (for_good)
            context->device->free(context);
        context->cl_aside = context->cl;
        context->ops_aside = context->ops;
        context->cl = NULL;
        context->ops = context->cpu_ops;
        return 1;
    }
    if (context->cl_aside) {
        context->cl = context->cl_aside;
        context->ops = context->ops_aside;
        context->cl_aside = NULL;
    }
    asj_memory_close(&context->memory);
    return 0;
}
