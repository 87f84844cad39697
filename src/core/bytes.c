/* SPDX-License-Identifier: BSD-2-Clause */
/* CRC-32: the remainder of the bits, first bit first, as a polynomial over GF(2) divided by x^32 + x^26 + x^23 + x^22 + x^16 +
 * x^12 + x^11 + x^10 + x^8 + x^7 + x^5 + x^4 + x^2 + x + 1 (ISO 3309; 0xedb88320 with the lowest power in the highest bit); the
 * register is all ones at first, and inverted in the end. Four bytes at once: a table for each of them says what its bits leave
 * behind after the bytes that follow it. */
#include "bytes.h"

#define POLYNOMIAL 0xedb88320u

static void fill(uint32_t table[4][256])
{
    for (uint32_t byte = 0; byte < 256; byte++) {
        uint32_t rest = byte;
        for (int32_t bit = 0; bit < 8; bit++)
            rest = rest & 1 ? rest >> 1 ^ POLYNOMIAL : rest >> 1;
        table[0][byte] = rest;
    }
    for (uint32_t byte = 0; byte < 256; byte++)
        for (int32_t k = 1; k < 4; k++)
            table[k][byte] = table[k - 1][byte] >> 8 ^ table[0][table[k - 1][byte] & 255];
}

uint32_t asj_crc32(const uint8_t *bytes, size_t size)
{
    uint32_t table[4][256], rest = 0xffffffffu;
    fill(table);
    for (; size >= 4; size -= 4, bytes += 4) {
        rest ^= asj_get_u32(bytes);
        rest = table[3][rest & 255] ^ table[2][rest >> 8 & 255] ^ table[1][rest >> 16 & 255] ^ table[0][rest >> 24];
    }
    for (; size > 0; size--, bytes++)
        rest = rest >> 8 ^ table[0][(rest ^ *bytes) & 255];
    return ~rest;
}
