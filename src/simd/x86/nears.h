/* SPDX-License-Identifier: BSD-2-Clause */
/* Which candidates are near a geometry (near.c), in lanes of 8. */
#ifndef ASJ_SRC_X86_NEARS_H
#define ASJ_SRC_X86_NEARS_H

#include "core/lowest_bit.h"
#include "geometry/near.h"

#include <immintrin.h>

/* Row k of the matrix at (x, y). */
static inline __m256 near_row(const asj_near_plan *p, int k, __m256 x, __m256 y)
{
    const float *m = p->m + 3 * k;
    const __m256 both = _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(m[0]), x), _mm256_mul_ps(_mm256_set1_ps(m[1]), y));
    return _mm256_add_ps(both, _mm256_set1_ps(m[2]));
}

/* One bit for each of eight, where a <= factor b + extra. */
static inline unsigned near_bits(const asj_near_plan *p, __m256 a, __m256 b)
{
    const __m256 most = _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(p->factor), b), _mm256_set1_ps(p->extra));
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, most, _CMP_LE_OQ));
}

static inline unsigned near_lines_eight(const asj_near_plan *p, const float *const at[4], int32_t k)
{
    const __m256 x1 = _mm256_loadu_ps(at[0] + k), y1 = _mm256_loadu_ps(at[1] + k);
    const __m256 nx = near_row(p, 0, x1, y1), ny = near_row(p, 1, x1, y1), nz = near_row(p, 2, x1, y1);
    const __m256 x2 = _mm256_loadu_ps(at[2] + k), y2 = _mm256_loadu_ps(at[3] + k);
    const __m256 e = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x2, nx), _mm256_mul_ps(y2, ny)), nz);
    return near_bits(p, _mm256_mul_ps(e, e), _mm256_add_ps(_mm256_mul_ps(nx, nx), _mm256_mul_ps(ny, ny)));
}

static inline unsigned near_places_eight(const asj_near_plan *p, const float *const at[4], int32_t k)
{
    const __m256 x1 = _mm256_loadu_ps(at[0] + k), y1 = _mm256_loadu_ps(at[1] + k), w = near_row(p, 2, x1, y1);
    const __m256 dx = _mm256_sub_ps(_mm256_mul_ps(_mm256_loadu_ps(at[2] + k), w), near_row(p, 0, x1, y1));
    const __m256 dy = _mm256_sub_ps(_mm256_mul_ps(_mm256_loadu_ps(at[3] + k), w), near_row(p, 1, x1, y1));
    return near_bits(p, _mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(w, w));
}

/* Those of `bits`, which are `some`, from candidate k on. */
static inline int32_t near_list(unsigned bits, int32_t k, int32_t some, uint32_t *near)
{
    int32_t found = 0;
    for (bits &= some < 32 ? (1u << some) - 1 : ~0u; bits; bits &= bits - 1)
        near[found++] = (uint32_t)k + asj_lowest_bit(bits);
    return found;
}

static int32_t near_lines_avx2(const asj_near_plan *plan, const float *const at[4], int32_t count, uint32_t *near)
{
    int32_t found = 0;
    for (int32_t k = 0; k < count; k += 8)
        found += near_list(near_lines_eight(plan, at, k), k, count - k, near + found);
    return found;
}

static int32_t near_places_avx2(const asj_near_plan *plan, const float *const at[4], int32_t count, uint32_t *near)
{
    int32_t found = 0;
    for (int32_t k = 0; k < count; k += 8)
        found += near_list(near_places_eight(plan, at, k), k, count - k, near + found);
    return found;
}

#endif
