/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_THREADS_H
#define ASJ_SRC_THREADS_H

#include "context.h"

/* How many threads to share `items` out to, when fewer than `least` items are not worth a thread: 1 to those of the context.
 * Waking a thread and waiting for it costs some 10 us. */
static inline int32_t asj_threads_for(const asj_context *context, int64_t items, int64_t least)
{
    const int64_t useful = items / least;
    return useful >= context->threads ? context->threads : useful > 1 ? (int32_t)useful : 1;
}

#endif
