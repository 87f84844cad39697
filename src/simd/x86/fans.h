/* SPDX-License-Identifier: BSD-2-Clause */
/* Fans of rays, four at once: names as in the reference, edge_fan.c. */
#ifndef ASJ_SRC_X86_FANS_H
#define ASJ_SRC_X86_FANS_H

#include "detect/edge_fan.h"
#include "detect/gradient.h"
#include "detect/strip.h"

#include <immintrin.h>

/* As asj_strip_floor(). */
static inline __m128i floor_of_four(__m256d v)
{
    const __m128i far = _mm256_cvttpd_epi32(_mm256_add_pd(v, _mm256_set1_pd(131072)));
    return _mm_sub_epi32(far, _mm_set1_epi32(131072));
}

/* Four pixels of a plane, from the one before them, which is read too. */
static inline __m256d pixels_at(const int16_t *before, __m128i places)
{
    return _mm256_cvtepi32_pd(_mm_srai_epi32(_mm_i32gather_epi32((const int *)(const void *)before, places, 2), 16));
}

static void edge_fan_avx2(const asj_frame *frame, const asj_edge_fan *fan, double x, double y, double means[ASJ_FAN_RAYS])
{
    const __m256d sign = _mm256_set1_pd(-0.0), half = _mm256_set1_pd(0.5), from_x = _mm256_set1_pd(x), from_y = _mm256_set1_pd(y);
    const int32_t column = asj_strip_floor(x), row = asj_strip_floor(y);
    const ptrdiff_t before = row * frame->stride + column - 1; /* of the pixel around which places are counted */
    const __m128i columns = _mm_set1_epi32(column), rows = _mm_set1_epi32(row), stride = _mm_set1_epi32((int32_t)frame->stride);
    for (int32_t i = 0; i < fan->count; i += 4) {
        const __m256d ux = _mm256_loadu_pd(fan->ux + i), uy = _mm256_loadu_pd(fan->uy + i);
        __m256d sum = _mm256_setzero_pd();
        for (int32_t r = ASJ_FAN_FIRST; r <= ASJ_FAN_LAST; r++) {
            const __m256d far = _mm256_set1_pd(r);
            const __m128i px = floor_of_four(_mm256_add_pd(_mm256_add_pd(from_x, _mm256_mul_pd(far, ux)), half));
            const __m128i py = floor_of_four(_mm256_add_pd(_mm256_add_pd(from_y, _mm256_mul_pd(far, uy)), half));
            const __m128i down = _mm_mullo_epi32(_mm_sub_epi32(py, rows), stride);
            const __m128i places = _mm_add_epi32(down, _mm_sub_epi32(px, columns));
            const __m256d gx = pixels_at(frame->gradient_x + before, places);
            const __m256d gy = pixels_at(frame->gradient_y + before, places);
            const __m256d across = _mm256_sub_pd(_mm256_mul_pd(gy, ux), _mm256_mul_pd(gx, uy));
            const __m256d along = _mm256_add_pd(_mm256_mul_pd(gx, ux), _mm256_mul_pd(gy, uy));
            const __m256d gamma = _mm256_sub_pd(_mm256_andnot_pd(sign, across), _mm256_andnot_pd(sign, along));
            sum = _mm256_add_pd(sum, _mm256_add_pd(gamma, _mm256_andnot_pd(sign, gamma)));
        }
        const __m256d samples = _mm256_set1_pd((ASJ_FAN_LAST - ASJ_FAN_FIRST + 1) * ASJ_GRADIENT_ONE);
        _mm256_storeu_pd(means + i, _mm256_div_pd(_mm256_mul_pd(half, sum), samples));
    }
}

#endif
