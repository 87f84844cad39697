/* SPDX-License-Identifier: BSD-2-Clause */
/* Resident memory of this process, from the kernel. */
#ifndef ASJ_TESTS_BENCHMARK_MEMORY_USE_H
#define ASJ_TESTS_BENCHMARK_MEMORY_USE_H

#include <stdint.h>

/* Gives freed memory back, starts a new peak, and returns the bytes resident now; 0 where that cannot be done. */
uint64_t memory_use_reset(void);

/* The most bytes that have been resident since then; 0 when not known. */
uint64_t memory_use_peak(void);

#endif
