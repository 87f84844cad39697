/* SPDX-License-Identifier: BSD-2-Clause */
/* Programs and kernels: the embedded sources, built when first needed. */
#ifndef ASJ_SRC_CL_PROGRAM_H
#define ASJ_SRC_CL_PROGRAM_H

#include "runtime.h"
#include "source.h"

/* No fast arithmetic: the bits must be those of the CPU. */
#define ASJ_CL_BUILD_OPTIONS "-cl-std=CL1.2"

/* Number of the kernel with this name; its program is built, and context->cl->kernels[number] is there, when that succeeds. */
asj_status asj_cl_find_kernel(asj_context *context, const char *name, int32_t *number);

/* Builds all programs that have not been built yet. */
asj_status asj_cl_build_all(asj_context *context);

/* Releases all programs and kernels. */
void asj_cl_free_programs(asj_context *context);

#endif
