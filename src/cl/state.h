/* SPDX-License-Identifier: BSD-2-Clause */
/* What a context keeps for its device: context->cl. */
#ifndef ASJ_SRC_CL_STATE_H
#define ASJ_SRC_CL_STATE_H

#include "loader.h"
#include "runtime.h"

struct asj_cl_detect; /* detect.h */
struct asj_cl_scan;   /* scan_ops.c */
struct asj_cl_match;  /* match_ops.c */

struct asj_cl {
    asj_cl_api api;
    cl_device_id device;
    cl_context context;
    cl_command_queue queue;
    asj_cl_limits limits;
    char name[128];         /* of the device */
    char identity[1024];    /* device, platform, driver, options: what a compiled program depends on beside its source */
    int keeps_programs;     /* the driver has a store of its own, and asking it for binaries costs more than ours saves */
    cl_program *programs;   /* asj_cl_source_count; NULL = not built yet */
    cl_kernel *kernels;     /* asj_cl_kernel_count; NULL = the program is not built yet */
    asj_cl_time *times;     /* asj_cl_kernel_count and the transfers (command.c); NULL = not measured */

    struct asj_cl_detect *detect;
    struct asj_cl_scan *scan;
    struct asj_cl_match *match;
};

static inline const asj_cl_limits *asj_cl_get_limits(const asj_context *context)
{
    return &context->cl->limits;
}

#endif
