/* SPDX-License-Identifier: BSD-2-Clause */
/* Loops that are shared out to threads. A context has a pool of its own: threads that sleep until a loop comes, made when the first
 * loop is worth it. All take parts of a loop from one queue, the calling thread too; at the end it waits only for those that have
 * begun. So a thread that the scheduler does not let run costs nothing: the others do its share. Nobody spins for long, since on a
 * busy machine that takes the processor from the very thread that is waited for.
 *
 * Inside of such a loop nothing may allocate, fail or report; what a thread needs lies in scratch made before, at its number.
 * The parts of a loop write to different places: results do not depend on who did which. */
#ifndef ASJ_SRC_THREADS_H
#define ASJ_SRC_THREADS_H

#include "context.h"

/* A part of a loop: items first .. end - 1, and the thread that does it, 0 .. threads - 1. No two threads that are at work have the
 * same number, but a thread's number changes from loop to loop. `caller`: 1 in the thread that called the library. */
typedef struct asj_part {
    int64_t first, end;
    int32_t thread, caller;
} asj_part;

/* The body of a loop, over one part. `data` is what asj_parallel() was given. */
typedef void (*asj_loop)(const void *data, const asj_part *part);

/* Runs the body over items 0 .. count - 1, each once, `at_once` in a part (the last may be shorter; 0 = as many as give every
 * thread a few parts), by at most `threads` threads. Returns when all are done. With one thread or one part, and in a loop that
 * runs inside of another, the calling thread does all, as number 0 of its own loop. */
void asj_parallel(const asj_context *context, int32_t threads, int64_t count, int64_t at_once, asj_loop loop, const void *data);

/* Scratch of the threads of a loop: `size` elements for each. */
typedef struct asj_scratch {
    uint16_t *memory;
    size_t size;
} asj_scratch;

static inline uint16_t *asj_thread_scratch(const asj_scratch *scratch, const asj_part *part)
{
    return scratch->memory + (size_t)part->thread * scratch->size;
}

/* How many threads a context uses that was asked for `wanted`; 0 = one for each processor that the process may run on. */
int32_t asj_thread_count(int32_t wanted);

/* How many threads to share `items` out to: no more than have `least` items each, and than the context has. */
static inline int32_t asj_threads_for(const asj_context *context, int64_t items, int64_t least)
{
    const int64_t worth = items / least;
    return worth >= context->threads ? context->threads : worth > 1 ? (int32_t)worth : 1;
}

/* Gives the context its pool, in which no thread has been made yet. */
asj_status asj_pool_open(asj_context *context);

/* Threads that its pool has made so far. */
int32_t asj_pool_workers(const asj_context *context);

#endif
