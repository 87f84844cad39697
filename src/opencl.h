/* SPDX-License-Identifier: BSD-2-Clause */
/* What the rest of the library asks of src/cl. A build without it has these stand-ins, so that callers are the same. */
#ifndef ASJ_SRC_OPENCL_H
#define ASJ_SRC_OPENCL_H

#include "core/context.h"

#include <asj/device.h>

#ifdef ASJ_HAVE_OPENCL

/* All devices of all platforms, in order; *count 0 with a line of text when there are none. `library` NULL = the system's
 * libOpenCL, else the path of one (tests). *devices is released by the caller. ASJ_OK or ASJ_ERROR_MEMORY. */
asj_status asj_cl_list(asj_memory *memory, const char *library, asj_device **devices, size_t *count, char *message,
                       size_t message_size);

/* Opens the device that context->options asks for (device.h) into context->cl, and lets it take over its operations. With
 * ASJ_BACKEND_AUTO, context->cl stays NULL when there is no such device, and that is no error. */
asj_status asj_cl_create(asj_context *context, const char *library);

/* Frees context->cl, which may be NULL, and sets it to NULL. The operations are left as they are. */
void asj_cl_free(asj_context *context);

/* Name of the device. context->cl may not be NULL. */
const char *asj_cl_name(const asj_context *context);

/* Builds all programs that have not been built yet. context->cl may not be NULL. */
asj_status asj_cl_build_all(asj_context *context);

#else

static inline asj_status asj_cl_list(asj_memory *memory, const char *library, asj_device **devices, size_t *count, char *message,
                                     size_t message_size)
{
    static const char why[] = "this build has no OpenCL";
    (void)memory;
    (void)library;
    *devices = NULL;
    *count = 0;
    for (size_t i = 0; i < message_size; i++)
        message[i] = i < sizeof why && i + 1 < message_size ? why[i] : '\0';
    return ASJ_OK;
}

static inline asj_status asj_cl_create(asj_context *context, const char *library)
{
    (void)library;
    if (context->options.backend != ASJ_BACKEND_OPENCL)
        return ASJ_OK;
    return asj_fail(context, ASJ_ERROR_DEVICE, "this build has no OpenCL");
}

static inline void asj_cl_free(asj_context *context)
{
    (void)context;
}

static inline const char *asj_cl_name(const asj_context *context)
{
    (void)context;
    return NULL;
}

static inline asj_status asj_cl_build_all(asj_context *context)
{
    (void)context;
    return ASJ_OK;
}

#endif
#endif
