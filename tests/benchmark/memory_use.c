/* SPDX-License-Identifier: BSD-2-Clause */
#include "memory_use.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

static uint64_t status_bytes(const char *key)
{
    char line[256];
    uint64_t bytes = 0;
    FILE *file = fopen("/proc/self/status", "r");
    if (!file)
        return 0;
    while (fgets(line, sizeof line, file))
        if (strncmp(line, key, strlen(key)) == 0)
            bytes = strtoull(line + strlen(key), NULL, 10) * 1024;
    fclose(file);
    return bytes;
}

uint64_t memory_use_reset(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    FILE *file = fopen("/proc/self/clear_refs", "w"); /* 5: the peak starts again from here; proc(5) */
    if (!file)
        return 0;
    const int written = fputs("5", file) >= 0;
    return fclose(file) == 0 && written ? status_bytes("VmRSS:") : 0;
}

uint64_t memory_use_peak(void)
{
    return status_bytes("VmHWM:");
}
