/* SPDX-License-Identifier: BSD-2-Clause */
/* What asj-io-opencv writes, followed by width * height pixels without gaps, in the machine's byte order. */
#ifndef ASJ_IO_OPENCV_ANSWER_H
#define ASJ_IO_OPENCV_ANSWER_H

#include <stdint.h>

#define ASJ_OPENCV_MAGIC 0x61736a31u

enum { ASJ_OPENCV_GRAY8 = 1, ASJ_OPENCV_BGR8 = 2, ASJ_OPENCV_GRAY_FLOAT = 3 };

typedef struct asj_opencv_answer {
    uint32_t magic;
    uint32_t samples; /* ASJ_OPENCV_... */
    uint64_t width, height;
} asj_opencv_answer;

#endif
