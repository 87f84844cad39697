/* SPDX-License-Identifier: BSD-2-Clause */
/* Compiled with -mavx512f -mavx512bw; called only where the processor has it. */
#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

#define V_LANES 32
typedef __m512i vec;

static inline vec v_load(const void *p) { return _mm512_loadu_si512(p); }
/* 8 lanes each from several places */
static inline vec v_load_windows(const int16_t *const *p, ptrdiff_t at)
{
    const __m256i low = _mm256_loadu2_m128i((const __m128i *)(p[1] + at), (const __m128i *)(p[0] + at));
    const __m256i high = _mm256_loadu2_m128i((const __m128i *)(p[3] + at), (const __m128i *)(p[2] + at));
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
static inline void v_store(void *p, vec v) { _mm512_storeu_si512(p, v); }
static inline vec v_set1(int16_t x) { return _mm512_set1_epi16(x); }
static inline vec v_zero(void) { return _mm512_setzero_si512(); }
static inline vec v_add(vec a, vec b) { return _mm512_add_epi16(a, b); }
static inline vec v_sub(vec a, vec b) { return _mm512_sub_epi16(a, b); }
static inline vec v_sub_saturated(vec a, vec b) { return _mm512_subs_epu16(a, b); }
static inline vec v_abs(vec a) { return _mm512_abs_epi16(a); }
static inline vec v_max(vec a, vec b) { return _mm512_max_epi16(a, b); }
static inline vec v_high(vec a, vec b) { return _mm512_mulhi_epi16(a, b); }
static inline vec v_high_unsigned(vec a, vec b) { return _mm512_mulhi_epu16(a, b); }
static inline vec v_and(vec a, vec b) { return _mm512_and_si512(a, b); }
static inline vec v_or(vec a, vec b) { return _mm512_or_si512(a, b); }
/* -1 where a > b, and where not a > b, and b */
static inline vec v_greater(vec a, vec b) { return _mm512_movm_epi16(_mm512_cmpgt_epi16_mask(a, b)); }
static inline vec v_not_and(vec a, vec b) { return _mm512_andnot_si512(a, b); }
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v) { return _mm512_movepi16_mask(v); }
static inline int v_any(vec v) { return _mm512_test_epi16_mask(v, v) != 0; }

#define V_NAME(name) name##_avx512
#include "../simd/kernels.h"
