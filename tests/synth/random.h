/* SPDX-License-Identifier: BSD-2-Clause */
/* Random numbers for synthetic images: the same sequence for the same seed on every machine. */
#ifndef ASJ_TESTS_SYNTH_RANDOM_H
#define ASJ_TESTS_SYNTH_RANDOM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* xoshiro256**, seeded by splitmix64, and the second half of the last Box-Muller pair. */
typedef struct synth_random {
    uint64_t state[4];
    double spare;
    int32_t has_spare;
} synth_random;

void synth_random_seed(synth_random *random, uint64_t seed);
uint64_t synth_random_bits(synth_random *random);

/* Uniform in [0, 1), 53 bits; in [low, high). */
double synth_random_unit(synth_random *random);
double synth_random_between(synth_random *random, double low, double high);

/* Normal, mean 0, standard deviation 1. */
double synth_random_normal(synth_random *random);

#ifdef __cplusplus
}
#endif
#endif
