/* SPDX-License-Identifier: BSD-2-Clause */
/* Vectors of 128 bits in the language of gcc and clang, as simd/kernels.h wants them: the compiler makes of them what the processor
 * has. Where the language has no word for an operation it is a loop over the lanes, of which optimisation makes one instruction
 * where there is one. Lane i is element i of memory, whatever the order of bytes; that matters only where halves of numbers are
 * lanes. */
#ifndef ASJ_SRC_GNU_GNU_VECTORS_H
#define ASJ_SRC_GNU_GNU_VECTORS_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define V_LANES 8
typedef int16_t vec __attribute__((vector_size(16)));
typedef uint16_t unsigned_vec __attribute__((vector_size(16)));
typedef int32_t vec32 __attribute__((vector_size(16)));
typedef uint32_t unsigned_vec32 __attribute__((vector_size(16)));
typedef uint64_t vec64 __attribute__((vector_size(16)));
typedef float vec_float __attribute__((vector_size(16)));

#if defined(__clang__) || __GNUC__ >= 12
#define V_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define V_SHUFFLE(a, b, ...) __builtin_shuffle(a, b, (vec){__VA_ARGS__})
#endif

static inline vec v_load(const void *p)
{
    vec v;
    memcpy(&v, p, sizeof v);
    return v;
}
/* 8 lanes each from several places */
static inline vec v_load_places(const int16_t *p, const ptrdiff_t *at) { return v_load(p + at[0]); }
/* the same 8 lanes again and again */
static inline vec v_load_repeated(const int16_t *p) { return v_load(p); }
static inline void v_store(void *p, vec v) { memcpy(p, &v, sizeof v); }
static inline vec v_set1(int16_t x) { return (vec){x, x, x, x, x, x, x, x}; }
static inline vec v_zero(void) { return v_set1(0); }
static inline vec v_add(vec a, vec b) { return (vec)((unsigned_vec)a + (unsigned_vec)b); }
static inline vec v_sub(vec a, vec b) { return (vec)((unsigned_vec)a - (unsigned_vec)b); }
static inline vec v_and(vec a, vec b) { return a & b; }
static inline vec v_or(vec a, vec b) { return a | b; }
static inline vec v_xor(vec a, vec b) { return a ^ b; }
static inline vec v_choose(vec first, vec a, vec b) { return (a & first) | (b & ~first); }
static inline vec v_sub_saturated(vec a, vec b)
{
    const unsigned_vec p = (unsigned_vec)a, q = (unsigned_vec)b;
    return (vec)(p - q) & (vec)(p > q);
}
static inline vec v_abs(vec a) { return v_sub(a ^ (a >> 15), a >> 15); }
static inline vec v_max(vec a, vec b)
{
    int16_t p[V_LANES], q[V_LANES];
    v_store(p, a);
    v_store(q, b);
#pragma GCC unroll 1 /* so that it becomes vectors */
    for (int i = 0; i < V_LANES; i++)
        p[i] = p[i] > q[i] ? p[i] : q[i];
    return v_load(p);
}
static inline vec v_min(vec a, vec b)
{
    int16_t p[V_LANES], q[V_LANES];
    v_store(p, a);
    v_store(q, b);
#pragma GCC unroll 1 /* so that it becomes vectors */
    for (int i = 0; i < V_LANES; i++)
        p[i] = p[i] < q[i] ? p[i] : q[i];
    return v_load(p);
}
/* In lanes of 32 bits, of which each holds two factors: of what is written as a loop over 16 bits gcc 12 makes products whose even
 * ones are wrong where there is no vector unit (32-bit ARM without NEON, i686 without SSE2). */
static inline vec v_high(vec a, vec b)
{
    const vec32 even = ((vec32)((unsigned_vec32)a << 16) >> 16) * ((vec32)((unsigned_vec32)b << 16) >> 16);
    const vec32 odd = ((vec32)a >> 16) * ((vec32)b >> 16);
    return (vec)(((unsigned_vec32)even >> 16) | ((unsigned_vec32)odd & 0xffff0000));
}
static inline vec v_high_unsigned(vec a, vec b)
{
    const unsigned_vec32 even = ((unsigned_vec32)a & 0xffff) * ((unsigned_vec32)b & 0xffff);
    const unsigned_vec32 odd = ((unsigned_vec32)a >> 16) * ((unsigned_vec32)b >> 16);
    return (vec)((even >> 16) | (odd & 0xffff0000));
}
/* -1 where a > b, and where a > b but not c > d */
static inline vec v_greater(vec a, vec b) { return a > b; }
static inline vec v_greater_but(vec a, vec b, vec c, vec d) { return (a > b) & ~(c > d); }
/* one bit for each lane that is -1 (the others are 0) */
static inline uint32_t v_bits(vec v)
{
    const vec64 bits = (vec64)(v & (vec){1, 2, 4, 8, 16, 32, 64, 128});
    uint64_t all = bits[0] | bits[1];
    all |= all >> 32;
    return (uint32_t)(all | all >> 16) & 0xff;
}
static inline int v_any(vec v) { return (((vec64)v)[0] | ((vec64)v)[1]) != 0; }

