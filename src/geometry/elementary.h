/* SPDX-License-Identifier: BSD-2-Clause */
/* exp and log from additions, multiplications, divisions and bits alone: inline, which takes half of the instructions of a call,
 * and with the same bits whatever the C library.
 *
 * exp(x) = 2^k exp(r), k the integer next to x / log 2, |r| <= log(2) / 2 and the series of exp up to r^11 / 11! (the rest is below
 * 9e-15 of it). log 2 has two parts, the first with so few bits that k times it is exact (Cody and Waite 1980).
 *
 * log(x) = k log 2 + log m, m between sqrt(1/2) and sqrt(2), and log m = 2 (f + f^3/3 + f^5/5 ...), f = (m - 1) / (m + 1), up to
 * f^17 / 17 (the rest is below 2e-15). */
#ifndef ASJ_SRC_GEOMETRY_ELEMENTARY_H
#define ASJ_SRC_GEOMETRY_ELEMENTARY_H

#include <stdint.h>
#include <string.h>

#define ASJ_LOG2_HIGH 0x1.62e42feep-1 /* 32 bits */
#define ASJ_LOG2_LOW 0x1.a39ef35793c76p-33

static inline double asj_double_of(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline uint64_t asj_bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* exp of a number that is not above 0; 0 where that is below 1e-300. */
static inline double asj_exp_falling(double x)
{
    if (!(x > -690))
        return 0;
    const double shifted = x * 0x1.71547652b82fep+0 + 0x1.8p52, k = shifted - 0x1.8p52; /* the low bits of `shifted` are k */
    const double r = x - k * ASJ_LOG2_HIGH - k * ASJ_LOG2_LOW, r2 = r * r, r4 = r2 * r2;
    const double middle = (1.0 / 24 + r * (1.0 / 120)) + r2 * (1.0 / 720 + r * (1.0 / 5040));
    const double low = (1 + r) + r2 * (0.5 + r * (1.0 / 6)) + r4 * middle;
    const double high = (1.0 / 40320 + r * (1.0 / 362880)) + r2 * (1.0 / 3628800 + r * (1.0 / 39916800));
    return (low + r4 * r4 * high) * asj_double_of((asj_bits_of(shifted) + 1023) << 52);
}

/* log of a positive normal number. */
static inline double asj_log_normal(double x)
{
    const uint64_t bits = asj_bits_of(x), from = asj_bits_of(x) - UINT64_C(0x3fe6a09e667f3bcd); /* sqrt(1/2) */
    const int32_t k = (int32_t)((int64_t)from >> 52);
    const double m = asj_double_of(bits - ((uint64_t)(int64_t)k << 52)), f = (m - 1) / (m + 1), s = f * f, s2 = s * s, s4 = s2 * s2;
    const double low = (1.0 / 3 + s * (1.0 / 5)) + s2 * (1.0 / 7 + s * (1.0 / 9));
    const double high = (1.0 / 11 + s * (1.0 / 13)) + s2 * (1.0 / 15 + s * (1.0 / 17));
    return k * ASJ_LOG2_HIGH + (2 * f + (2 * f * s * (low + s4 * high) + k * ASJ_LOG2_LOW));
}

#endif
