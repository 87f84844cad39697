/* SPDX-License-Identifier: BSD-2-Clause */
/* Every hypothesis is judged by hundreds of candidates that are near it, so what takes time for each of them is an operation. */
#include "ratios.h"

#include <stddef.h>
#include <string.h>

#define AT_ONCE 64

static void sum_lines(const asj_ratio_plan *plan, const uint32_t *which, int32_t count, double *sums, double *sides)
{
    const int32_t has_sides = asj_part_has_sides(plan->view, plan->part);
    for (int32_t n = 0; n < count; n++) {
        const asj_pair *c = &plan->set->list[which[n]];
        sums[n] = asj_part_sum(plan->view, plan->part, plan->set, c, plan->peaks);
        sides[n] = sums[n] > 0 && has_sides ? asj_side_factor(plan->view, c) : 1;
    }
}

static void sum_places(const asj_ratio_plan *plan, const uint32_t *which, int32_t count, double *sums)
{
    for (int32_t n = 0; n < count; n++)
        sums[n] = asj_part_sum(plan->view, plan->part, plan->set, &plan->set->list[which[n]], plan->peaks);
}

const asj_ratio_ops asj_ratio_reference = {.lines = sum_lines, .places = sum_places};

/* Adds the ratios of one part, as asj_part_ratio() has them. */
static void add_part(const asj_ratio_plan *plan, const uint32_t *which, int32_t count, double *ratios)
{
    const double peak = asj_part_peak(plan->view, plan->part, plan->peaks);
    const int32_t has_sides = asj_part_has_sides(plan->view, plan->part);
    double sums[AT_ONCE], sides[AT_ONCE];
    if (asj_part_is_planar(plan->view, plan->part))
        plan->set->ratio->places(plan, which, count, sums);
    else
        plan->set->ratio->lines(plan, which, count, sums, sides);
    for (int32_t n = 0; n < count; n++)
        if (sums[n] > 0)
            ratios[n] += asj_part_product(plan->peaks, &plan->set->list[which[n]], peak, sums[n], has_sides ? sides[n] : 1);
}

void asj_likelihood_ratios(const asj_two_view *view, const asj_pairs *set, const uint32_t *which, int32_t count,
                           const asj_peaks *peaks, double *ratios)
{
    memset(ratios, 0, (size_t)count * sizeof *ratios);
    for (int32_t first = 0; first < count; first += AT_ONCE)
        for (int32_t part = 0; part <= view->plane_count; part++) {
            const asj_ratio_plan plan = {set, view, peaks, part};
            add_part(&plan, which + first, count - first < AT_ONCE ? count - first : AT_ONCE, ratios + first);
        }
}
