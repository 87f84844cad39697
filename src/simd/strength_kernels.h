/* SPDX-License-Identifier: BSD-2-Clause */
/* Strengths of sectors and their peaks in vectors. Part of kernels.h. */
#ifndef ASJ_SRC_SIMD_STRENGTH_KERNELS_H
#define ASJ_SRC_SIMD_STRENGTH_KERNELS_H

#include <string.h>

static inline vec v_strength(vec sum, uint16_t mean, uint16_t scale)
{
    return v_high_unsigned(v_sub_saturated(sum, v_set1((int16_t)mean)), v_set1((int16_t)scale));
}

/* Strengths with `pad` sectors repeated at either end, so that neighbours need no wrapping: sector k at row k + pad. */
static void repeat_ends(int16_t *z, int32_t count, int32_t pad, size_t row)
{
    memcpy(z, z + (size_t)count * row, (size_t)pad * row * sizeof *z);
    memcpy(z + (size_t)(count + pad) * row, z + (size_t)pad * row, (size_t)pad * row * sizeof *z);
}

/* -1 where the sector at `here` is a peak: above `below` and its `reach` neighbours before it, not below those after it. */
static inline vec peak(const int16_t *here, ptrdiff_t row, int32_t reach, vec below)
{
    const vec z = v_load(here);
    vec before = v_max(below, v_load(here - row)), after = v_load(here + row);
    for (int32_t d = 2; d <= reach; d++) {
        before = v_max(before, v_load(here - d * row));
        after = v_max(after, v_load(here + d * row));
    }
    return v_greater_but(z, before, after, z);
}

/* The same from one sector to the next, for the reach of 2 that all radii have with the default sector width: what neighbours
 * share stays in registers. */
typedef struct peak_walk {
    vec last, before, here, next; /* strengths of sector k - 1, the larger of k - 2 and k - 1, of k, of k + 1 */
} peak_walk;

static inline peak_walk start_peaks(const int16_t *here, ptrdiff_t row, int32_t reach)
{
    const vec last = v_load(here - (reach == 2 ? row : 0)), far = v_load(here - (reach == 2 ? 2 * row : 0));
    return (peak_walk){last, v_max(last, far), v_load(here), v_load(here + row)};
}

/* peak() of the sector at `here`, and its strength; w goes on to the next one. */
static inline vec next_peak(peak_walk *w, const int16_t *here, ptrdiff_t row, int32_t reach, vec below, vec *strength)
{
    *strength = w->here;
    if (reach != 2) {
        w->here = v_load(here + row);
        return peak(here, row, reach, below);
    }
    const vec far = v_load(here + 2 * row);
    const vec is_peak = v_greater_but(w->here, v_max(below, w->before), v_max(w->next, far), w->here);
    *w = (peak_walk){w->here, v_max(w->last, w->here), w->next, far};
    return is_peak;
}

#endif
