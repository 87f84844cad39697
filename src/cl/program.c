/* SPDX-License-Identifier: BSD-2-Clause */
/* The embedded programs, built for the device when one of their kernels is first asked for, or taken from the store (cache.c). */
#include "program.h"
#include "cache.h"
#include "error.h"
#include "state.h"

#include <stdio.h>
#include <string.h>

/* ---- the compiler's log ---- */

/* Hands out the log line by line; the first line that has "error" in it, or else the first line, goes to `first`. */
static void log_lines(asj_context *context, char *text, char *first, size_t first_size)
{
    const int32_t level = context->options.backend == ASJ_BACKEND_AUTO ? ASJ_LOG_INFO : ASJ_LOG_ERROR;
    int found = 0;
    while (*text) {
        const size_t length = strcspn(text, "\r\n");
        const char end = text[length];
        text[length] = '\0';
        if (length > 0) {
            asj_log(context, level, "  %s", text);
            if (!*first || (!found && strstr(text, "error")))
                snprintf(first, first_size, "%s", text);
            found = found || strstr(text, "error");
        }
        text += length + (end != '\0');
    }
}

static asj_status build_failed(asj_context *context, const asj_cl_source *source, cl_program program, cl_int error)
{
    struct asj_cl *cl = context->cl;
    char first[256] = "", name[ASJ_CL_ERROR_SIZE];
    size_t size = 0;
    if (cl->api.GetProgramBuildInfo(program, cl->device, CL_PROGRAM_BUILD_LOG, 0, NULL, &size) == CL_SUCCESS && size > 1) {
        char *text = asj_allocate_zero(&context->memory, size, 1);
        if (text && cl->api.GetProgramBuildInfo(program, cl->device, CL_PROGRAM_BUILD_LOG, size, text, NULL) == CL_SUCCESS) {
            text[size - 1] = '\0';
            log_lines(context, text, first, sizeof first);
        }
        asj_release(&context->memory, text);
    }
    return asj_fail(context, ASJ_ERROR_DEVICE, "clBuildProgram(%s.cl): %s on %s%s%s", source->name, asj_cl_error_name(error, name),
                    cl->name, *first ? ": " : "", first);
}

/* ---- programs ---- */

static void drop(struct asj_cl *cl, int32_t number)
{
    for (int32_t k = 0; k < asj_cl_kernel_count; k++)
        if (asj_cl_kernel_names[k].source == number && cl->kernels[k]) {
            cl->api.ReleaseKernel(cl->kernels[k]);
            cl->kernels[k] = NULL;
        }
    if (cl->programs[number])
        cl->api.ReleaseProgram(cl->programs[number]);
    cl->programs[number] = NULL;
}

/* All kernels of a program that has been built. Returns the kernel that fails, or NULL. */
static const char *create_kernels(struct asj_cl *cl, int32_t number, cl_int *error)
{
    for (int32_t k = 0; k < asj_cl_kernel_count; k++) {
        if (asj_cl_kernel_names[k].source != number)
            continue;
        cl->kernels[k] = cl->api.CreateKernel(cl->programs[number], asj_cl_kernel_names[k].name, error);
        if (!cl->kernels[k])
            return asj_cl_kernel_names[k].name;
    }
    return NULL;
}

/* 1, or 0 when the caller has no entry that works. */
static int build_from_cache(asj_context *context, int32_t number)
{
    struct asj_cl *cl = context->cl;
    size_t entry_size, size;
    cl_int state, error;
    uint8_t *entry = asj_cl_cache_get(context, &asj_cl_sources[number], &entry_size);
    if (!entry)
        return 0;
    const unsigned char *binary = asj_cl_cache_unpack(cl->identity, &asj_cl_sources[number], entry, entry_size, &size);
    if (binary)
        cl->programs[number] = cl->api.CreateProgramWithBinary(cl->context, 1, &cl->device, &size, &binary, &state, &error);
    const int built = cl->programs[number] &&
                      cl->api.BuildProgram(cl->programs[number], 1, &cl->device, ASJ_CL_BUILD_OPTIONS, NULL, NULL) == CL_SUCCESS &&
                      !create_kernels(cl, number, &error);
    asj_release(&context->memory, entry);
    if (!built) {
        asj_log(context, ASJ_LOG_INFO, "%s.cl: the stored program is of no use", asj_cl_sources[number].name);
        drop(cl, number);
    }
    return built;
}

