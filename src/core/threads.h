/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_THREADS_H
#define ASJ_SRC_THREADS_H

#include "context.h"

/* How many threads to share `items` out to: 1 when they are not worth two, with `least` items for each, or else those of the
 * context. Waking threads and waiting for them costs some 10 us; run-time libraries end threads and make new ones when their number
 * changes from region to region, which costs more, so there is nothing between. */
static inline int32_t asj_threads_for(const asj_context *context, int64_t items, int64_t least)
{
    return items / 2 >= least ? context->threads : 1;
}

#endif
