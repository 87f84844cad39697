/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_support_gate() (support_gate.c) in lanes of 8. */
#ifndef ASJ_SRC_X86_GATES_H
#define ASJ_SRC_X86_GATES_H

#include "match/support_gate.h"

#include <immintrin.h>

static inline __m256 squares(__m256 x, __m256 y)
{
    return _mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y));
}

/* a x + b y with the numbers at a and b */
static inline __m256 turned(const float *a, const float *b, float x, float y)
{
    const __m256 p = _mm256_mul_ps(_mm256_loadu_ps(a), _mm256_set1_ps(x)), q = _mm256_mul_ps(_mm256_loadu_ps(b), _mm256_set1_ps(y));
    return _mm256_add_ps(p, q);
}

/* Along which branch t may be of an edge; `way`: squares of (ex, ey). */
static inline __m256 gate_edge(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t m, uint32_t t, __m256 ex,
                               __m256 ey, __m256 way)
{
    const __m256 off = _mm256_sub_ps(_mm256_mul_ps(_mm256_set1_ps(query->branch[t][0]), ey),
                                     _mm256_mul_ps(_mm256_set1_ps(query->branch[t][1]), ex));
    const __m256 near = _mm256_cmp_ps(_mm256_andnot_ps(_mm256_set1_ps(-0.0f), off), _mm256_set1_ps((float)ASJ_GATE_ACROSS),
                                      _CMP_LE_OQ);
    const __m256 both = _mm256_add_ps(_mm256_set1_ps(query->length[t]), _mm256_loadu_ps(list->length[1] + m));
    const __m256 here = _mm256_cmp_ps(_mm256_loadu_ps(list->length[0] + m), _mm256_set1_ps(query->least[t]), _CMP_GE_OQ);
    const __m256 there = _mm256_cmp_ps(_mm256_mul_ps(both, both), _mm256_mul_ps(_mm256_set1_ps(query->cover), way), _CMP_GE_OQ);
    return _mm256_and_ps(near, _mm256_and_ps(here, there));
}

/* Eight candidates; few maps of c lead near any of them, so their own maps are seldom needed. */
static inline unsigned gate_eight(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t m)
{
    const __m256 ex = _mm256_sub_ps(_mm256_loadu_ps(list->x + m), _mm256_set1_ps(query->x));
    const __m256 ey = _mm256_sub_ps(_mm256_loadu_ps(list->y + m), _mm256_set1_ps(query->y));
    const __m256 way = squares(ex, ey);
    const __m256 most = _mm256_add_ps(_mm256_set1_ps((float)ASJ_GATE_MOST), _mm256_mul_ps(_mm256_set1_ps(query->slope), way));
    const __m256 c = squares(_mm256_sub_ps(_mm256_set1_ps(query->px), ex), _mm256_sub_ps(_mm256_set1_ps(query->py), ey));
    unsigned may = (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(c, most, _CMP_LE_OQ));
    if (may) {
        const __m256 dx = _mm256_sub_ps(turned(list->map[0] + m, list->map[1] + m, query->way_x, query->way_y), ex);
        const __m256 dy = _mm256_sub_ps(turned(list->map[2] + m, list->map[3] + m, query->way_x, query->way_y), ey);
        may &= (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(squares(dx, dy), most, _CMP_LE_OQ));
    }
    for (uint32_t t = 0; t < 2; t++)
        if (query->edges >> t & 1)
            may |= (unsigned)_mm256_movemask_ps(gate_edge(query, list, m, t, ex, ey, way));
    return may;
}

static uint64_t support_gate_avx2(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t first, uint32_t count)
{
    uint64_t passed = 0;
    for (uint32_t n = 0; n < count; n += 8)
        passed |= (uint64_t)gate_eight(query, list, first + n) << n;
    return passed & ~(uint64_t)0 >> (64 - count);
}

#endif
