/* SPDX-License-Identifier: BSD-2-Clause */
/* A context and its parts: the tables of operations, the threads, the device. This file stands above
 * everything; src/cl may be missing. */
#include "create.h"
#include "core/device.h"
#include "core/threads.h"
#include "core/reserved.h"
#include "core/watch.h"
#include "tables.h"

#ifdef ASJ_HAVE_OPENCL
#include "cl/cl.h"
#endif

#include <stdio.h>
#include <string.h>

void asj_context_options_init(asj_context_options *options)
{
    if (!options)
        return;
    memset(options, 0, sizeof *options);
    options->backend = ASJ_BACKEND_AUTO;
    options->simd = ASJ_SIMD_AUTO;
    asj_memory_allocator(NULL, &options->allocator);
    options->log_level = ASJ_LOG_WARNING;
}

/* ---- the parts ---- */

typedef struct context_tables {
    asj_tables cpu, device;
} context_tables;

static asj_status fill_tables(asj_context *context)
{
    const int32_t wanted = context->options.simd;
    context_tables *tables = asj_allocate_zero(&context->memory, 1, sizeof *tables);
    if (!tables)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for tables");
    context->tables = (asj_kept){tables, asj_release};
    context->simd = wanted == ASJ_SIMD_AUTO ? asj_tables_best() : wanted;
    if (!asj_tables_fill(context->simd, &tables->cpu))
        return asj_fail(context, ASJ_ERROR_DEVICE, "%s vector instructions: %s", asj_simd_name(wanted),
                        asj_tables_has(wanted) ? "this processor lacks them" : "not in this build");
    context->ops = context->cpu_ops = &tables->cpu.ops;
    return ASJ_OK;
}

#ifdef ASJ_HAVE_OPENCL

static asj_status open_device(asj_context *context, const char *library)
{
    context_tables *tables = context->tables.state;
    if (context->options.backend == ASJ_BACKEND_CPU)
        return ASJ_OK;
    asj_status status = asj_cl_create(context, library);
    if (status != ASJ_OK || !context->cl)
        return status;
    asj_tables_fill(context->simd, &tables->device);
    asj_cl_fill(&tables->device.ops);
    tables->device.ops.name = "opencl";
    context->ops = &tables->device.ops;
    return ASJ_OK;
}

#else

static const char no_opencl[] = "this build has no OpenCL";

static asj_status open_device(asj_context *context, const char *library)
{
    (void)library;
    return context->options.backend == ASJ_BACKEND_OPENCL ? asj_fail(context, ASJ_ERROR_DEVICE, "%s", no_opencl) : ASJ_OK;
}

static asj_status asj_cl_list(asj_memory *memory, const char *library, asj_device **devices, size_t *count, char *message,
                              size_t message_size)
{
    (void)memory;
    (void)library;
    *devices = NULL;
    *count = 0;
    snprintf(message, message_size, "%s", no_opencl);
    return ASJ_OK;
}

#endif

/* ---- contexts ---- */

static asj_status check_range(asj_context *context)
{
    const asj_context_options *options = &context->options;
    const int32_t level = options->log_level;
    if (level < ASJ_LOG_ERROR || level > ASJ_LOG_DEBUG) {
        context->options.log_level = ASJ_LOG_ERROR; /* that passes on what follows */
        return asj_fail(context, ASJ_ERROR_OPTION, "log_level %d: there is no such", (int)level);
    }
    if (!asj_is_zero(options->reserved, sizeof options->reserved))
        return asj_fail(context, ASJ_ERROR_OPTION, ASJ_RESERVED_MESSAGE);
    if (options->backend < ASJ_BACKEND_AUTO || options->backend > ASJ_BACKEND_OPENCL)
        return asj_fail(context, ASJ_ERROR_OPTION, "backend %d: there is no such", (int)options->backend);
    if (options->threads < 0 || options->threads > ASJ_MAX_THREADS)
        return asj_fail(context, ASJ_ERROR_OPTION, "threads %d: 0 .. %d", (int)options->threads, ASJ_MAX_THREADS);
    if (options->simd < ASJ_SIMD_AUTO || options->simd >= ASJ_SIMD_COUNT)
        return asj_fail(context, ASJ_ERROR_OPTION, "simd %d: there is no such", (int)options->simd);
    return ASJ_OK;
}

asj_status asj_context_create_from(const char *library, const asj_context_options *options, asj_context **result)
{
    asj_context_options defaults;
    asj_memory memory = {0};
    if (!result)
        return ASJ_ERROR_ARGUMENT;
    *result = NULL;
    asj_context_options_init(&defaults);
    if (!options)
        options = &defaults;
    if (!asj_memory_allocator(options, &memory.allocator))
        return ASJ_ERROR_ARGUMENT;
    asj_context *context = asj_allocate_zero(&memory, 1, sizeof *context);
    if (!context)
        return ASJ_ERROR_MEMORY;
    context->memory = memory;
    context->options = *options;
    context->pause_ms = ASJ_PAUSE;
    asj_status status = check_range(context);
    if (status == ASJ_OK) {
        context->threads = asj_thread_count(options->threads);
        status = asj_pool_open(context);
    }
    if (status == ASJ_OK)
        status = fill_tables(context);
    if (status == ASJ_OK)
        status = open_device(context, library);
    context->options.device = NULL; /* the caller's string need not live on */
    if (status != ASJ_OK) {
        asj_context_free(&context);
        return status;
    }
    *result = context;
    return ASJ_OK;
}

asj_status asj_context_create(const asj_context_options *options, asj_context **context)
{
    return asj_context_create_from(NULL, options, context);
}

/* ---- lists of devices ---- */

asj_status asj_device_list_create_from(const char *library, const asj_context_options *options, asj_device_list **result)
{
    asj_memory memory = {0};
    asj_device *devices = NULL;
    size_t count = 0;
    char message[256] = "";
    if (!result)
        return ASJ_ERROR_ARGUMENT;
    *result = NULL;
    if (!asj_memory_allocator(options, &memory.allocator))
        return ASJ_ERROR_ARGUMENT;
    asj_status status = asj_cl_list(&memory, library, &devices, &count, message, sizeof message);
    if (status != ASJ_OK)
        return status;
    return asj_device_list_make(&memory, devices, count, message, result);
}

asj_status asj_device_list_create(const asj_context_options *options, asj_device_list **result)
{
    return asj_device_list_create_from(NULL, options, result);
}
