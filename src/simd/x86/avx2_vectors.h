/* SPDX-License-Identifier: BSD-2-Clause */
/* Vectors of AVX2, as simd/kernels.h wants them. */
#ifndef ASJ_SRC_X86_AVX2_VECTORS_H
#define ASJ_SRC_X86_AVX2_VECTORS_H

#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

#define V_LANES 16
typedef __m256i vec;

static inline vec v_load(const void *p) { return _mm256_loadu_si256((const __m256i *)p); }
/* 8 lanes each from several places */
static inline vec v_load_places(const int16_t *p, const ptrdiff_t *at)
{
    return _mm256_loadu2_m128i((const __m128i *)(p + at[1]), (const __m128i *)(p + at[0]));
}
/* the same 8 lanes again and again */
static inline vec v_load_repeated(const int16_t *p) { return _mm256_broadcastsi128_si256(_mm_loadu_si128((const __m128i *)p)); }
static inline void v_store(void *p, vec v) { _mm256_storeu_si256((__m256i *)p, v); }
static inline vec v_set1(int16_t x) { return _mm256_set1_epi16(x); }
static inline vec v_zero(void) { return _mm256_setzero_si256(); }
static inline vec v_add(vec a, vec b) { return _mm256_add_epi16(a, b); }
static inline vec v_sub(vec a, vec b) { return _mm256_sub_epi16(a, b); }
static inline vec v_sub_saturated(vec a, vec b) { return _mm256_subs_epu16(a, b); }
static inline vec v_abs(vec a) { return _mm256_abs_epi16(a); }
static inline vec v_max(vec a, vec b) { return _mm256_max_epi16(a, b); }
static inline vec v_min(vec a, vec b) { return _mm256_min_epi16(a, b); }
static inline vec v_high(vec a, vec b) { return _mm256_mulhi_epi16(a, b); }
static inline vec v_high_unsigned(vec a, vec b) { return _mm256_mulhi_epu16(a, b); }
static inline vec v_and(vec a, vec b) { return _mm256_and_si256(a, b); }
static inline vec v_or(vec a, vec b) { return _mm256_or_si256(a, b); }
static inline vec v_xor(vec a, vec b) { return _mm256_xor_si256(a, b); }
/* -1 where a > b, and where a > b but not c > d */
static inline vec v_greater(vec a, vec b) { return _mm256_cmpgt_epi16(a, b); }
static inline vec v_greater_but(vec a, vec b, vec c, vec d) { return _mm256_andnot_si256(v_greater(c, d), v_greater(a, b)); }
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v)
{
    __m128i bytes = _mm_packs_epi16(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    return (uint32_t)_mm_movemask_epi8(bytes);
}
static inline int v_any(vec v) { return !_mm256_testz_si256(v, v); }

static inline vec v_low(vec a, vec b) { return _mm256_mullo_epi16(a, b); }
static inline vec v_shift_right_8(vec a) { return _mm256_srli_epi16(a, 8); }
static inline vec v_shift_right_15(vec a) { return _mm256_srli_epi16(a, 15); }
/* of each 128 bits */
static inline vec v_interleave_low(vec a, vec b) { return _mm256_unpacklo_epi16(a, b); }
static inline vec v_interleave_high(vec a, vec b) { return _mm256_unpackhi_epi16(a, b); }
static inline vec v_interleave32_low(vec a, vec b) { return _mm256_unpacklo_epi32(a, b); }
static inline vec v_interleave32_high(vec a, vec b) { return _mm256_unpackhi_epi32(a, b); }
static inline vec v_interleave64_low(vec a, vec b) { return _mm256_unpacklo_epi64(a, b); }
static inline vec v_interleave64_high(vec a, vec b) { return _mm256_unpackhi_epi64(a, b); }

/* ---- lanes of 32 bits ---- */

static inline vec v_set1_32(int32_t x) { return _mm256_set1_epi32(x); }
static inline vec v_add32(vec a, vec b) { return _mm256_add_epi32(a, b); }
static inline vec v_sub32(vec a, vec b) { return _mm256_sub_epi32(a, b); }
/* signed 16-bit lanes: a b + next a next b */
static inline vec v_pairs(vec a, vec b) { return _mm256_madd_epi16(a, b); }
/* the sum of all 32-bit lanes */
static inline int32_t v_sum32(__m256i v)
{
    __m128i s = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4e));
    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0xb1));
    return _mm_cvtsi128_si32(s);
}
/* the lower halves of products */
static inline vec v_low32(vec a, vec b) { return _mm256_mullo_epi32(a, b); }
static inline vec v_max32(vec a, vec b) { return _mm256_max_epi32(a, b); }
static inline vec v_shift_right32_8(vec a) { return _mm256_srli_epi32(a, 8); }
/* -1 where below zero, else 0 */
static inline vec v_negative32(vec a) { return _mm256_srai_epi32(a, 31); }
/* numbers of 32 bits with these lower and higher halves, as v_interleave_ arranges lanes */
static inline vec v_join_low(vec low, vec high) { return v_interleave_low(low, high); }
static inline vec v_join_high(vec low, vec high) { return v_interleave_high(low, high); }
/* the lower halves of all lanes, the higher ones; in the order that v_interleave_ takes apart */
static inline vec v_pack_low(vec a, vec b)
{
    const vec half = _mm256_set1_epi32(0xffff);
    return _mm256_packus_epi32(_mm256_and_si256(a, half), _mm256_and_si256(b, half));
}
static inline vec v_pack_high(vec a, vec b) { return _mm256_packs_epi32(_mm256_srai_epi32(a, 16), _mm256_srai_epi32(b, 16)); }
/* the same of even and odd lanes */
static inline vec v_even(vec a, vec b) { return v_pack_low(a, b); }
static inline vec v_odd(vec a, vec b) { return v_pack_high(a, b); }
/* such a pack of a and b as they came from memory, put into memory's order */
static inline vec v_in_order(vec packed) { return _mm256_permute4x64_epi64(packed, 0xd8); }
/* whole parts of sqrt(a) + more, of a / b, in single precision */
static inline vec v_root(vec a, float more)
{
    return _mm256_cvttps_epi32(_mm256_add_ps(_mm256_sqrt_ps(_mm256_cvtepi32_ps(a)), _mm256_set1_ps(more)));
}
static inline vec v_quotient(float a, vec b)
{
    return _mm256_cvttps_epi32(_mm256_div_ps(_mm256_set1_ps(a), _mm256_cvtepi32_ps(b)));
}

#endif
