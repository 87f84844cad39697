/* SPDX-License-Identifier: BSD-2-Clause */
/* Colour to luma: 8 pixels at once, 32 bits each. Name as in the reference, image.c. */
#ifndef ASJ_SRC_X86_COLOUR_H
#define ASJ_SRC_X86_COLOUR_H

#include "core/image.h"
#include "shared/pixels.h"
#include "avx2_vectors.h"

static void image_luma_avx2(const uint8_t *pixels, int32_t width, int32_t step, int32_t red, uint16_t *gray)
{
    const __m256i spread = _mm256_setr_epi8(0, 1, 2, -1, 3, 4, 5, -1, 6, 7, 8, -1, 9, 10, 11, -1,
                                            0, 1, 2, -1, 3, 4, 5, -1, 6, 7, 8, -1, 9, 10, 11, -1);
    const int32_t even = red == 0 ? ASJ_LUMA_RED : ASJ_LUMA_BLUE, odd = ASJ_LUMA_RED + ASJ_LUMA_BLUE - even;
    const __m256i byte = v_set1(255), outer = _mm256_set1_epi32(even | odd << 16);
    const __m256i green = _mm256_set1_epi32(ASJ_LUMA_GREEN), half = _mm256_set1_epi32(ASJ_LUMA_HALF);
    const int32_t whole = width > 9 ? (width - 2) & ~7 : 0; /* three bytes a pixel: 28 are read where 24 are needed */
    for (int32_t x = 0; x < whole; x += 8) {
        const uint8_t *p = pixels + (ptrdiff_t)x * step;
        __m256i pixel = _mm256_loadu2_m128i((const __m128i *)(const void *)(p + 4 * step), (const __m128i *)(const void *)p);
        if (step == 3)
            pixel = _mm256_shuffle_epi8(pixel, spread);
        const __m256i sum = _mm256_add_epi32(_mm256_madd_epi16(_mm256_and_si256(pixel, byte), outer),
                                             _mm256_madd_epi16(_mm256_and_si256(_mm256_srli_epi32(pixel, 8), byte), green));
        const __m256i level = _mm256_slli_epi32(_mm256_srli_epi32(_mm256_add_epi32(sum, half), ASJ_LUMA_BITS), 7);
        _mm_storeu_si128((__m128i *)(void *)(gray + x),
                         _mm_packus_epi32(_mm256_castsi256_si128(level), _mm256_extracti128_si256(level, 1)));
    }
    asj_image_luma(pixels + (ptrdiff_t)whole * step, width - whole, step, red, gray + whole);
}

#endif
