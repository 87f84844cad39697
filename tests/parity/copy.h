/* SPDX-License-Identifier: BSD-2-Clause */
/* How fast memory can be copied: the limit of operations that do little with much. Bytes read and bytes written both count. */
#ifndef ASJ_TESTS_PARITY_COPY_H
#define ASJ_TESTS_PARITY_COPY_H

#include "core/context.h"

/* GB/s by memcpy() in one thread; 0 when there is no memory for it. */
double copy_rate_host(void);

/* GB/s by a kernel on the context's device; 0 when that fails. */
double copy_rate_device(asj_context *context);

#endif
