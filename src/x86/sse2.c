/* SPDX-License-Identifier: BSD-2-Clause */
/* Part of every x86-64 processor; on others compiled with -msse2 and called only where the processor has it. */
#include <emmintrin.h>
#include <stddef.h>
#include <stdint.h>

#define V_LANES 8
typedef __m128i vec;

static inline vec v_load(const void *p) { return _mm_loadu_si128((const __m128i *)p); }
/* 8 lanes each from several places */
static inline vec v_load_windows(const int16_t *const *p, ptrdiff_t at) { return v_load(p[0] + at); }
static inline void v_store(void *p, vec v) { _mm_storeu_si128((__m128i *)p, v); }
static inline vec v_set1(int16_t x) { return _mm_set1_epi16(x); }
static inline vec v_zero(void) { return _mm_setzero_si128(); }
static inline vec v_add(vec a, vec b) { return _mm_add_epi16(a, b); }
static inline vec v_sub(vec a, vec b) { return _mm_sub_epi16(a, b); }
static inline vec v_sub_saturated(vec a, vec b) { return _mm_subs_epu16(a, b); }
static inline vec v_abs(vec a) { return _mm_max_epi16(a, _mm_sub_epi16(_mm_setzero_si128(), a)); }
static inline vec v_max(vec a, vec b) { return _mm_max_epi16(a, b); }
static inline vec v_high(vec a, vec b) { return _mm_mulhi_epi16(a, b); }
static inline vec v_high_unsigned(vec a, vec b) { return _mm_mulhi_epu16(a, b); }
static inline vec v_and(vec a, vec b) { return _mm_and_si128(a, b); }
static inline vec v_or(vec a, vec b) { return _mm_or_si128(a, b); }
/* -1 where a > b, and where not a > b, and b */
static inline vec v_greater(vec a, vec b) { return _mm_cmpgt_epi16(a, b); }
static inline vec v_not_and(vec a, vec b) { return _mm_andnot_si128(a, b); }
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v) { return (uint32_t)_mm_movemask_epi8(_mm_packs_epi16(v, _mm_setzero_si128())); }
static inline int v_any(vec v) { return _mm_movemask_epi8(v) != 0; }

#define V_NAME(name) name##_sse2
#include "../simd/kernels.h"
