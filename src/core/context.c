/* SPDX-License-Identifier: BSD-2-Clause */
/* Messages, log, progress and the clock; a context frees its parts. */
#define _POSIX_C_SOURCE 200809L
#include "context.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* If anything is kept. */
static void free_kept(asj_memory *memory, asj_kept *kept)
{
    if (kept->state)
        kept->free(memory, kept->state);
    kept->state = NULL;
}

void asj_context_free(asj_context **pointer)
{
    if (!pointer || !*pointer)
        return;
    asj_context *context = *pointer;
    if (context->in_hook)
        return;
    if (context->cl)
        context->device->free(context);
    free_kept(&context->memory, &context->pool);
    free_kept(&context->memory, &context->detector);
    free_kept(&context->memory, &context->tables);
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

int32_t asj_context_simd(const asj_context *context)
{
    return context ? context->simd : ASJ_SIMD_AUTO;
}

void asj_context_memory(const asj_context *context, uint64_t *now, uint64_t *peak)
{
    if (now)
        *now = context ? context->memory.now : 0;
    if (peak)
        *peak = context ? context->memory.peak : 0;
}

asj_status asj_enter(asj_context *context)
{
    if (!context)
        return ASJ_ERROR_ARGUMENT;
    if (!context->in_hook)
        return ASJ_OK;
    snprintf(context->message, sizeof context->message, "a hook calls with the context that called it");
    return ASJ_ERROR_ARGUMENT;
}

asj_status asj_fail(asj_context *context, asj_status status, const char *format, ...)
{
    char left_out[sizeof context->message];
    const int is_left_out = status == ASJ_ERROR_LIMIT && context->optional > 0;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(is_left_out ? left_out : context->message, sizeof context->message, format, arguments);
    va_end(arguments);
    const int goes_on = status == ASJ_ERROR_DEVICE && context->cl && context->options.backend == ASJ_BACKEND_AUTO;
    if (is_left_out)
        asj_log(context, ASJ_LOG_INFO, "left out: %s", left_out);
    else if (status != ASJ_ERROR_CANCELLED && !goes_on)
        asj_log(context, ASJ_LOG_ERROR, "%s", context->message);
    return status;
}

void asj_optional_begin(asj_context *context)
{
    context->optional++;
}

asj_status asj_optional_end(asj_context *context, asj_status status)
{
    context->optional--;
    return status == ASJ_ERROR_LIMIT ? ASJ_OK : status;
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
    context->in_hook++;
    context->options.log(context->options.log_user, level, line);
    context->in_hook--;
}

asj_status asj_progress(asj_context *context, int32_t stage, double done)
{
    if (!context->options.progress)
        return ASJ_OK;
    const double whole = context->progress_part > 0 ? context->progress_from + context->progress_part * done : done;
    if (whole > context->progress)
        context->progress = whole < 1 ? whole : 1; /* parts of parts add up to a little more */
    context->asked_ms = asj_clock_ms();
    context->in_hook++;
    const int32_t stop = context->options.progress(context->options.progress_user, stage, context->progress);
    context->in_hook--;
    if (!stop)
        return ASJ_OK;
    return asj_fail(context, ASJ_ERROR_CANCELLED, "cancelled by the caller during %s", asj_stage_name(stage));
}

void asj_dump_out(asj_context *context, const asj_dump *dump)
{
    if (!context->options.dump)
        return;
    context->in_hook++;
    context->options.dump(context->options.dump_user, dump);
    context->in_hook--;
}

double asj_clock_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}
