/* SPDX-License-Identifier: BSD-2-Clause */
/* Compiled OpenCL kernels, kept in the user's cache folder from one start to the next. A folder that cannot be made is no error:
 * kernels are compiled anew then. */
#ifndef ASJ_CLI_KERNEL_CACHE_H
#define ASJ_CLI_KERNEL_CACHE_H

#include <asj/context.h>

enum { CLI_CACHE_PATH = 1024 };

typedef struct cli_kernel_cache {
    char base[CLI_CACHE_PATH];   /* $XDG_CACHE_HOME or $HOME/.cache; "" = none */
    char folder[CLI_CACHE_PATH]; /* base/asj */
} cli_kernel_cache;

/* Finds the folder, which need not exist, and fills in the library's callbacks. The cache may not move while they are used. */
void cli_kernel_cache_init(cli_kernel_cache *cache, asj_kernel_cache *callbacks);

#endif
