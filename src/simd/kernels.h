/* SPDX-License-Identifier: BSD-2-Clause */
/* The vector form of the hot operations, written once. A file for an instruction set defines vec, V_LANES (16-bit lanes), V_NAME and
 * the v_ functions (see x86/avx2.c) and includes this one. Names as in the reference: sector.c, field.c. */
#include "../field.h"
#include "variants.h"

#include <string.h>

#define V_RUN (ASJ_LANES / V_LANES) /* vectors in a run */
#define GROUP 4                     /* vectors worked on at once: as many running sums stay in registers */
#define GROUP_PIXELS (GROUP * V_LANES)

typedef char tiles_are_whole_groups[ASJ_FIELD_TILE % GROUP_PIXELS == 0 ? 1 : -1];

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

/* -1 where the sector at `here` is a peak: above `least` - 1 and its `reach` neighbours before it, not below those after it. */
static inline vec peak(const int16_t *here, ptrdiff_t row, int32_t reach, int16_t least)
{
    const vec z = v_load(here);
    vec before = v_set1((int16_t)(least - 1)), after = v_load(here + row);
    before = v_max(before, v_load(here - row));
    for (int32_t d = 2; d <= reach; d++) {
        before = v_max(before, v_load(here - d * row));
        after = v_max(after, v_load(here + d * row));
    }
    return v_not_and(v_greater(after, z), v_greater(z, before));
}

#if V_LANES <= ASJ_LANES
/* prefix[i + 1] = prefix[i] + gamma at offset i */
static void prefix_sums(const asj_sectors *s, const int16_t *gx, const int16_t *gy, ptrdiff_t stride, uint16_t *prefix)
{
    vec sum[V_RUN];
    for (int v = 0; v < V_RUN; v++) {
        sum[v] = v_zero();
        v_store(prefix + v * V_LANES, sum[v]);
    }
    for (int32_t i = 0; i < s->offset_count; i++) {
        const ptrdiff_t at = s->dy[i] * stride + s->dx[i];
        const asj_direction u = asj_sector_direction(s, i);
        const vec ux = v_set1(u.x), uy = v_set1(u.y), cross_x = v_set1(u.cross_x), dot_y = v_set1(u.dot_y);
        prefix += ASJ_LANES;
        for (int v = 0; v < V_RUN; v++) {
            const vec x = v_load(gx + at + v * V_LANES), y = v_load(gy + at + v * V_LANES);
            const vec cross = v_abs(v_sub(v_high(x, uy), v_high(y, cross_x)));
            const vec dot = v_abs(v_sub(v_high(x, ux), v_high(y, dot_y)));
            sum[v] = v_add(sum[v], v_sub_saturated(cross, dot)); /* gamma */
            v_store(prefix + v * V_LANES, sum[v]);
        }
    }
}

/* The sum of sector k, vector v of the run. */
static inline vec sector_sum(const asj_sectors *s, const uint16_t *prefix, int32_t k, int v)
{
    const int32_t end = s->first[k] + s->size[k], past = end - s->offset_count;
    prefix += v * V_LANES;
    const vec low = v_load(prefix + (size_t)s->first[k] * ASJ_LANES);
    if (past <= 0)
        return v_sub(v_load(prefix + (size_t)end * ASJ_LANES), low);
    return v_add(v_sub(v_load(prefix + (size_t)s->offset_count * ASJ_LANES), low), v_load(prefix + (size_t)past * ASJ_LANES));
}

static void field_block(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, uint16_t *scratch,
                        asj_field_branch branches[ASJ_LANES][ASJ_FIELD_BRANCHES])
{
    const asj_sectors *s = &field->sectors;
    const ptrdiff_t at = y * frame->stride + x;
    const int32_t pad = field->suppress;
    int16_t *z = (int16_t *)(scratch + asj_sector_scratch(s));
    prefix_sums(s, frame->gradient_x + at, frame->gradient_y + at, frame->stride, scratch);
    for (int32_t k = 0; k < s->count; k++)
        for (int v = 0; v < V_RUN; v++)
            v_store(z + (k + pad) * ASJ_LANES + v * V_LANES, v_strength(sector_sum(s, scratch, k, v), s->mean[k], s->scale[k]));
    repeat_ends(z, s->count, pad, ASJ_LANES);
    memset(branches, 0, ASJ_LANES * sizeof *branches);
    for (int32_t k = 0; k < s->count; k++)
        for (int v = 0; v < V_RUN; v++) {
            const int16_t *here = z + (k + pad) * ASJ_LANES + v * V_LANES;
            for (uint32_t bits = v_bits(peak(here, ASJ_LANES, field->suppress, (int16_t)field->keep[k])); bits; bits &= bits - 1) {
                const int i = __builtin_ctz(bits);
                asj_field_add(field, k, here[i - ASJ_LANES], here[i], here[i + ASJ_LANES], branches[v * V_LANES + i]);
            }
        }
}
#endif

