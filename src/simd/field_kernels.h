/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 in vectors: local junctions of a run, candidates of a tile. Part of kernels.h. */

#define V_RUN (ASJ_LANES / V_LANES) /* vectors in a run */
#define GROUP 4                     /* vectors worked on at once: as many running sums stay in registers */
#define GROUP_PIXELS (GROUP * V_LANES)

typedef char tiles_are_whole_groups[ASJ_FIELD_TILE % GROUP_PIXELS == 0 ? 1 : -1];

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
        const int32_t *factors = s->factors[i];
        const vec uy = v_set1_32(factors[0]), cross_x = v_set1_32(factors[1]);
        const vec ux = v_set1_32(factors[2]), dot_y = v_set1_32(factors[3]);
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
    const int32_t width = 65536 / s->count;
    for (int32_t k = 0; k < s->count; k++) {
        const int32_t angle = 65536 * k / s->count;
        for (int v = 0; v < V_RUN; v++) {
            const int16_t *here = z + (k + pad) * ASJ_LANES + v * V_LANES;
            for (uint32_t bits = v_bits(peak(here, ASJ_LANES, field->suppress, (int16_t)field->keep[k])); bits; bits &= bits - 1) {
                const int i = __builtin_ctz(bits);
                const int32_t shift = asj_field_shift(width, here[i - ASJ_LANES], here[i], here[i + ASJ_LANES]);
                asj_field_insert(branches[v * V_LANES + i], (asj_field_branch){(uint16_t)(angle + shift), (uint16_t)here[i]});
            }
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
        const uint64_t sectors = words[0][i] | (uint32_t)words[1][i] << 16 | (uint64_t)words[2][i] << 32 |
                                 (uint64_t)words[3][i] << 48;
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
