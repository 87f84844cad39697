/* SPDX-License-Identifier: BSD-2-Clause */
/* What this machine can do at most, measured by loops that do nothing else. */
#ifndef ASJ_TESTS_BENCHMARK_MACHINE_H
#define ASJ_TESTS_BENCHMARK_MACHINE_H

#include <asj/context.h>

typedef struct machine_limits {
    double bytes;    /* read and written by copies of memory that no cache holds, each second */
    double whole;    /* operations on 16-bit whole numbers each second: multiplications and additions in equal numbers */
    double floating; /* on double precision numbers likewise */
    int32_t width;   /* bytes in the vectors that these were done with: 16, 32 or 64 */
} machine_limits;

/* With the threads of a context. 0, or -1 when memory is short. Takes about half a second. */
int machine_measure(const asj_context *context, machine_limits *limits);

#endif