/* The planes of asj_sector_plan for one row of pixels. */
static void gamma_planes(const asj_sector_plan *plan, const int16_t *gx, const int16_t *gy, int32_t width, size_t stride,
                         uint16_t *planes)
{
    for (int32_t f = 0; f < plan->family_count; f++, planes += 4 * stride) {
        const vec a = v_set1(plan->a[f]), b = v_set1(plan->b[f]);
        const vec minus_a = v_set1((int16_t)-plan->a[f]), minus_b = v_set1((int16_t)-plan->b[f]);
        for (int32_t i = 0; i < width; i += V_LANES) {
            const vec x = v_load(gx + i), y = v_load(gy + i);
            const vec xa = v_high(x, a), xb = v_high(x, b);
            const vec cross = v_abs(v_sub(xb, v_high(y, a))), dot = v_abs(v_sub(xa, v_high(y, minus_b)));
            const vec steep_cross = v_abs(v_sub(xa, v_high(y, b))), steep_dot = v_abs(v_sub(xb, v_high(y, minus_a)));
            v_store(planes + i, v_sub_saturated(cross, dot));
            v_store(planes + stride + i, v_sub_saturated(dot, cross));
            v_store(planes + 2 * stride + i, v_sub_saturated(steep_cross, steep_dot));
            v_store(planes + 3 * stride + i, v_sub_saturated(steep_dot, steep_cross));
        }
    }
}

/* What a tile is worked on with. */
typedef struct tile {
    const asj_field *field;
    const uint16_t *rows[2 * ASJ_FIELD_MAX_RADIUS + 1]; /* planes of the rows from the centre's - radius on, at x - radius */
    int32_t place[ASJ_FIELD_MAX_OFFSETS];               /* of each offset: its plane and column from there */
    uint16_t *slots;
    int16_t *z;
} tile;

/* The slots of asj_sector_plan for a group of pixels, `x` from the tile's left. */
static void fill_slots(const tile *t, int32_t x)
{
    const asj_sectors *s = &t->field->sectors;
    const asj_sector_plan *plan = &t->field->plan;
    const uint16_t *const *middle = t->rows + s->radius;
    uint16_t *slot = t->slots;
    vec s0 = v_zero(), s1 = s0, s2 = s0, s3 = s0;
    int32_t i = 0;
    for (int32_t j = 0; j < plan->plain_count; j++, slot += GROUP_PIXELS) {
        for (const int32_t end = plan->boundary[j]; i < end; i++) {
            const uint16_t *gamma = middle[s->dy[i]] + t->place[i] + x;
            s0 = v_add(s0, v_load(gamma));
            s1 = v_add(s1, v_load(gamma + V_LANES));
            s2 = v_add(s2, v_load(gamma + 2 * V_LANES));
            s3 = v_add(s3, v_load(gamma + 3 * V_LANES));
        }
        v_store(slot, s0);
        v_store(slot + V_LANES, s1);
        v_store(slot + 2 * V_LANES, s2);
        v_store(slot + 3 * V_LANES, s3);
    }
    for (int32_t e = 0; e < plan->slot_count - plan->plain_count; e++, slot += GROUP_PIXELS) {
        const uint16_t *from = t->slots + plan->extra[e] * GROUP_PIXELS;
        v_store(slot, v_add(s0, v_load(from)));
        v_store(slot + V_LANES, v_add(s1, v_load(from + V_LANES)));
        v_store(slot + 2 * V_LANES, v_add(s2, v_load(from + 2 * V_LANES)));
        v_store(slot + 3 * V_LANES, v_add(s3, v_load(from + 3 * V_LANES)));
    }
}

/* Strengths of a group from its slots; returns whether any reaches the least of a candidate's branch. */
static int fill_strengths(const tile *t)
{
    const asj_sectors *s = &t->field->sectors;
    const asj_sector_plan *plan = &t->field->plan;
    int16_t *z = t->z + t->field->suppress * GROUP_PIXELS;
    vec any = v_zero();
    for (int32_t k = 0; k < s->count; k++, z += GROUP_PIXELS) {
        const uint16_t *low = t->slots + plan->low[k] * GROUP_PIXELS, *high = t->slots + plan->high[k] * GROUP_PIXELS;
        const vec mean = v_set1((int16_t)s->mean[k]), scale = v_set1((int16_t)s->scale[k]);
        const vec least = v_set1((int16_t)(t->field->candidate[k] - 1));
        for (int v = 0; v < GROUP_PIXELS; v += V_LANES) {
            const vec strength = v_high_unsigned(v_sub_saturated(v_sub(v_load(high + v), v_load(low + v)), mean), scale);
            any = v_or(any, v_greater(strength, least));
            v_store(z + v, strength);
        }
    }
    return v_any(any);
}

/* Whether two of the sectors whose bits are set are neither parallel nor opposite. */
static int has_pair(uint64_t sectors, int32_t count, uint64_t partners)
{
    for (uint64_t rest = sectors; rest; rest &= rest - 1) {
        const int k = __builtin_ctzll(rest);
        if ((sectors >> k | sectors << (count - k)) & partners)
            return 1;
    }
    return 0;
}

