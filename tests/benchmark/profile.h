/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_TESTS_BENCHMARK_PROFILE_H
#define ASJ_TESTS_BENCHMARK_PROFILE_H

#include <asj/asj.h>

/* Prints for each stage of the detector its time (median of `runs`), the bytes that it must move, its operations, and what part of
 * the machine's bandwidth and peak that is. 0, or -1 with a line on standard error. */
int profile_print(const asj_image *image, const asj_detect_options *options, int32_t threads, int32_t runs);

#endif
