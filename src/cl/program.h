/* SPDX-License-Identifier: BSD-2-Clause */
/* Programs and kernels: the embedded sources, built when first needed. */
#ifndef ASJ_SRC_CL_PROGRAM_H
#define ASJ_SRC_CL_PROGRAM_H

#include "runtime.h"

/* ---- made by kernels/embed.py ---- */

typedef struct asj_cl_source {
    const char *name;     /* of the file, without .cl */
    const char *parts[2]; /* common.clh and the file itself */
    size_t sizes[2];
    const char *hash;     /* of both */
} asj_cl_source;

typedef struct asj_cl_kernel_name {
    const char *name;
    int32_t source;
} asj_cl_kernel_name;

extern const asj_cl_source asj_cl_sources[];
extern const int32_t asj_cl_source_count;
extern const asj_cl_kernel_name asj_cl_kernel_names[];
extern const int32_t asj_cl_kernel_count;

/* ---- program.c ---- */

/* No fast arithmetic: the bits must be those of the CPU. */
#define ASJ_CL_BUILD_OPTIONS "-cl-std=CL1.2"

/* Number of the kernel with this name; its program is built, and context->cl->kernels[number] is there, when that succeeds. */
asj_status asj_cl_find_kernel(asj_context *context, const char *name, int32_t *number);

/* Builds all programs that have not been built yet. */
asj_status asj_cl_build_all(asj_context *context);

/* Releases all programs and kernels. */
void asj_cl_free_programs(asj_context *context);

#endif
