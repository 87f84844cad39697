/* SPDX-License-Identifier: BSD-2-Clause */
/* The embedded sources, made by kernels/embed.py. */
#ifndef ASJ_SRC_CL_SOURCE_H
#define ASJ_SRC_CL_SOURCE_H

#include <stddef.h>
#include <stdint.h>

typedef struct asj_cl_source {
    const char *name;     /* of the file, without .cl */
    const char *parts[2]; /* contract.h with common.clh, and the file itself */
    size_t sizes[2];
    const char *hash;     /* of both */
} asj_cl_source;

typedef struct asj_cl_kernel_name {
    const char *name;
    int32_t source; /* its place in asj_cl_sources */
} asj_cl_kernel_name;

extern const asj_cl_source asj_cl_sources[];
extern const int32_t asj_cl_source_count;
extern const asj_cl_kernel_name asj_cl_kernel_names[];
extern const int32_t asj_cl_kernel_count;

#endif
