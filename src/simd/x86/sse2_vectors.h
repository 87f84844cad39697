/* SPDX-License-Identifier: BSD-2-Clause */
/* Vectors of SSE2, as simd/kernels.h wants them. */
#ifndef ASJ_SRC_X86_SSE2_VECTORS_H
#define ASJ_SRC_X86_SSE2_VECTORS_H

#include <emmintrin.h>
#include <stddef.h>
#include <stdint.h>

#define V_LANES 8
typedef __m128i vec;

static inline vec v_load(const void *p) { return _mm_loadu_si128((const __m128i *)p); }
/* 8 lanes each from several places */
static inline vec v_load_places(const int16_t *p, const ptrdiff_t *at) { return v_load(p + at[0]); }
/* the same 8 lanes again and again */
static inline vec v_load_repeated(const int16_t *p) { return v_load(p); }
static inline void v_store(void *p, vec v) { _mm_storeu_si128((__m128i *)p, v); }
static inline vec v_set1(int16_t x) { return _mm_set1_epi16(x); }
static inline vec v_zero(void) { return _mm_setzero_si128(); }
static inline vec v_add(vec a, vec b) { return _mm_add_epi16(a, b); }
static inline vec v_sub(vec a, vec b) { return _mm_sub_epi16(a, b); }
static inline vec v_sub_saturated(vec a, vec b) { return _mm_subs_epu16(a, b); }
static inline vec v_abs(vec a) { return _mm_max_epi16(a, _mm_sub_epi16(_mm_setzero_si128(), a)); }
static inline vec v_max(vec a, vec b) { return _mm_max_epi16(a, b); }
static inline vec v_min(vec a, vec b) { return _mm_min_epi16(a, b); }
static inline vec v_high(vec a, vec b) { return _mm_mulhi_epi16(a, b); }
static inline vec v_high_unsigned(vec a, vec b) { return _mm_mulhi_epu16(a, b); }
static inline vec v_and(vec a, vec b) { return _mm_and_si128(a, b); }
static inline vec v_or(vec a, vec b) { return _mm_or_si128(a, b); }
static inline vec v_xor(vec a, vec b) { return _mm_xor_si128(a, b); }
/* -1 where a > b, and where a > b but not c > d */
static inline vec v_greater(vec a, vec b) { return _mm_cmpgt_epi16(a, b); }
static inline vec v_greater_but(vec a, vec b, vec c, vec d) { return _mm_andnot_si128(v_greater(c, d), v_greater(a, b)); }
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v) { return (uint32_t)_mm_movemask_epi8(_mm_packs_epi16(v, _mm_setzero_si128())); }
static inline int v_any(vec v) { return _mm_movemask_epi8(v) != 0; }

static inline vec v_low(vec a, vec b) { return _mm_mullo_epi16(a, b); }
static inline vec v_shift_right_8(vec a) { return _mm_srli_epi16(a, 8); }
static inline vec v_shift_right_15(vec a) { return _mm_srli_epi16(a, 15); }
/* of each 128 bits */
static inline vec v_interleave_low(vec a, vec b) { return _mm_unpacklo_epi16(a, b); }
static inline vec v_interleave_high(vec a, vec b) { return _mm_unpackhi_epi16(a, b); }
static inline vec v_interleave32_low(vec a, vec b) { return _mm_unpacklo_epi32(a, b); }
static inline vec v_interleave32_high(vec a, vec b) { return _mm_unpackhi_epi32(a, b); }
static inline vec v_interleave64_low(vec a, vec b) { return _mm_unpacklo_epi64(a, b); }
static inline vec v_interleave64_high(vec a, vec b) { return _mm_unpackhi_epi64(a, b); }

/* ---- lanes of 32 bits ---- */

static inline vec v_set1_32(int32_t x) { return _mm_set1_epi32(x); }
static inline vec v_add32(vec a, vec b) { return _mm_add_epi32(a, b); }
static inline vec v_sub32(vec a, vec b) { return _mm_sub_epi32(a, b); }
/* signed 16-bit lanes: a b + next a next b */
static inline vec v_pairs(vec a, vec b) { return _mm_madd_epi16(a, b); }
/* the sum of all 32-bit lanes */
static inline int32_t v_sum32(vec v)
{
    v = _mm_add_epi32(v, _mm_shuffle_epi32(v, 0x4e));
    return _mm_cvtsi128_si32(_mm_add_epi32(v, _mm_shuffle_epi32(v, 0xb1)));
}
/* the lower halves of products */
static inline vec v_low32(vec a, vec b)
{
    const vec even = _mm_mul_epu32(a, b), odd = _mm_mul_epu32(_mm_srli_epi64(a, 32), _mm_srli_epi64(b, 32));
    return _mm_or_si128(_mm_and_si128(even, _mm_set1_epi64x(0xffffffff)), _mm_slli_epi64(odd, 32));
}
/* the lower 32 bits of each 64, multiplied */
static inline vec v_products32(vec a, vec b) { return _mm_mul_epu32(a, b); }
static inline vec v_max32(vec a, vec b)
{
    const vec greater = _mm_cmpgt_epi32(a, b);
    return _mm_or_si128(_mm_and_si128(greater, a), _mm_andnot_si128(greater, b));
}
static inline vec v_shift_right32_8(vec a) { return _mm_srli_epi32(a, 8); }
/* -1 where below zero, else 0 */
static inline vec v_negative32(vec a) { return _mm_srai_epi32(a, 31); }
/* numbers of 32 bits with these lower and higher halves, as v_interleave_ arranges lanes */
static inline vec v_join_low(vec low, vec high) { return v_interleave_low(low, high); }
static inline vec v_join_high(vec low, vec high) { return v_interleave_high(low, high); }
/* the lower halves of all lanes, the higher ones; in the order that v_interleave_ takes apart */
static inline vec v_pack_low(vec a, vec b)
{
    return _mm_packs_epi32(_mm_srai_epi32(_mm_slli_epi32(a, 16), 16), _mm_srai_epi32(_mm_slli_epi32(b, 16), 16));
}
static inline vec v_pack_high(vec a, vec b) { return _mm_packs_epi32(_mm_srai_epi32(a, 16), _mm_srai_epi32(b, 16)); }
/* the same of even and odd lanes */
static inline vec v_even(vec a, vec b) { return v_pack_low(a, b); }
static inline vec v_odd(vec a, vec b) { return v_pack_high(a, b); }
/* such a pack of a and b as they came from memory, put into memory's order */
static inline vec v_in_order(vec packed) { return packed; }
/* whole parts of sqrt(a) + more, of a / b, in single precision */
static inline vec v_root(vec a, float more)
{
    return _mm_cvttps_epi32(_mm_add_ps(_mm_sqrt_ps(_mm_cvtepi32_ps(a)), _mm_set1_ps(more)));
}
static inline vec v_quotient(float a, vec b) { return _mm_cvttps_epi32(_mm_div_ps(_mm_set1_ps(a), _mm_cvtepi32_ps(b))); }

#endif
