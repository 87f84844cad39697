/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3 in vectors: isotropic junctions at the candidates of a band of rows. Part of kernels.h.
 *
 * Candidates come in clusters of two or three pixels, so vectors of neighbouring pixels would be mostly empty: see
 * batch_kernels.h. */
#ifndef ASJ_SRC_SIMD_ISOTROPIC_KERNELS_H
#define ASJ_SRC_SIMD_ISOTROPIC_KERNELS_H

#include "batch_kernels.h"
#include "detect/isotropic.h"
#include "strength_kernels.h"

/* The sum of sector k where `is_peak`, else 0. */
static inline vec sum_of_peak(const asj_sector_plan *plan, const uint16_t *slots, int32_t k, vec is_peak)
{
    return v_and(is_peak, v_sub(v_load(slots + plan->high[k] * V_LANES), v_load(slots + plan->low[k] * V_LANES)));
}

/* The strongest peaks of each candidate by sum. Sums start at -2^15, so that they compare as signed numbers; one of 0 is none. */
static void rank_by_sum(const asj_isotropic_radius *entry, int32_t most, const uint16_t *slots, const int16_t *z, ranking *ranked)
{
    const asj_sector_plan *plan = &entry->plan;
    const int32_t count = entry->sectors.count, reach = entry->suppress;
    const uint16_t *const least = entry->least;
    const vec none = v_set1(INT16_MIN);
    int32_t k = 0;
    start_ranking(ranked, most, none);
    if (reach == 2)
        for (peak_walk walk = start_peaks(z, V_LANES); k + 3 <= count; k += 3) {
            vec below[3], is_peak[3], found, sum = v_zero();
            for (int i = 0; i < 3; i++)
                below[i] = v_set1((int16_t)(least[k + i] - 1));
            next_peaks(&walk, z + k * V_LANES, V_LANES, below, is_peak);
            for (int i = 0; i < 3; i++)
                sum = v_or(sum, sum_of_peak(plan, slots, k + i, is_peak[i]));
            const vec sector = peak_of_three(k, is_peak, &found);
            insert_peaks(ranked, most, v_add(sum, none), sector);
        }
    while (k < count) {
        vec sum = v_zero(), sector = v_zero();
        for (const int32_t end = count - k <= reach ? count : k + reach + 1; k < end; k++) {
            const vec is_peak = peak(z + k * V_LANES, V_LANES, reach, v_set1((int16_t)(least[k] - 1)));
            sum = v_or(sum, sum_of_peak(plan, slots, k, is_peak));
            sector = v_or(sector, v_and(is_peak, v_set1((int16_t)k)));
        }
        insert_peaks(ranked, most, v_add(sum, none), sector);
    }
}

/* -1 where the strongest branches may be meaningful, for what asj_isotropic_judge() asks first; most candidates fail at a small
 * radius. */
static vec worth_judging(const asj_isotropic *test, const asj_isotropic_radius *entry, const ranking *ranked)
{
    const vec turn = v_sub(ranked->sectors[0], ranked->sectors[1]), apart = v_max(turn, v_sub(v_zero(), turn));
    const vec opening = v_min(apart, v_sub(v_set1((int16_t)entry->sectors.count), apart));
    vec worth = v_zero();
    for (int32_t m = 2; m <= test->max_branches; m++) {
        const int32_t least = entry->least_sum[m] > 1 ? entry->least_sum[m] : 1; /* a sum of 0 is no branch */
        const vec below = v_set1((int16_t)(least <= UINT16_MAX ? least - 1 + INT16_MIN : INT16_MAX));
        const vec straight = v_set1((int16_t)(m == 2 ? entry->straight : INT16_MAX));
        worth = v_or(worth, v_greater_but(ranked->values[m - 1], below, opening, straight));
    }
    return worth;
}

/* One radius: the branches of each candidate that may matter, then the shared decision. */
static void test_batch(const asj_isotropic *test, const asj_isotropic_radius *entry, const uint16_t *slots, const int16_t *z,
                       int32_t count, asj_isotropic_junction *junctions)
{
    ranking ranked;
    uint16_t sums[ASJ_MAX_BRANCHES][V_LANES], sectors[ASJ_MAX_BRANCHES][V_LANES];
    z += entry->suppress * V_LANES;
    rank_by_sum(entry, test->max_branches, slots, z, &ranked);
    for (int32_t m = 0; m < test->max_branches; m++) {
        v_store(sums[m], v_add(ranked.values[m], v_set1(INT16_MIN)));
        v_store(sectors[m], ranked.sectors[m]);
    }
    const uint32_t lanes = (uint32_t)(((uint64_t)1 << count) - 1);
    for (uint32_t bits = v_bits(worth_judging(test, entry, &ranked)) & lanes; bits; bits &= bits - 1) {
        const int i = __builtin_ctz(bits);
        asj_isotropic_peak peaks[ASJ_MAX_BRANCHES];
        int32_t found = 0;
        for (; found < test->max_branches && sums[found][i]; found++) {
            const int32_t k = sectors[found][i];
            peaks[found] = (asj_isotropic_peak){k, sums[found][i], (uint16_t)z[k * V_LANES + i]};
        }
        asj_isotropic_judge(test, entry, peaks, found, &junctions[i]);
    }
}

/* `junctions`: the candidates' records, in order. */
static void finish_batch(const asj_isotropic *test, const asj_frame *frame, batch *b, uint16_t *scratch,
                         asj_isotropic_junction *junctions)
{
    fill_batch(b);
    for (int32_t r = test->radius_count - 1; r >= 0; r--) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const asj_sector_runs *runs = &test->radii[entry->source].runs;
        uint16_t *slots = scratch + (size_t)runs->count * SQUARE * V_LANES;
        int16_t *z = (int16_t *)slots + (size_t)entry->plan.slot_count * V_LANES;
        if (entry->source == r)
            batch_gammas(runs, frame, b, scratch);
        batch_strengths(&entry->sectors, &entry->plan, entry->suppress, scratch, slots, z);
        test_batch(test, entry, slots, z, b->count, junctions);
    }
    b->count = 0;
}

static void isotropic_band(const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom, const uint16_t *masks,
                           uint16_t *scratch, asj_isotropic_junction *junctions)
{
    batch b = {0};
    for (int32_t y = top; y < bottom; y++)
        for (int32_t run = 0; run < frame->blocks; run++)
            for (uint32_t bits = masks[(ptrdiff_t)y * frame->blocks + run]; bits; bits &= bits - 1) {
                const int32_t x = run * ASJ_LANES + __builtin_ctz(bits);
                memset(junctions, 0, sizeof *junctions);
                junctions->x = (uint16_t)x;
                junctions->y = (uint16_t)y;
                junctions++;
                add_to_batch(&b, y * frame->stride + x);
                if (b.count == V_LANES)
                    finish_batch(test, frame, &b, scratch, junctions - V_LANES);
            }
    if (b.count > 0)
        finish_batch(test, frame, &b, scratch, junctions - b.count);
}

#endif
