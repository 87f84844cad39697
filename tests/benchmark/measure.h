/* SPDX-License-Identifier: BSD-2-Clause */
/* What the benchmark programs share: medians, the sample room, contexts, numbers on the command line. */
#ifndef ASJ_TESTS_BENCHMARK_MEASURE_H
#define ASJ_TESTS_BENCHMARK_MEASURE_H

#include <asj/asj.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sorts the values. */
double measure_median(double *values, int32_t count);

/* The sample room seen from viewpoint `index`, 8-bit grey, blur 0.9 px, noise 2. The caller frees it; NULL when memory is
 * short. */
uint8_t *measure_room(int32_t index, int32_t width, int32_t height);

/* A context for the CPU path; NULL when there is no memory. */
asj_context *measure_context(int32_t threads);

/* 0, or -1 when the text is no whole number from `lowest` to `highest`. */
int measure_number(const char *text, long lowest, long highest, int32_t *value);

/* Cuts "key=value" in two: the value, and the key in `key`; NULL when there is no '=' or the key is too long. */
const char *measure_key_value(const char *text, char key[64]);

#ifdef __cplusplus
}
#endif
#endif
