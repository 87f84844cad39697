/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_TESTS_PARITY_BENCH_H
#define ASJ_TESTS_PARITY_BENCH_H

#include "ops.h"

/* Times every operation in every available variant, interleaved; prints medians and ratios to the reference. 0 when it could. */
int bench_run(asj_context *context, const asj_ops *tables, const int *available);

#endif
