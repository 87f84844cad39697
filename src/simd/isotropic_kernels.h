/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3 in vectors: isotropic junctions at the candidates of a row. Part of kernels.h. */

/* Candidates come in clusters of a few pixels, so the unit is a window of 8 pixels that starts at a candidate, and a vector holds
 * V_LANES / WINDOW of them from anywhere in a row. */
#define WINDOW 8
#define WINDOWS (V_LANES / WINDOW)

typedef struct windows {
    int32_t count;
    int32_t x[WINDOWS];
    uint32_t candidates[WINDOWS]; /* bit i: pixel x + i */
} windows;

/* gamma at each offset; gx, gy: where the windows start. */
static void window_gammas(const asj_sectors *s, const int16_t *const *gx, const int16_t *const *gy, ptrdiff_t stride,
                          uint16_t *gamma)
{
    for (int32_t i = 0; i < s->offset_count; i++) {
        const ptrdiff_t at = s->dy[i] * stride + s->dx[i];
        const asj_direction u = asj_sector_direction(s, i);
        const vec x = v_load_windows(gx, at), y = v_load_windows(gy, at);
        const vec cross = v_abs(v_sub(v_high(x, v_set1(u.y)), v_high(y, v_set1(u.cross_x))));
        const vec dot = v_abs(v_sub(v_high(x, v_set1(u.x)), v_high(y, v_set1(u.dot_y))));
        v_store(gamma + i * V_LANES, v_sub_saturated(cross, dot));
    }
}

/* Slots of asj_sector_plan, then strengths. */
static void window_strengths(const asj_isotropic_radius *entry, const uint16_t *gamma, uint16_t *slots, int16_t *z)
{
    const asj_sectors *s = &entry->sectors;
    const asj_sector_plan *plan = &entry->plan;
    vec sum = v_zero();
    uint16_t *slot = slots;
    for (int32_t j = 0, i = 0; j < plan->plain_count; j++, slot += V_LANES) {
        for (const int32_t end = plan->boundary[j]; i < end; i++)
            sum = v_add(sum, v_load(gamma + entry->from[i] * V_LANES));
        v_store(slot, sum);
    }
    for (int32_t e = 0; e < plan->slot_count - plan->plain_count; e++, slot += V_LANES)
        v_store(slot, v_add(sum, v_load(slots + plan->extra[e] * V_LANES)));
    for (int32_t k = 0; k < s->count; k++) {
        const vec low = v_load(slots + plan->low[k] * V_LANES), high = v_load(slots + plan->high[k] * V_LANES);
        v_store(z + (k + entry->suppress) * V_LANES, v_strength(v_sub(high, low), s->mean[k], s->scale[k]));
    }
    repeat_ends(z, s->count, entry->suppress, V_LANES);
}

/* One radius: the branches of each candidate lane, then the shared decision. junctions[i]: of lane i. */
static void test_windows(const asj_isotropic *test, const asj_isotropic_radius *entry, uint32_t lanes, const uint16_t *slots,
                         const int16_t *z, asj_isotropic_junction *const *junctions)
{
    asj_isotropic_peak peaks[V_LANES][ASJ_MAX_BRANCHES];
    int32_t counts[V_LANES] = {0};
    for (int32_t k = 0; k < entry->sectors.count; k++) {
        const int16_t *here = z + (k + entry->suppress) * V_LANES;
        for (uint32_t bits = v_bits(peak(here, V_LANES, entry->suppress, ASJ_STRENGTH_ONE + 1)) & lanes; bits; bits &= bits - 1) {
            const int i = __builtin_ctz(bits);
            const int sum = slots[entry->plan.high[k] * V_LANES + i] - slots[entry->plan.low[k] * V_LANES + i];
            const asj_isotropic_peak found = {k, (uint16_t)sum, (uint16_t)here[i]};
            counts[i] = asj_isotropic_insert(peaks[i], counts[i], test->max_branches, found);
        }
    }
    for (; lanes; lanes &= lanes - 1) {
        const int i = __builtin_ctz(lanes);
        asj_isotropic_judge(test, entry, peaks[i], counts[i], junctions[i]);
    }
}

/* Writes the records of the windows' candidates; returns where the next ones go. */
static asj_isotropic_junction *finish_windows(const asj_isotropic *test, const asj_frame *frame, int32_t y, const windows *w,
                                              uint16_t *scratch, asj_isotropic_junction *next)
{
    const int16_t *gx[WINDOWS], *gy[WINDOWS];
    asj_isotropic_junction *junctions[V_LANES];
    uint32_t lanes = 0;
    for (int32_t i = 0; i < WINDOWS; i++) {
        const int32_t from = i < w->count ? i : 0; /* unused ones look where another looks */
        const ptrdiff_t at = y * frame->stride + w->x[from];
        gx[i] = frame->gradient_x + at;
        gy[i] = frame->gradient_y + at;
        for (uint32_t bits = i < w->count ? w->candidates[i] : 0; bits; bits &= bits - 1) {
            const int lane = i * WINDOW + __builtin_ctz(bits);
            lanes |= (uint32_t)1 << lane;
            memset(next, 0, sizeof *next);
            next->x = (uint16_t)(w->x[i] + lane % WINDOW);
            next->y = (uint16_t)y;
            junctions[lane] = next++;
        }
    }
    for (int32_t r = 0; r < test->radius_count; r++) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const asj_sectors *source = &test->radii[entry->source].sectors;
        uint16_t *slots = scratch + (size_t)source->offset_count * V_LANES;
        int16_t *z = (int16_t *)slots + (size_t)entry->plan.slot_count * V_LANES;
        if (r == 0 || entry->source != test->radii[r - 1].source)
            window_gammas(source, gx, gy, frame->stride, scratch);
        window_strengths(entry, scratch, slots, z);
        test_windows(test, entry, lanes, slots, z, junctions);
    }
    return next;
}

static void isotropic_row(const asj_isotropic *test, const asj_frame *frame, int32_t y, const uint16_t *masks, uint16_t *scratch,
                          asj_isotropic_junction *junctions)
{
    windows w = {0};
    for (int32_t b = 0; b < frame->blocks; b++)
        for (uint32_t bits = masks[b]; bits; bits &= bits - 1) {
            const int32_t x = b * ASJ_LANES + __builtin_ctz(bits);
            if (w.count == 0 || x >= w.x[w.count - 1] + WINDOW) {
                if (w.count == WINDOWS) {
                    junctions = finish_windows(test, frame, y, &w, scratch, junctions);
                    w.count = 0;
                }
                w.x[w.count] = x;
                w.candidates[w.count++] = 0;
            }
            w.candidates[w.count - 1] |= (uint32_t)1 << (x - w.x[w.count - 1]);
        }
    if (w.count > 0)
        finish_windows(test, frame, y, &w, scratch, junctions);
}
