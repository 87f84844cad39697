/* SPDX-License-Identifier: BSD-2-Clause */
/* Whole numbers in the bytes of a file, the first byte worth most. */
#ifndef ASJ_IO_BYTES_H
#define ASJ_IO_BYTES_H

#include <stdint.h>

static inline uint32_t asj_big16(const unsigned char *b)
{
    return (uint32_t)b[0] << 8 | b[1];
}

static inline uint32_t asj_big32(const unsigned char *b)
{
    return asj_big16(b) << 16 | asj_big16(b + 2);
}

#endif
