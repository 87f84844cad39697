/* SPDX-License-Identifier: BSD-2-Clause */
/* The devices that there are, and why each cannot be used. */
#ifndef ASJ_SRC_CL_ENUMERATE_H
#define ASJ_SRC_CL_ENUMERATE_H

#include "loader.h"
#include "core/memory.h"

#include <asj/device.h>

typedef struct asj_cl_found {
    cl_platform_id *platforms; /* of the device with the same number */
    cl_device_id *devices;     /* NULL where the record stands for a platform without devices */
    asj_device *records;
    size_t count;
    size_t capacity;
} asj_cl_found;

/* All devices of all platforms. Platforms that fail are records too; *found is empty, with a line of text, when there is no
 * platform. asj_cl_found_free() afterwards, also after a failure (ASJ_ERROR_MEMORY). */
asj_status asj_cl_enumerate(asj_memory *memory, const asj_cl_api *api, asj_cl_found *found, char *message, size_t message_size);
void asj_cl_found_free(asj_memory *memory, asj_cl_found *found);

#endif