static asj_status build_from_source(asj_context *context, int32_t number)
{
    struct asj_cl *cl = context->cl;
    const asj_cl_source *source = &asj_cl_sources[number];
    const char *parts[2] = {source->parts[0], source->parts[1]};
    cl_int error = CL_SUCCESS;
    cl->programs[number] = cl->api.CreateProgramWithSource(cl->context, 2, parts, source->sizes, &error);
    if (!cl->programs[number])
        return asj_cl_fail(context, "CreateProgramWithSource", source->name, error);
    error = cl->api.BuildProgram(cl->programs[number], 1, &cl->device, ASJ_CL_BUILD_OPTIONS, NULL, NULL);
    if (error != CL_SUCCESS) {
        asj_status status = build_failed(context, source, cl->programs[number], error);
        drop(cl, number);
        return status;
    }
    const char *bad = create_kernels(cl, number, &error);
    if (bad) {
        drop(cl, number);
        return asj_cl_fail(context, "CreateKernel", bad, error);
    }
    return ASJ_OK;
}

/* What cannot be stored is compiled again next time; by a driver that keeps what it compiles, that is a matter of its own. */
static void store(asj_context *context, int32_t number)
{
    struct asj_cl *cl = context->cl;
    size_t size = 0;
    if (!context->options.kernel_cache.put || cl->keeps_programs ||
        cl->api.GetProgramInfo(cl->programs[number], CL_PROGRAM_BINARY_SIZES, sizeof size, &size, NULL) != CL_SUCCESS || size == 0)
        return;
    unsigned char *binary = asj_allocate(&context->memory, size, 1);
    if (binary && cl->api.GetProgramInfo(cl->programs[number], CL_PROGRAM_BINARIES, sizeof binary, &binary, NULL) == CL_SUCCESS)
        asj_cl_cache_put(context, &asj_cl_sources[number], binary, size);
    asj_release(&context->memory, binary);
}

static asj_status build(asj_context *context, int32_t number)
{
    if (context->cl->programs[number] || build_from_cache(context, number))
        return ASJ_OK;
    const double start = asj_clock_ms();
    asj_status status = build_from_source(context, number);
    if (status == ASJ_OK) {
        store(context, number);
        asj_log(context, ASJ_LOG_DEBUG, "%s.cl compiled in %.0f ms", asj_cl_sources[number].name, asj_clock_ms() - start);
    }
    return status;
}

asj_status asj_cl_build_all(asj_context *context)
{
    asj_status status = ASJ_OK;
    for (int32_t i = 0; i < asj_cl_source_count && status == ASJ_OK; i++)
        status = build(context, i);
    return status;
}

asj_status asj_cl_find_kernel(asj_context *context, const char *name, int32_t *number)
{
    for (int32_t k = 0; k < asj_cl_kernel_count; k++)
        if (strcmp(asj_cl_kernel_names[k].name, name) == 0) {
            *number = k;
            return build(context, asj_cl_kernel_names[k].source);
        }
    return asj_fail(context, ASJ_ERROR_DEVICE, "there is no kernel %s", name);
}

void asj_cl_free_programs(asj_context *context)
{
    struct asj_cl *cl = context->cl;
    for (int32_t i = 0; cl->programs && cl->kernels && i < asj_cl_source_count; i++)
        drop(cl, i);
    asj_release(&context->memory, cl->programs);
    asj_release(&context->memory, cl->kernels);
}
