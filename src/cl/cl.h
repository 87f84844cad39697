/* SPDX-License-Identifier: BSD-2-Clause */
/* What create.c asks of this folder, which may be missing. */
#ifndef ASJ_SRC_CL_CL_H
#define ASJ_SRC_CL_CL_H

#include "core/context.h"

#include <asj/device.h>

/* All devices of all platforms, in order; *count 0 with a line of text when there are none. `library` NULL = the system's
 * libOpenCL, else the path of one (tests). *devices is released by the caller. ASJ_OK or ASJ_ERROR_MEMORY. */
asj_status asj_cl_list(asj_memory *memory, const char *library, asj_device **devices, size_t *count, char *message,
                       size_t message_size);

/* Opens the device that context->options asks for (core/device.h): context->cl and context->device. With ASJ_BACKEND_AUTO,
 * context->cl stays NULL when there is no such device, and that is no error. */
asj_status asj_cl_create(asj_context *context, const char *library);

/* Puts the operations that a device takes over into the tables. */
void asj_cl_fill(const asj_ops *ops);

#endif
