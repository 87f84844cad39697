/* SPDX-License-Identifier: BSD-2-Clause */
/* Threads. Loops that are shared out carry `#pragma omp parallel for num_threads(...) schedule(...)` without a guard: a build
 * without OpenMP passes over the pragma and runs them on one thread. Only this file asks whether there is OpenMP. Inside such a
 * loop nothing may allocate, fail or report; what a thread needs lies in scratch made before, at asj_thread_number(). */
#ifndef ASJ_SRC_THREADS_H
#define ASJ_SRC_THREADS_H

#include "context.h"

#ifdef _OPENMP
#include <omp.h>
#endif

/* Of the calling thread in a loop that is shared out: 0 .. threads - 1. */
static inline int32_t asj_thread_number(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

/* Scratch of the threads of a loop: `size` elements for each. */
typedef struct asj_scratch {
    uint16_t *memory;
    size_t size;
} asj_scratch;

/* That of the calling thread. */
static inline uint16_t *asj_thread_scratch(const asj_scratch *scratch)
{
    return scratch->memory + (size_t)asj_thread_number() * scratch->size;
}

/* How many threads a context uses that was asked for `wanted`; 0 = one for each processor. */
static inline int32_t asj_thread_count(int32_t wanted)
{
#ifdef _OPENMP
    return wanted > 0 ? wanted : omp_get_num_procs();
#else
    (void)wanted;
    return 1;
#endif
}

/* How many threads to share `items` out to: 1 when they are not worth two, with `least` items for each, or else those of the
 * context. Waking threads and waiting for them costs some 10 us; run-time libraries end threads and make new ones when their number
 * changes from region to region, which costs more, so there is nothing between. */
static inline int32_t asj_threads_for(const asj_context *context, int64_t items, int64_t least)
{
    return items / 2 >= least ? context->threads : 1;
}

#endif
