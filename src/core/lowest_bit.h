/* SPDX-License-Identifier: BSD-2-Clause */
/* The number of the lowest bit that is set, of a number that is not 0. */
#ifndef ASJ_SRC_LOWEST_BIT_H
#define ASJ_SRC_LOWEST_BIT_H

#include <stdint.h>

static inline uint32_t asj_lowest_bit(uint64_t bits)
{
#if defined(__GNUC__) || defined(__clang__)
    return (uint32_t)__builtin_ctzll(bits);
#else
    uint32_t number = 0;
    for (; !(bits & 1); bits >>= 1)
        number++;
    return number;
#endif
}

#endif
