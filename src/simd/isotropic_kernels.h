/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3 in vectors: isotropic junctions at the candidates of a band of rows. Part of kernels.h.
 *
 * Candidates come in clusters of two or three pixels, so vectors of neighbouring pixels would be mostly empty: see
 * batch_kernels.h. */

/* One radius: the branches of each candidate that may matter, then the shared decision. */
static void test_batch(const asj_isotropic *test, const asj_isotropic_radius *entry, const uint16_t *slots, const int16_t *z,
                       int32_t count, asj_isotropic_junction *junctions)
{
    const uint32_t lanes = (uint32_t)(((uint64_t)1 << count) - 1);
    asj_isotropic_peak peaks[V_LANES][ASJ_MAX_BRANCHES];
    int32_t counts[V_LANES] = {0};
    z += entry->suppress * V_LANES;
    for (int32_t k = 0; k < entry->sectors.count; k++, z += V_LANES) {
        const vec below = v_set1((int16_t)(entry->least[k] - 1));
        if (!v_any(v_greater(v_load(z), below)))
            continue;
        for (uint32_t bits = v_bits(peak(z, V_LANES, entry->suppress, below)) & lanes; bits; bits &= bits - 1) {
            const int i = __builtin_ctz(bits);
            const int sum = slots[entry->plan.high[k] * V_LANES + i] - slots[entry->plan.low[k] * V_LANES + i];
            const asj_isotropic_peak found = {k, (uint16_t)sum, (uint16_t)z[i]};
            counts[i] = asj_isotropic_insert(peaks[i], counts[i], test->max_branches, found);
        }
    }
    for (int32_t i = 0; i < count; i++)
        if (counts[i] > 1)
            asj_isotropic_judge(test, entry, peaks[i], counts[i], &junctions[i]);
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
        batch_strengths(&entry->sectors, &entry->plan, entry->place, entry->suppress, scratch, slots, z);
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
