/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_TESTS_PARITY_BENCH_H
#define ASJ_TESTS_PARITY_BENCH_H

/* Times every operation on every variant of the CPU (one thread) and on every device, on a picture of that size. 0 when it
 * could. */
int bench_run(int width, int height);

#endif
