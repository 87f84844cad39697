/* SPDX-License-Identifier: BSD-2-Clause */
/* As gates.h, for 16 lanes. */
#ifndef ASJ_SRC_X86_GATES512_H
#define ASJ_SRC_X86_GATES512_H

#include "match/support_gate.h"

#include <immintrin.h>

static inline __m512 squares(__m512 x, __m512 y)
{
    return _mm512_add_ps(_mm512_mul_ps(x, x), _mm512_mul_ps(y, y));
}

/* a x + b y with the numbers at a and b */
static inline __m512 turned(const float *a, const float *b, float x, float y)
{
    const __m512 p = _mm512_mul_ps(_mm512_loadu_ps(a), _mm512_set1_ps(x)), q = _mm512_mul_ps(_mm512_loadu_ps(b), _mm512_set1_ps(y));
    return _mm512_add_ps(p, q);
}

/* Along which branch t may be of an edge; `way`: squares of (ex, ey). */
static inline unsigned gate_edge(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t m, uint32_t t, __m512 ex,
                                 __m512 ey, __m512 way)
{
    const __m512 off = _mm512_sub_ps(_mm512_mul_ps(_mm512_set1_ps(query->branch[t][0]), ey),
                                     _mm512_mul_ps(_mm512_set1_ps(query->branch[t][1]), ex));
    const __mmask16 near = _mm512_cmp_ps_mask(_mm512_abs_ps(off), _mm512_set1_ps((float)ASJ_GATE_ACROSS), _CMP_LE_OQ);
    const __mmask16 here = _mm512_mask_cmp_ps_mask(near, _mm512_loadu_ps(list->length[0] + m), _mm512_set1_ps(query->least[t]),
                                                   _CMP_GE_OQ);
    const __m512 both = _mm512_add_ps(_mm512_set1_ps(query->length[t]), _mm512_loadu_ps(list->length[1] + m));
    return _mm512_mask_cmp_ps_mask(here, _mm512_mul_ps(both, both), _mm512_mul_ps(_mm512_set1_ps(query->cover), way), _CMP_GE_OQ);
}

/* Sixteen candidates. */
static inline unsigned gate_sixteen(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t m)
{
    const __m512 ex = _mm512_sub_ps(_mm512_loadu_ps(list->x + m), _mm512_set1_ps(query->x));
    const __m512 ey = _mm512_sub_ps(_mm512_loadu_ps(list->y + m), _mm512_set1_ps(query->y));
    const __m512 way = squares(ex, ey);
    const __m512 most = _mm512_add_ps(_mm512_set1_ps((float)ASJ_GATE_MOST), _mm512_mul_ps(_mm512_set1_ps(query->slope), way));
    const __m512 c = squares(_mm512_sub_ps(_mm512_set1_ps(query->px), ex), _mm512_sub_ps(_mm512_set1_ps(query->py), ey));
    unsigned may = _mm512_cmp_ps_mask(c, most, _CMP_LE_OQ);
    if (may) {
        const __m512 dx = _mm512_sub_ps(turned(list->map[0] + m, list->map[1] + m, query->way_x, query->way_y), ex);
        const __m512 dy = _mm512_sub_ps(turned(list->map[2] + m, list->map[3] + m, query->way_x, query->way_y), ey);
        may &= _mm512_cmp_ps_mask(squares(dx, dy), most, _CMP_LE_OQ);
    }
    for (uint32_t t = 0; t < 2; t++)
        if (query->edges >> t & 1)
            may |= gate_edge(query, list, m, t, ex, ey, way);
    return may;
}

static uint64_t support_gate_avx512(const asj_gate_query *query, const asj_gate_candidates *list, uint32_t first, uint32_t count)
{
    uint64_t passed = 0;
    for (uint32_t n = 0; n < count; n += 16)
        passed |= (uint64_t)gate_sixteen(query, list, first + n) << n;
    return passed & ~(uint64_t)0 >> (64 - count);
}

#endif
