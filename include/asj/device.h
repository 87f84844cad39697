/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_DEVICE_H
#define ASJ_DEVICE_H

#include <asj/context.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    ASJ_DEVICE_OTHER = 0,
    ASJ_DEVICE_CPU = 1,
    ASJ_DEVICE_GPU = 2,
    ASJ_DEVICE_ACCELERATOR = 3
};

/* "cpu", "gpu", "accelerator"; "other" for any other number. A static string. */
ASJ_API const char *asj_device_type_name(int32_t type);

/* What is known about an OpenCL device. Texts are one line, cut where they are longer than their field. A platform that has no
 * devices, or does not tell, has one record with an empty name. */
typedef struct asj_device {
    char name[128];
    char platform[128];
    char vendor[128];
    char version[128];       /* of OpenCL, as the device says it: "OpenCL 3.0 ..." */
    char driver[128];
    char reason[192];        /* why it cannot be used; "" when it can */
    int32_t type;            /* ASJ_DEVICE_... */
    int32_t usable;          /* 1 = a context can use it */
    int32_t compute_units;   /* multiprocessors or cores, as the device counts them */
    int32_t clock_mhz;       /* the most */
    uint64_t global_memory;  /* bytes */
    uint64_t local_memory;   /* bytes for a work-group */
    uint64_t largest_buffer; /* bytes */
    uint64_t reserved[8];
} asj_device;

typedef struct asj_device_list {
    const asj_device *devices; /* NULL when there are none */
    uint32_t count;
    int32_t reserved_1;
    char message[256];         /* why there are none: no libOpenCL, no platform, a build without OpenCL; "" when there are some */
} asj_device_list;

/* Lists the OpenCL devices of all platforms, usable or not, in the order that asj_context_options.device counts them. No devices
 * are a success with count 0 and a message. The list belongs to the caller until asj_device_list_free().
 *
 * options   only the allocator is looked at; NULL = malloc
 *
 * ASJ_ERROR_ARGUMENT  list is NULL, or only one of the allocator's functions is given
 * ASJ_ERROR_MEMORY
 * Thread safety: any thread, any time. */
ASJ_API asj_status asj_device_list_create(const asj_context_options *options, asj_device_list **list);

/* Frees a list and sets the pointer to NULL. NULL and a pointer to NULL are fine. */
ASJ_API void asj_device_list_free(asj_device_list **list);

/* Where the context's data-parallel steps run at the moment: ASJ_BACKEND_CPU or ASJ_BACKEND_OPENCL. A context with
 * ASJ_BACKEND_AUTO may change from OpenCL to the CPU (asj_context_options.backend). ASJ_BACKEND_CPU for NULL. */
ASJ_API int32_t asj_context_backend(const asj_context *context);

/* Name of the context's OpenCL device; NULL on the CPU. Valid until the next call with this context. */
ASJ_API const char *asj_context_device(const asj_context *context);

#ifdef __cplusplus
}
#endif
#endif
