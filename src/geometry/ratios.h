/* SPDX-License-Identifier: BSD-2-Clause */
/* Likelihood ratios of many candidates: those of likelihood.c, several at once where the processor can. */
#ifndef ASJ_SRC_GEOMETRY_RATIOS_H
#define ASJ_SRC_GEOMETRY_RATIOS_H

#include "likelihood.h"

typedef struct asj_ratio_plan {
    const asj_pairs *set;
    const asj_two_view *view;
    const asj_peaks *peaks;
    int32_t part;
} asj_ratio_plan;

/* Operations (core/ops.h): asj_part_sum() of the candidates with the numbers which[0 .. count - 1]. lines: of the part that is an
 * epipolar geometry, and asj_side_factor(), which tells nothing where the sum is 0 or the part has no sides. places: of others. */
typedef struct asj_ratio_ops {
    void (*lines)(const asj_ratio_plan *plan, const uint32_t *which, int32_t count, double *sums, double *sides);
    void (*places)(const asj_ratio_plan *plan, const uint32_t *which, int32_t count, double *sums);
} asj_ratio_ops;
extern const asj_ratio_ops asj_ratio_reference;

/* asj_likelihood_ratio() of each of them. */
void asj_likelihood_ratios(const asj_two_view *view, const asj_pairs *set, const uint32_t *which, int32_t count,
                           const asj_peaks *peaks, double *ratios);

#endif
