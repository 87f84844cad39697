/* SPDX-License-Identifier: BSD-2-Clause */
/* Vectors of NEON, as simd/kernels.h wants them. */
#ifndef ASJ_SRC_ARM_NEON_VECTORS_H
#define ASJ_SRC_ARM_NEON_VECTORS_H

#include <arm_neon.h>
#include <stddef.h>
#include <stdint.h>

#define V_LANES 8
typedef int16x8_t vec;

static inline vec v_load(const void *p) { return vreinterpretq_s16_u8(vld1q_u8(p)); }
/* 8 lanes each from several places */
static inline vec v_load_places(const int16_t *p, const ptrdiff_t *at) { return v_load(p + at[0]); }
/* the same 8 lanes again and again */
static inline vec v_load_repeated(const int16_t *p) { return v_load(p); }
static inline void v_store(void *p, vec v) { vst1q_u8(p, vreinterpretq_u8_s16(v)); }
static inline vec v_set1(int16_t x) { return vdupq_n_s16(x); }
static inline vec v_zero(void) { return vdupq_n_s16(0); }
static inline vec v_add(vec a, vec b) { return vaddq_s16(a, b); }
static inline vec v_sub(vec a, vec b) { return vsubq_s16(a, b); }
static inline vec v_sub_saturated(vec a, vec b)
{
    return vreinterpretq_s16_u16(vqsubq_u16(vreinterpretq_u16_s16(a), vreinterpretq_u16_s16(b)));
}
static inline vec v_abs(vec a) { return vabsq_s16(a); }
static inline vec v_max(vec a, vec b) { return vmaxq_s16(a, b); }
static inline vec v_min(vec a, vec b) { return vminq_s16(a, b); }
/* floor(a b / 2^15) saturates for a = b = -2^15 only, which does not occur */
static inline vec v_high(vec a, vec b) { return vshrq_n_s16(vqdmulhq_s16(a, b), 1); }
static inline vec v_high_unsigned(vec a, vec b)
{
    const uint16x8_t p = vreinterpretq_u16_s16(a), q = vreinterpretq_u16_s16(b);
    const uint32x4_t low = vmull_u16(vget_low_u16(p), vget_low_u16(q)), high = vmull_high_u16(p, q);
    return vreinterpretq_s16_u16(vuzp2q_u16(vreinterpretq_u16_u32(low), vreinterpretq_u16_u32(high)));
}
static inline vec v_and(vec a, vec b) { return vandq_s16(a, b); }
static inline vec v_or(vec a, vec b) { return vorrq_s16(a, b); }
static inline vec v_xor(vec a, vec b) { return veorq_s16(a, b); }
/* -1 where a > b, and where a > b but not c > d */
static inline vec v_greater(vec a, vec b) { return vreinterpretq_s16_u16(vcgtq_s16(a, b)); }
static inline vec v_greater_but(vec a, vec b, vec c, vec d) { return vbicq_s16(v_greater(a, b), v_greater(c, d)); }
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v)
{
    static const uint16_t weights[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    return vaddvq_u16(vandq_u16(vreinterpretq_u16_s16(v), vld1q_u16(weights)));
}
static inline int v_any(vec v) { return vmaxvq_u16(vreinterpretq_u16_s16(v)) != 0; }

static inline vec v_low(vec a, vec b) { return vmulq_s16(a, b); }
static inline vec v_shift_right_8(vec a) { return vreinterpretq_s16_u16(vshrq_n_u16(vreinterpretq_u16_s16(a), 8)); }
static inline vec v_shift_right_15(vec a) { return vreinterpretq_s16_u16(vshrq_n_u16(vreinterpretq_u16_s16(a), 15)); }
static inline vec v_interleave_low(vec a, vec b) { return vzip1q_s16(a, b); }
static inline vec v_interleave_high(vec a, vec b) { return vzip2q_s16(a, b); }
static inline vec v_interleave32_low(vec a, vec b)
{
    return vreinterpretq_s16_s32(vzip1q_s32(vreinterpretq_s32_s16(a), vreinterpretq_s32_s16(b)));
}
static inline vec v_interleave32_high(vec a, vec b)
{
    return vreinterpretq_s16_s32(vzip2q_s32(vreinterpretq_s32_s16(a), vreinterpretq_s32_s16(b)));
}
static inline vec v_interleave64_low(vec a, vec b)
{
    return vreinterpretq_s16_s64(vzip1q_s64(vreinterpretq_s64_s16(a), vreinterpretq_s64_s16(b)));
}
static inline vec v_interleave64_high(vec a, vec b)
{
    return vreinterpretq_s16_s64(vzip2q_s64(vreinterpretq_s64_s16(a), vreinterpretq_s64_s16(b)));
}

/* ---- lanes of 32 bits ---- */

static inline vec from32(int32x4_t a) { return vreinterpretq_s16_s32(a); }
static inline int32x4_t to32(vec a) { return vreinterpretq_s32_s16(a); }
static inline vec v_set1_32(int32_t x) { return from32(vdupq_n_s32(x)); }
static inline vec v_add32(vec a, vec b) { return from32(vaddq_s32(to32(a), to32(b))); }
static inline vec v_sub32(vec a, vec b) { return from32(vsubq_s32(to32(a), to32(b))); }
/* signed 16-bit lanes: a b + next a next b */
static inline vec v_pairs(vec a, vec b)
{
    return from32(vpaddq_s32(vmull_s16(vget_low_s16(a), vget_low_s16(b)), vmull_high_s16(a, b)));
}
/* the sum of all 32-bit lanes */
static inline int32_t v_sum32(vec v) { return vaddvq_s32(to32(v)); }
/* the lower halves of products */
static inline vec v_low32(vec a, vec b) { return from32(vmulq_s32(to32(a), to32(b))); }
/* the lower 32 bits of each 64, multiplied */
static inline vec v_products32(vec a, vec b)
{
    return vreinterpretq_s16_u64(vmull_u32(vmovn_u64(vreinterpretq_u64_s16(a)), vmovn_u64(vreinterpretq_u64_s16(b))));
}
static inline vec v_max32(vec a, vec b) { return from32(vmaxq_s32(to32(a), to32(b))); }
static inline vec v_shift_right32_8(vec a) { return vreinterpretq_s16_u32(vshrq_n_u32(vreinterpretq_u32_s16(a), 8)); }
/* -1 where below zero, else 0 */
static inline vec v_negative32(vec a) { return from32(vshrq_n_s32(to32(a), 31)); }
/* numbers of 32 bits with these lower and higher halves, as v_interleave_ arranges lanes */
static inline vec v_join_low(vec low, vec high) { return v_interleave_low(low, high); }
static inline vec v_join_high(vec low, vec high) { return v_interleave_high(low, high); }
/* the lower halves of all lanes, the higher ones; in the order that v_interleave_ takes apart */
static inline vec v_pack_low(vec a, vec b) { return vuzp1q_s16(a, b); }
static inline vec v_pack_high(vec a, vec b) { return vuzp2q_s16(a, b); }
/* the same of even and odd lanes */
static inline vec v_even(vec a, vec b) { return v_pack_low(a, b); }
static inline vec v_odd(vec a, vec b) { return v_pack_high(a, b); }
/* such a pack of a and b as they came from memory, put into memory's order */
static inline vec v_in_order(vec packed) { return packed; }
/* whole parts of sqrt(a) + more, of a / b, in single precision */
static inline vec v_root(vec a, float more)
{
    return from32(vcvtq_s32_f32(vaddq_f32(vsqrtq_f32(vcvtq_f32_s32(to32(a))), vdupq_n_f32(more))));
}
static inline vec v_quotient(float a, vec b) { return from32(vcvtq_s32_f32(vdivq_f32(vdupq_n_f32(a), vcvtq_f32_s32(to32(b))))); }

#endif
