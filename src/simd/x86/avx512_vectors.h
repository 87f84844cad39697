/* SPDX-License-Identifier: BSD-2-Clause */
/* Vectors of AVX-512, as simd/kernels.h wants them. */
#ifndef ASJ_SRC_X86_AVX512_VECTORS_H
#define ASJ_SRC_X86_AVX512_VECTORS_H

#include <immintrin.h>
#include <stddef.h>
#include <stdint.h>

#define V_LANES 32
typedef __m512i vec;

static inline vec v_load(const void *p) { return _mm512_loadu_si512(p); }
/* 8 lanes each from several places */
static inline vec v_load_places(const int16_t *p, const ptrdiff_t *at)
{
    const __m256i low = _mm256_loadu2_m128i((const __m128i *)(p + at[1]), (const __m128i *)(p + at[0]));
    const __m256i high = _mm256_loadu2_m128i((const __m128i *)(p + at[3]), (const __m128i *)(p + at[2]));
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}
/* the same 8 lanes again and again */
static inline vec v_load_repeated(const int16_t *p) { return _mm512_broadcast_i32x4(_mm_loadu_si128((const __m128i *)p)); }
static inline void v_store(void *p, vec v) { _mm512_storeu_si512(p, v); }
static inline vec v_set1(int16_t x) { return _mm512_set1_epi16(x); }
static inline vec v_zero(void) { return _mm512_setzero_si512(); }
static inline vec v_add(vec a, vec b) { return _mm512_add_epi16(a, b); }
static inline vec v_sub(vec a, vec b) { return _mm512_sub_epi16(a, b); }
static inline vec v_sub_saturated(vec a, vec b) { return _mm512_subs_epu16(a, b); }
static inline vec v_abs(vec a) { return _mm512_abs_epi16(a); }
static inline vec v_max(vec a, vec b) { return _mm512_max_epi16(a, b); }
static inline vec v_min(vec a, vec b) { return _mm512_min_epi16(a, b); }
static inline vec v_high(vec a, vec b) { return _mm512_mulhi_epi16(a, b); }
static inline vec v_high_unsigned(vec a, vec b) { return _mm512_mulhi_epu16(a, b); }
static inline vec v_and(vec a, vec b) { return _mm512_and_si512(a, b); }
static inline vec v_or(vec a, vec b) { return _mm512_or_si512(a, b); }
static inline vec v_xor(vec a, vec b) { return _mm512_xor_si512(a, b); }
/* -1 where a > b, and where a > b but not c > d */
static inline vec v_greater(vec a, vec b) { return _mm512_movm_epi16(_mm512_cmpgt_epi16_mask(a, b)); }
static inline vec v_greater_but(vec a, vec b, vec c, vec d)
{
    return _mm512_movm_epi16(_mm512_mask_cmple_epi16_mask(_mm512_cmpgt_epi16_mask(a, b), c, d));
}
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v) { return _mm512_movepi16_mask(v); }
static inline int v_any(vec v) { return _mm512_test_epi16_mask(v, v) != 0; }

static inline vec v_low(vec a, vec b) { return _mm512_mullo_epi16(a, b); }
static inline vec v_shift_right_8(vec a) { return _mm512_srli_epi16(a, 8); }
static inline vec v_shift_right_15(vec a) { return _mm512_srli_epi16(a, 15); }
/* of each 128 bits */
static inline vec v_interleave_low(vec a, vec b) { return _mm512_unpacklo_epi16(a, b); }
static inline vec v_interleave_high(vec a, vec b) { return _mm512_unpackhi_epi16(a, b); }
static inline vec v_interleave32_low(vec a, vec b) { return _mm512_unpacklo_epi32(a, b); }
static inline vec v_interleave32_high(vec a, vec b) { return _mm512_unpackhi_epi32(a, b); }
static inline vec v_interleave64_low(vec a, vec b) { return _mm512_unpacklo_epi64(a, b); }
static inline vec v_interleave64_high(vec a, vec b) { return _mm512_unpackhi_epi64(a, b); }

/* ---- lanes of 32 bits ---- */

static inline vec v_set1_32(int32_t x) { return _mm512_set1_epi32(x); }
static inline vec v_add32(vec a, vec b) { return _mm512_add_epi32(a, b); }
static inline vec v_sub32(vec a, vec b) { return _mm512_sub_epi32(a, b); }
/* signed 16-bit lanes: a b + next a next b */
static inline vec v_pairs(vec a, vec b) { return _mm512_madd_epi16(a, b); }
/* the sum of all 32-bit lanes */
static inline int32_t v_sum32(vec v) { return _mm512_reduce_add_epi32(v); }
/* the lower halves of products */
static inline vec v_low32(vec a, vec b) { return _mm512_mullo_epi32(a, b); }
static inline vec v_max32(vec a, vec b) { return _mm512_max_epi32(a, b); }
static inline vec v_shift_right32_8(vec a) { return _mm512_srli_epi32(a, 8); }
/* -1 where below zero, else 0 */
static inline vec v_negative32(vec a) { return _mm512_srai_epi32(a, 31); }
/* numbers of 32 bits with these lower and higher halves, as v_interleave_ arranges lanes */
static inline vec v_join_low(vec low, vec high) { return v_interleave_low(low, high); }
static inline vec v_join_high(vec low, vec high) { return v_interleave_high(low, high); }
/* the lower halves of all lanes, the higher ones; in the order that v_interleave_ takes apart */
static inline vec v_pack_low(vec a, vec b)
{
    const vec half = _mm512_set1_epi32(0xffff);
    return _mm512_packus_epi32(_mm512_and_si512(a, half), _mm512_and_si512(b, half));
}
static inline vec v_pack_high(vec a, vec b) { return _mm512_packs_epi32(_mm512_srai_epi32(a, 16), _mm512_srai_epi32(b, 16)); }
/* the same of even and odd lanes */
static inline vec v_even(vec a, vec b) { return v_pack_low(a, b); }
static inline vec v_odd(vec a, vec b) { return v_pack_high(a, b); }
/* such a pack of a and b as they came from memory, put into memory's order */
static inline vec v_in_order(vec packed)
{
    return _mm512_permutexvar_epi64(_mm512_set_epi64(7, 5, 3, 1, 6, 4, 2, 0), packed);
}
/* whole parts of sqrt(a) + more, of a / b, in single precision */
static inline vec v_root(vec a, float more)
{
    return _mm512_cvttps_epi32(_mm512_add_ps(_mm512_sqrt_ps(_mm512_cvtepi32_ps(a)), _mm512_set1_ps(more)));
}
static inline vec v_quotient(float a, vec b)
{
    return _mm512_cvttps_epi32(_mm512_div_ps(_mm512_set1_ps(a), _mm512_cvtepi32_ps(b)));
}

#endif
