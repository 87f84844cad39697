/* SPDX-License-Identifier: BSD-2-Clause */
/* Part of every 64-bit ARM processor. */
#include <arm_neon.h>
#include <stddef.h>
#include <stdint.h>

#define V_LANES 8
typedef int16x8_t vec;

static inline vec v_load(const void *p) { return vreinterpretq_s16_u8(vld1q_u8(p)); }
/* 8 lanes each from several places */
static inline vec v_load_windows(const int16_t *const *p, ptrdiff_t at) { return v_load(p[0] + at); }
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
/* -1 where a > b, and where not a > b, and b */
static inline vec v_greater(vec a, vec b) { return vreinterpretq_s16_u16(vcgtq_s16(a, b)); }
static inline vec v_not_and(vec a, vec b) { return vbicq_s16(b, a); }
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v)
{
    static const uint16_t weights[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    return vaddvq_u16(vandq_u16(vreinterpretq_u16_s16(v), vld1q_u16(weights)));
}
static inline int v_any(vec v) { return vmaxvq_u16(vreinterpretq_u16_s16(v)) != 0; }

#define V_NAME(name) name##_neon
#include "../simd/kernels.h"
