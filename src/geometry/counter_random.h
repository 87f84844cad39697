/* SPDX-License-Identifier: BSD-2-Clause */
/* Random numbers by counting: number n of stream s of a seed, whatever was drawn before. The mixing function of splitmix64
 * (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014), twice. */
#ifndef ASJ_SRC_COUNTER_RANDOM_H
#define ASJ_SRC_COUNTER_RANDOM_H

#include <stdint.h>

static inline uint64_t asj_mix64(uint64_t x)
{
    x += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

/* Uniform in [0, 1), 53 bits. */
static inline double asj_counter_random(uint64_t seed, uint64_t stream, uint64_t number)
{
    return (double)(asj_mix64(asj_mix64(seed ^ asj_mix64(stream)) + number) >> 11) * 0x1p-53;
}

#endif
