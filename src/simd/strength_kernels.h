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

/* The same for three sectors in a row, of which one is a peak at most, for the reach of 2 that all radii have with the default
 * sector width: what neighbours share stays in registers. The next one is sector k. */
typedef struct peak_walk {
    vec larger[3]; /* of the strengths of sectors k - 2 and k - 1, k - 1 and k, k and k + 1 */
    vec here[2];   /* of sectors k and k + 1 */
} peak_walk;

static inline peak_walk start_peaks(const int16_t *here, ptrdiff_t row)
{
    const vec last = v_load(here - row), first = v_load(here), second = v_load(here + row);
    return (peak_walk){{v_max(v_load(here - 2 * row), last), v_max(last, first), v_max(first, second)}, {first, second}};
}

/* Of sectors k .. k + 2, the first one at `here`: whether each is a peak above below[i], or above nothing where that is NULL;
 * returns the largest of their strengths. w goes on to the next one. */
static inline vec next_peaks(peak_walk *w, const int16_t *here, ptrdiff_t row, const vec *below, vec is_peak[3])
{
    const vec z[5] = {w->here[0], w->here[1], v_load(here + 2 * row), v_load(here + 3 * row), v_load(here + 4 * row)};
    const vec after[3] = {v_max(z[1], z[2]), v_max(z[2], z[3]), v_max(z[3], z[4])}, largest = v_max(w->larger[2], z[2]);
    for (int i = 0; i < 3; i++)
        is_peak[i] = v_greater_but(z[i], below ? v_max(below[i], w->larger[i]) : w->larger[i], after[i], z[i]);
    *w = (peak_walk){{after[0], after[1], after[2]}, {z[3], z[4]}};
    return largest;
}

/* Of three sectors in a row from k on the one that is a peak, and -1 where there is one. */
static inline vec peak_of_three(int32_t k, const vec is_peak[3], vec *found)
{
    *found = v_or(v_or(is_peak[0], is_peak[1]), is_peak[2]);
    return v_sub(v_sub(v_set1((int16_t)k), is_peak[1]), v_add(is_peak[2], is_peak[2]));
}

#endif
