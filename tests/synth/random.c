/* SPDX-License-Identifier: BSD-2-Clause */
/* xoshiro256** 1.0 and splitmix64 (Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2019; both public
 * domain), written from their published recurrences. Normal numbers by Box and Muller (1958). The integer sequence is exact
 * everywhere; log, sqrt and cos may differ in the last bit between C libraries, which 8-bit rounding hides all but never. */
#include "random.h"

#include <math.h>

#define TWO_PI 6.283185307179586476925

static uint64_t rotate_left(uint64_t value, int bits)
{
    return (value << bits) | (value >> (64 - bits));
}

void synth_random_seed(synth_random *random, uint64_t seed)
{
    for (int i = 0; i < 4; i++) {
        seed += UINT64_C(0x9e3779b97f4a7c15);
        uint64_t mixed = seed;
        mixed = (mixed ^ (mixed >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
        mixed = (mixed ^ (mixed >> 27)) * UINT64_C(0x94d049bb133111eb);
        random->state[i] = mixed ^ (mixed >> 31);
    }
    random->spare = 0.0;
    random->has_spare = 0;
}

uint64_t synth_random_bits(synth_random *random)
{
    uint64_t *s = random->state;
    const uint64_t result = rotate_left(s[1] * 5, 7) * 9;
    const uint64_t shifted = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= shifted;
    s[3] = rotate_left(s[3], 45);
    return result;
}

double synth_random_unit(synth_random *random)
{
    return (double)(synth_random_bits(random) >> 11) * (1.0 / 9007199254740992.0);
}

double synth_random_between(synth_random *random, double low, double high)
{
    return low + (high - low) * synth_random_unit(random);
}

double synth_random_normal(synth_random *random)
{
    if (random->has_spare) {
        random->has_spare = 0;
        return random->spare;
    }
    const double radius = sqrt(-2.0 * log(1.0 - synth_random_unit(random)));
    const double angle = TWO_PI * synth_random_unit(random);
    random->spare = radius * sin(angle);
    random->has_spare = 1;
    return radius * cos(angle);
}