static inline vec v_low(vec a, vec b) { return (vec)((unsigned_vec)a * (unsigned_vec)b); }
static inline vec v_shift_right_8(vec a) { return (vec)((unsigned_vec)a >> 8); }
static inline vec v_shift_right_15(vec a) { return (vec)((unsigned_vec)a >> 15); }
static inline vec v_interleave_low(vec a, vec b) { return V_SHUFFLE(a, b, 0, 8, 1, 9, 2, 10, 3, 11); }
static inline vec v_interleave_high(vec a, vec b) { return V_SHUFFLE(a, b, 4, 12, 5, 13, 6, 14, 7, 15); }
static inline vec v_interleave32_low(vec a, vec b) { return V_SHUFFLE(a, b, 0, 1, 8, 9, 2, 3, 10, 11); }
static inline vec v_interleave32_high(vec a, vec b) { return V_SHUFFLE(a, b, 4, 5, 12, 13, 6, 7, 14, 15); }
static inline vec v_interleave64_low(vec a, vec b) { return V_SHUFFLE(a, b, 0, 1, 2, 3, 8, 9, 10, 11); }
static inline vec v_interleave64_high(vec a, vec b) { return V_SHUFFLE(a, b, 4, 5, 6, 7, 12, 13, 14, 15); }

/* ---- lanes of 32 bits ---- */

static inline vec v_set1_32(int32_t x) { return (vec)(vec32){x, x, x, x}; }
static inline vec v_add32(vec a, vec b) { return (vec)((unsigned_vec32)a + (unsigned_vec32)b); }
static inline vec v_sub32(vec a, vec b) { return (vec)((unsigned_vec32)a - (unsigned_vec32)b); }
/* signed 16-bit lanes: a b + next a next b. Of each 32 bits, the product of the lower halves and that of the higher ones. */
static inline vec v_pairs(vec a, vec b)
{
    const unsigned_vec32 low = (unsigned_vec32)v_low(a, b), high = (unsigned_vec32)v_high(a, b);
    return (vec)(((low & 0xffff) | high << 16) + (low >> 16 | (high & 0xffff0000)));
}
/* the sum of all 32-bit lanes */
static inline int32_t v_sum32(vec v)
{
    const unsigned_vec32 lanes = (unsigned_vec32)v;
    return (int32_t)((lanes[0] + lanes[2]) + (lanes[1] + lanes[3]));
}
/* the lower halves of products */
static inline vec v_low32(vec a, vec b) { return (vec)((unsigned_vec32)a * (unsigned_vec32)b); }
static inline vec v_max32(vec a, vec b) { return v_choose((vec)((vec32)a > (vec32)b), a, b); }
static inline vec v_shift_right32_8(vec a) { return (vec)((unsigned_vec32)a >> 8); }
/* -1 where below zero, else 0 */
static inline vec v_negative32(vec a) { return (vec)((vec32)a >> 31); }
/* the even lanes of both, the odd ones; numbers of 32 bits with these lower and higher halves, as v_interleave_ arranges lanes; the
 * lower halves of all lanes, the higher ones, back again */
static inline vec v_even(vec a, vec b) { return V_SHUFFLE(a, b, 0, 2, 4, 6, 8, 10, 12, 14); }
static inline vec v_odd(vec a, vec b) { return V_SHUFFLE(a, b, 1, 3, 5, 7, 9, 11, 13, 15); }
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
static inline vec v_join_low(vec low, vec high) { return v_interleave_low(high, low); }
static inline vec v_join_high(vec low, vec high) { return v_interleave_high(high, low); }
static inline vec v_pack_low(vec a, vec b) { return v_odd(a, b); }
static inline vec v_pack_high(vec a, vec b) { return v_even(a, b); }
#else
static inline vec v_join_low(vec low, vec high) { return v_interleave_low(low, high); }
static inline vec v_join_high(vec low, vec high) { return v_interleave_high(low, high); }
static inline vec v_pack_low(vec a, vec b) { return v_even(a, b); }
static inline vec v_pack_high(vec a, vec b) { return v_odd(a, b); }
#endif
/* such a pack of a and b as they came from memory, put into memory's order */
static inline vec v_in_order(vec packed) { return packed; }
/* whole parts of sqrt(a) + more, of a / b, in single precision */
static inline vec v_root(vec a, float more)
{
    vec_float root = __builtin_convertvector((vec32)a, vec_float);
#pragma GCC unroll 1
    for (int i = 0; i < V_LANES / 2; i++)
        root[i] = __builtin_sqrtf(root[i]);
    return (vec)__builtin_convertvector(root + more, vec32);
}
static inline vec v_quotient(float a, vec b)
{
    return (vec)__builtin_convertvector(a / __builtin_convertvector((vec32)b, vec_float), vec32);
}

#endif
