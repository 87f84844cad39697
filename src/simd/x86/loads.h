/* SPDX-License-Identifier: BSD-2-Clause */
/* Grey levels from several places at once, by loads of their own: on many processors a gather takes longer. (On Zen 4, in place of
 * gathers: profiles of lines .82 of the time with AVX-512 and .86 with AVX2, discs .86.) */
#ifndef ASJ_SRC_X86_LOADS_H
#define ASJ_SRC_X86_LOADS_H

#include <immintrin.h>

#include <stdint.h>
#include <string.h>

/* Two neighbours each at four places, and at eight. */
static inline __m128i two_at_four(const uint16_t *gray, const int32_t *at)
{
    int32_t pair[4];
    for (int n = 0; n < 4; n++)
        memcpy(&pair[n], gray + at[n], sizeof pair[n]);
    return _mm_setr_epi32(pair[0], pair[1], pair[2], pair[3]);
}

static inline __m256i two_at_eight(const uint16_t *gray, const int32_t *at)
{
    return _mm256_set_m128i(two_at_four(gray, at + 4), two_at_four(gray, at));
}

/* Four neighbours each at two places. */
static inline __m128i four_at_two(const uint16_t *gray, int32_t first, int32_t second)
{
    const __m128i a = _mm_loadl_epi64((const __m128i *)(const void *)(gray + first));
    return _mm_castps_si128(_mm_loadh_pi(_mm_castsi128_ps(a), (const __m64 *)(const void *)(gray + second)));
}

#endif