/* Candidates among the pixels of vector v: the peaks of each pixel as bits in four words, then its pairs. */
static uint32_t find_candidates(const tile *t, int v)
{
    const asj_field *field = t->field;
    const int32_t count = field->sectors.count, first = field->apart, last = count / 2 - field->apart;
    const uint64_t partners = last < first ? 0 : (((uint64_t)1 << (last + 1)) - 1) & ~(((uint64_t)1 << first) - 1);
    const int16_t *here = t->z + field->suppress * GROUP_PIXELS + v * V_LANES;
    uint16_t words[4][V_LANES];
    vec seen = v_zero(), twice = seen;
    for (int32_t word = 0, k = 0; word < 4; word++) {
        vec bits = v_zero();
        for (int32_t bit = 0; bit < 16 && k < count; bit++, k++, here += GROUP_PIXELS) {
            const vec is_peak = peak(here, GROUP_PIXELS, field->suppress, (int16_t)field->candidate[k]);
            twice = v_or(twice, v_and(seen, is_peak));
            seen = v_or(seen, is_peak);
            bits = v_or(bits, v_and(is_peak, v_set1((int16_t)(uint16_t)(1u << bit))));
        }
        v_store(words[word], bits);
    }
    uint32_t found = 0;
    for (uint32_t lanes = v_bits(twice); lanes; lanes &= lanes - 1) {
        const int i = __builtin_ctz(lanes);
        const uint64_t sectors = words[0][i] | (uint32_t)words[1][i] << 16 | (uint64_t)words[2][i] << 32 | (uint64_t)words[3][i] << 48;
        if (has_pair(sectors, count, partners))
            found |= (uint32_t)1 << i;
    }
    return found;
}

/* Masks of the runs of a row of the tile; `runs` of them are inside it. */
static void tile_row(const tile *t, int32_t runs, uint16_t *masks)
{
    const int32_t per_group = GROUP_PIXELS / ASJ_LANES;
    for (int32_t first = 0; first < runs; first += per_group) {
        const int32_t last = runs - first < per_group ? runs : first + per_group;
        uint16_t found[GROUP_PIXELS / ASJ_LANES] = {0};
        fill_slots(t, first * ASJ_LANES);
        if (fill_strengths(t)) {
            repeat_ends(t->z, t->field->sectors.count, t->field->suppress, GROUP_PIXELS);
            for (int v = 0; v < GROUP; v++) {
                const uint32_t bits = find_candidates(t, v);
                for (int part = 0; part < V_LANES; part += ASJ_LANES) {
                    const int pixel = v * V_LANES + part;
                    found[pixel / ASJ_LANES] |= (uint16_t)((bits >> part) << pixel % ASJ_LANES);
                }
            }
        }
        memcpy(masks + first, found, (size_t)(last - first) * sizeof *masks);
    }
}

static void field_tile(const asj_field *field, const asj_frame *frame, int32_t run, int32_t runs, int32_t top, int32_t bottom,
                       uint16_t *scratch, uint16_t *masks)
{
    const asj_sectors *s = &field->sectors;
    const int32_t radius = s->radius, depth = 2 * radius + 1;
    const int32_t groups = (runs * ASJ_LANES + GROUP_PIXELS - 1) / GROUP_PIXELS, width = groups * GROUP_PIXELS + 2 * radius;
    const size_t stride = asj_field_plane_stride(field), row = stride * 4 * (size_t)field->plan.family_count;
    uint16_t *ring = scratch;
    tile t;
    t.field = field;
    t.slots = ring + (size_t)depth * row;
    t.z = (int16_t *)t.slots + (size_t)field->plan.slot_count * ASJ_FIELD_TILE;
    for (int32_t i = 0; i < s->offset_count; i++)
        t.place[i] = field->plan.plane[i] * (int32_t)stride + s->dx[i] + radius;
    for (int32_t y = top - radius; y < bottom + radius; y++) {
        const ptrdiff_t at = y * frame->stride + run * ASJ_LANES - radius;
        const int32_t centre = y - radius;
        gamma_planes(&field->plan, frame->gradient_x + at, frame->gradient_y + at, width, stride,
                     ring + (size_t)((y + depth) % depth) * row);
        if (centre < top)
            continue;
        for (int32_t i = 0; i < depth; i++)
            t.rows[i] = ring + (size_t)((centre + i - radius + depth) % depth) * row;
        tile_row(&t, runs, masks + (ptrdiff_t)centre * frame->blocks + run);
        asj_field_cut(frame, run, runs, masks + (ptrdiff_t)centre * frame->blocks + run);
    }
}

/* ---- isotropic junctions ---- */

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
static void window_gammas(const asj_sectors *s, const int16_t *const *gx, const int16_t *const *gy, ptrdiff_t stride, uint16_t *gamma)
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

void V_NAME(asj_ops)(asj_ops *ops)
{
#if V_LANES <= ASJ_LANES
    ops->field_block = field_block;
#endif
    ops->field_tile = field_tile;
    ops->isotropic_row = isotropic_row;
#ifdef V_MORE
    V_MORE(ops); /* what is not in this file */
#endif
}
