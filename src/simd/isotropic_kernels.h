/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3 in vectors: isotropic junctions at the candidates of a band of rows. Part of kernels.h.
 *
 * Candidates come in clusters of two or three pixels, so vectors of neighbouring pixels would be mostly empty. Instead gammas are
 * computed for 8 neighbouring offsets of one candidate at once, which are contiguous in the image, for V_LANES candidates from
 * anywhere in the band; squares of 8 x 8 are then turned round, and from there on a vector holds V_LANES candidates. */

#define SQUARE ASJ_ISOTROPIC_RUN
#define SQUARES (V_LANES / SQUARE) /* side by side in a vector */

typedef struct batch {
    int32_t count;
    ptrdiff_t at[SQUARE][SQUARES]; /* of candidate 8 j + i, in the planes, at [i][j] */
    asj_isotropic_junction *junctions; /* the candidates' records, in order */
} batch;

/* Columns become rows, in each 128 bits. */
static inline void turn_square(vec v[SQUARE])
{
    vec t[SQUARE];
    for (int i = 0; i < 4; i++) {
        t[2 * i] = v_interleave_low(v[2 * i], v[2 * i + 1]);
        t[2 * i + 1] = v_interleave_high(v[2 * i], v[2 * i + 1]);
    }
    for (int i = 0; i < 8; i += 4)
        for (int j = 0; j < 2; j++) {
            v[i + 2 * j] = v_interleave32_low(t[i + j], t[i + j + 2]);
            v[i + 2 * j + 1] = v_interleave32_high(t[i + j], t[i + j + 2]);
        }
    for (int i = 0; i < 4; i++) {
        t[2 * i] = v_interleave64_low(v[i], v[i + 4]);
        t[2 * i + 1] = v_interleave64_high(v[i], v[i + 4]);
    }
    for (int i = 0; i < SQUARE; i++)
        v[i] = t[i];
}

/* gamma at each offset of all runs. */
static void batch_gammas(const asj_isotropic_runs *runs, const asj_frame *frame, const batch *b, uint16_t *gamma)
{
    for (int32_t r = 0; r < runs->count; r++, gamma += SQUARE * V_LANES) {
        const ptrdiff_t to = runs->dy[r] * frame->stride + runs->dx[r];
        const int16_t *gx = frame->gradient_x + to, *gy = frame->gradient_y + to;
        int16_t(*const factors)[SQUARE] = runs->factors + 4 * r;
        const vec ux = v_load_repeated(factors[0]), uy = v_load_repeated(factors[1]);
        const vec cross_x = v_load_repeated(factors[2]), dot_y = v_load_repeated(factors[3]);
        vec v[SQUARE];
        for (int i = 0; i < SQUARE; i++) {
            const vec x = v_load_places(gx, b->at[i]), y = v_load_places(gy, b->at[i]);
            const vec cross = v_abs(v_sub(v_high(x, uy), v_high(y, cross_x)));
            const vec dot = v_abs(v_sub(v_high(x, ux), v_high(y, dot_y)));
            v[i] = v_sub_saturated(cross, dot);
        }
        turn_square(v);
        for (int i = 0; i < SQUARE; i++)
            v_store(gamma + i * V_LANES, v[i]);
    }
}

/* Slots of asj_sector_plan, then strengths. */
static void batch_strengths(const asj_isotropic_radius *entry, const uint16_t *gamma, uint16_t *slots, int16_t *z)
{
    const asj_sectors *s = &entry->sectors;
    const asj_sector_plan *plan = &entry->plan;
    vec total = v_zero();
    uint16_t *slot = slots;
    for (int32_t j = 0, i = 0; j < plan->plain_count; j++, slot += V_LANES) {
        vec sum = v_zero();
        for (const int32_t end = plan->boundary[j]; i < end; i++)
            sum = v_add(sum, v_load(gamma + entry->place[i] * V_LANES));
        total = v_add(total, sum);
        v_store(slot, total);
    }
    for (int32_t e = 0; e < plan->slot_count - plan->plain_count; e++, slot += V_LANES)
        v_store(slot, v_add(total, v_load(slots + plan->extra[e] * V_LANES)));
    for (int32_t k = 0; k < s->count; k++) {
        const vec low = v_load(slots + plan->low[k] * V_LANES), high = v_load(slots + plan->high[k] * V_LANES);
        v_store(z + (k + entry->suppress) * V_LANES, v_strength(v_sub(high, low), s->mean[k], s->scale[k]));
    }
    repeat_ends(z, s->count, entry->suppress, V_LANES);
}

/* One radius: the branches of each candidate that may matter, then the shared decision. */
static void test_batch(const asj_isotropic *test, const asj_isotropic_radius *entry, const batch *b, const uint16_t *slots,
                       const int16_t *z)
{
    const uint32_t lanes = (uint32_t)(((uint64_t)1 << b->count) - 1);
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
    for (int32_t i = 0; i < b->count; i++)
        if (counts[i] > 1)
            asj_isotropic_judge(test, entry, peaks[i], counts[i], &b->junctions[i]);
}

static void finish_batch(const asj_isotropic *test, const asj_frame *frame, batch *b, uint16_t *scratch)
{
    for (int32_t i = b->count; i < V_LANES; i++) /* unused ones look where another looks */
        b->at[i % SQUARE][i / SQUARE] = b->at[0][0];
    for (int32_t r = test->radius_count - 1; r >= 0; r--) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const asj_isotropic_runs *runs = &test->radii[entry->source].runs;
        uint16_t *slots = scratch + (size_t)runs->count * SQUARE * V_LANES;
        int16_t *z = (int16_t *)slots + (size_t)entry->plan.slot_count * V_LANES;
        if (entry->source == r)
            batch_gammas(runs, frame, b, scratch);
        batch_strengths(entry, scratch, slots, z);
        test_batch(test, entry, b, slots, z);
    }
    b->junctions += b->count;
    b->count = 0;
}

static void isotropic_band(const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom, const uint16_t *masks,
                           uint16_t *scratch, asj_isotropic_junction *junctions)
{
    batch b = {0};
    b.junctions = junctions;
    for (int32_t y = top; y < bottom; y++)
        for (int32_t run = 0; run < frame->blocks; run++)
            for (uint32_t bits = masks[(ptrdiff_t)y * frame->blocks + run]; bits; bits &= bits - 1) {
                const int32_t x = run * ASJ_LANES + __builtin_ctz(bits);
                asj_isotropic_junction *junction = &b.junctions[b.count];
                memset(junction, 0, sizeof *junction);
                junction->x = (uint16_t)x;
                junction->y = (uint16_t)y;
                b.at[b.count % SQUARE][b.count / SQUARE] = y * frame->stride + x;
                if (++b.count == V_LANES)
                    finish_batch(test, frame, &b, scratch);
            }
    if (b.count > 0)
        finish_batch(test, frame, &b, scratch);
}
