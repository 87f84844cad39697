/* SPDX-License-Identifier: BSD-2-Clause */
/* What the programs that decode write, followed by width * height pixels without gaps, in the machine's byte order. */
#ifndef ASJ_IO_DECODER_ANSWER_H
#define ASJ_IO_DECODER_ANSWER_H

#include <stdint.h>

#define ASJ_DECODER_MAGIC 0x61736a31u

enum {
    ASJ_DECODER_LACKS = 0, /* no pixels follow: a codec is missing there */
    ASJ_DECODER_GRAY8,
    ASJ_DECODER_BGR8,
    ASJ_DECODER_GRAY_FLOAT,
    ASJ_DECODER_RGB8,
    ASJ_DECODER_GRAY16
};

typedef struct asj_decoder_answer {
    uint32_t magic;
    uint32_t samples; /* ASJ_DECODER_... */
    uint64_t width, height;
} asj_decoder_answer;

#endif
