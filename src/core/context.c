/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "context.h"
#include "detect/detect.h"
#include "opencl.h"
#include "ops.h"
#include "threads.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

void asj_context_options_init(asj_context_options *options)
{
    if (!options)
        return;
    memset(options, 0, sizeof *options);
    options->backend = ASJ_BACKEND_AUTO;
    asj_memory_allocator(NULL, &options->allocator);
    options->log_level = ASJ_LOG_WARNING;
}

static asj_status fill(asj_context *context, const char *library)
{
    context->ops = asj_allocate(&context->memory, 1, sizeof *context->ops);
    asj_status status = context->ops ? asj_nfa_create(&context->memory, &context->nfa) : ASJ_ERROR_MEMORY;
    if (status != ASJ_OK)
        return status;
    asj_ops_best(context->ops);
    return context->options.backend == ASJ_BACKEND_CPU ? ASJ_OK : asj_cl_create(context, library);
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
    if (options->backend < ASJ_BACKEND_AUTO || options->backend > ASJ_BACKEND_OPENCL ||
        options->threads < 0 || options->threads > 256)
        return ASJ_ERROR_OPTION;
    asj_context *context = asj_allocate_zero(&memory, 1, sizeof *context);
    if (!context)
        return ASJ_ERROR_MEMORY;
    context->memory = memory;
    context->options = *options;
    context->threads = asj_thread_count(options->threads);
    asj_status status = fill(context, library);
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

void asj_context_free(asj_context **pointer)
{
    if (!pointer || !*pointer)
        return;
    asj_context *context = *pointer;
    asj_cl_free(context);
    asj_detector_free(&context->memory, &context->detector);
    asj_nfa_free(&context->memory, &context->nfa);
    asj_release(&context->memory, context->ops);
    asj_memory_trim(&context->memory);
    asj_memory memory = context->memory;
    asj_release(&memory, context);
    *pointer = NULL;
}

const char *asj_context_message(const asj_context *context)
{
    return context ? context->message : "no context";
}

int32_t asj_context_threads(const asj_context *context)
{
    return context ? context->threads : 0;
}

void asj_context_memory(const asj_context *context, uint64_t *now, uint64_t *peak)
{
    if (now)
        *now = context ? context->memory.now : 0;
    if (peak)
        *peak = context ? context->memory.peak : 0;
}

asj_status asj_fail(asj_context *context, asj_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(context->message, sizeof context->message, format, arguments);
    va_end(arguments);
    const int goes_on = status == ASJ_ERROR_DEVICE && context->cl && context->options.backend == ASJ_BACKEND_AUTO;
    if (status != ASJ_ERROR_CANCELLED && !goes_on)
        asj_log(context, ASJ_LOG_ERROR, "%s", context->message);
    return status;
}

void asj_log(asj_context *context, int32_t level, const char *format, ...)
{
    char line[512];
    va_list arguments;
    if (!context->options.log || level > context->options.log_level)
        return;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    context->options.log(context->options.log_user, level, line);
}

asj_status asj_progress(asj_context *context, int32_t stage, double done)
{
    if (!context->options.progress)
        return ASJ_OK;
    if (done > context->progress)
        context->progress = done;
    if (context->options.progress(context->options.progress_user, stage, context->progress) == 0)
        return ASJ_OK;
    return asj_fail(context, ASJ_ERROR_CANCELLED, "cancelled by the caller during %s", asj_stage_name(stage));
}

double asj_clock_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}
