/* SPDX-License-Identifier: BSD-2-Clause */
/* Numbers as bytes, the least significant first, whatever the machine's order; a checksum of bytes. */
#ifndef ASJ_SRC_BYTES_H
#define ASJ_SRC_BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static inline void asj_put_u16(uint8_t *to, uint32_t value)
{
    to[0] = (uint8_t)value;
    to[1] = (uint8_t)(value >> 8);
}

static inline void asj_put_u32(uint8_t *to, uint32_t value)
{
    asj_put_u16(to, value);
    asj_put_u16(to + 2, value >> 16);
}

static inline void asj_put_u64(uint8_t *to, uint64_t value)
{
    asj_put_u32(to, (uint32_t)value);
    asj_put_u32(to + 4, (uint32_t)(value >> 32));
}

/* IEEE 754, as all machines have it. */
static inline void asj_put_float(uint8_t *to, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    asj_put_u32(to, bits);
}

static inline uint32_t asj_get_u16(const uint8_t *from)
{
    return (uint32_t)from[0] | (uint32_t)from[1] << 8;
}

static inline uint32_t asj_get_u32(const uint8_t *from)
{
    return asj_get_u16(from) | asj_get_u16(from + 2) << 16;
}

static inline uint64_t asj_get_u64(const uint8_t *from)
{
    return (uint64_t)asj_get_u32(from) | (uint64_t)asj_get_u32(from + 4) << 32;
}

static inline float asj_get_float(const uint8_t *from)
{
    const uint32_t bits = asj_get_u32(from);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* CRC-32 of ISO 3309 (PNG, zip): finds every error of up to 32 neighbouring bits, and of 2^32 others all but one. */
uint32_t asj_crc32(const uint8_t *bytes, size_t size);

#endif
