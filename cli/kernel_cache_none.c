/* SPDX-License-Identifier: BSD-2-Clause */
/* In a build without OpenCL there are no kernels to keep. */
#include "kernel_cache.h"

void cli_kernel_cache_init(cli_kernel_cache *cache, asj_kernel_cache *callbacks)
{
    cache->base[0] = cache->folder[0] = '\0';
    callbacks->get = NULL;
    callbacks->put = NULL;
}
