/* SPDX-License-Identifier: BSD-2-Clause */
/* Compiled with -mavx2; called only where the processor has it. */
#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

#define V_LANES 16
typedef __m256i vec;

static inline vec v_load(const void *p) { return _mm256_loadu_si256((const __m256i *)p); }
/* 8 lanes each from several places */
static inline vec v_load_windows(const int16_t *const *p, ptrdiff_t at)
{
    return _mm256_loadu2_m128i((const __m128i *)(p[1] + at), (const __m128i *)(p[0] + at));
}
static inline void v_store(void *p, vec v) { _mm256_storeu_si256((__m256i *)p, v); }
static inline vec v_set1(int16_t x) { return _mm256_set1_epi16(x); }
static inline vec v_zero(void) { return _mm256_setzero_si256(); }
static inline vec v_add(vec a, vec b) { return _mm256_add_epi16(a, b); }
static inline vec v_sub(vec a, vec b) { return _mm256_sub_epi16(a, b); }
static inline vec v_sub_saturated(vec a, vec b) { return _mm256_subs_epu16(a, b); }
static inline vec v_abs(vec a) { return _mm256_abs_epi16(a); }
static inline vec v_max(vec a, vec b) { return _mm256_max_epi16(a, b); }
static inline vec v_high(vec a, vec b) { return _mm256_mulhi_epi16(a, b); }
static inline vec v_high_unsigned(vec a, vec b) { return _mm256_mulhi_epu16(a, b); }
static inline vec v_and(vec a, vec b) { return _mm256_and_si256(a, b); }
static inline vec v_or(vec a, vec b) { return _mm256_or_si256(a, b); }
/* -1 where a > b, and where not a > b, and b */
static inline vec v_greater(vec a, vec b) { return _mm256_cmpgt_epi16(a, b); }
static inline vec v_not_and(vec a, vec b) { return _mm256_andnot_si256(a, b); }
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v)
{
    __m128i bytes = _mm_packs_epi16(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    return (uint32_t)_mm_movemask_epi8(bytes);
}
static inline int v_any(vec v) { return !_mm256_testz_si256(v, v); }

#define V_NAME(name) name##_avx2
#include "patches.h" /* before kernels.h, which fills the table */
#define V_MORE(ops) fill_patches(ops)
#include "../simd/kernels.h"
