/* SPDX-License-Identifier: BSD-2-Clause */
/* The number of false alarms of a line segment. */
#ifndef ASJ_SRC_LINE_SEGMENTS_NFA_H
#define ASJ_SRC_LINE_SEGMENTS_NFA_H

#include <stdint.h>

/* Precisions at which a rectangle's pixels may be counted as aligned: p = 1/8, 1/16, .. */
#define ASJ_SEGMENT_PRECISIONS 6

/* ln of the number of tests in an image of width x height samples. */
double asj_segment_log_tests(int32_t width, int32_t height);

/* ln of P(at least k of n independent samples are aligned), each with probability p in (0, 1); 0 <= k <= n. */
double asj_segment_log_tail(int32_t n, int32_t k, double p);

#endif
