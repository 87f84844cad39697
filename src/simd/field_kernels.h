/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 in vectors: local junctions at some pixels, candidates of a tile. Part of kernels.h. */
#ifndef ASJ_SRC_SIMD_FIELD_KERNELS_H
#define ASJ_SRC_SIMD_FIELD_KERNELS_H

#include "batch_kernels.h"
#include "detect/field.h"
#include "strength_kernels.h"

#define GROUP (V_LANES > 16 ? 2 : 4) /* vectors worked on at once: as many running sums stay in registers */
#define GROUP_PIXELS (GROUP * V_LANES)
#define DEPTHS (2 * ASJ_FIELD_MAX_RADIUS + 1)
#define AHEAD 2 /* rows: how far ahead the gradient is fetched */

typedef char tiles_are_whole_groups[ASJ_FIELD_TILE % GROUP_PIXELS == 0 ? 1 : -1];

/* The strongest peaks of each pixel. */
static void rank_by_strength(const asj_field *field, const int16_t *z, ranking *ranked)
{
    const int32_t count = field->sectors.count, reach = field->suppress;
    int32_t k = 0;
    start_ranking(ranked, ASJ_FIELD_BRANCHES, v_zero());
    if (reach == 2)
        for (peak_walk walk = start_peaks(z, V_LANES); k + 3 <= count; k += 3) {
            const int32_t(*limits)[4] = field->limits + k;
            const vec below[3] = {v_set1_32(limits[0][2]), v_set1_32(limits[1][2]), v_set1_32(limits[2][2])};
            vec is_peak[3], found;
            const vec strength = next_peaks(&walk, z + k * V_LANES, V_LANES, below, is_peak);
            const vec sector = peak_of_three(k, is_peak, &found);
            insert_peaks(ranked, ASJ_FIELD_BRANCHES, v_and(found, strength), sector);
        }
    while (k < count) {
        vec strength = v_zero(), sector = v_zero();
        for (const int32_t end = count - k <= reach ? count : k + reach + 1; k < end; k++) {
            const int16_t *here = z + k * V_LANES;
            const vec is_peak = peak(here, V_LANES, reach, v_set1_32(field->limits[k][2]));
            strength = v_or(strength, v_and(is_peak, v_load(here)));
            sector = v_or(sector, v_and(is_peak, v_set1((int16_t)k)));
        }
        insert_peaks(ranked, ASJ_FIELD_BRANCHES, strength, sector);
    }
}

/* The branches at the pixels of a batch, whose strengths start at z. */
static void find_branches(const asj_field *field, const int16_t *z, int32_t count,
                          asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    const int32_t width = 65536 / field->sectors.count;
    uint16_t strengths[ASJ_FIELD_BRANCHES][V_LANES], sectors[ASJ_FIELD_BRANCHES][V_LANES];
    ranking ranked;
    rank_by_strength(field, z, &ranked);
    for (int32_t m = 0; m < ASJ_FIELD_BRANCHES; m++) {
        v_store(strengths[m], ranked.values[m]);
        v_store(sectors[m], ranked.sectors[m]);
    }
    memset(branches, 0, (size_t)count * sizeof *branches);
    for (int32_t i = 0; i < count; i++)
        for (int32_t m = 0; m < ASJ_FIELD_BRANCHES && strengths[m][i]; m++) {
            const int32_t k = sectors[m][i];
            const int16_t *here = z + k * V_LANES + i;
            const int32_t angle = field->angle[k] + asj_field_shift(width, here[-V_LANES], *here, here[V_LANES]);
            branches[i][m] = (asj_field_branch){(uint16_t)angle, strengths[m][i]};
        }
}

static void field_pixels(const asj_field *field, const asj_frame *frame, const asj_pixel *pixels, int32_t count, uint16_t *scratch,
                         asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    const asj_sectors *s = &field->sectors;
    uint16_t *slots = scratch + (size_t)field->runs.count * SQUARE * V_LANES;
    int16_t *z = (int16_t *)slots + (size_t)field->plan.slot_count * V_LANES;
    for (int32_t first = 0; first < count; first += V_LANES) {
        const int32_t last = count - first < V_LANES ? count : first + V_LANES;
        batch b = {0};
        for (int32_t i = first; i < last; i++)
            add_to_batch(&b, pixels[i].y * frame->stride + pixels[i].x);
        fill_batch(&b);
        batch_gammas(&field->runs, frame, &b, scratch);
        batch_strengths(s, &field->plan, field->suppress, scratch, slots, z);
        find_branches(field, z + field->suppress * V_LANES, b.count, branches + first);
    }
}

/* The planes of asj_sector_plan for one row of pixels; used[f] >> shift, its last four bits: those of family f that are wanted. */
static void gamma_planes(const asj_sector_plan *plan, const int16_t *used, int32_t shift, const int16_t *gx, const int16_t *gy,
                         int32_t width, size_t stride, uint16_t *planes)
{
    const int16_t *const all_a = plan->a, *const all_b = plan->b; /* once: see batch_strengths() */
    const int32_t count = plan->family_count;
    for (int32_t f = 0; f < count; f++, planes += 4 * stride) {
        const int wanted = used[f] >> shift & 15;
        if (!wanted)
            continue;
        const vec a = v_set1(all_a[f]), b = v_set1(all_b[f]), minus_a = v_sub(v_zero(), a), minus_b = v_sub(v_zero(), b);
        for (int32_t i = 0; i < width; i += V_LANES) {
            const vec x = v_load(gx + i), y = v_load(gy + i);
            const vec xa = v_high(x, a), xb = v_high(x, b);
            const vec cross = v_abs(v_sub(xb, v_high(y, a))), dot = v_abs(v_sub(xa, v_high(y, minus_b)));
            const vec steep_cross = v_abs(v_sub(xa, v_high(y, b))), steep_dot = v_abs(v_sub(xb, v_high(y, minus_a)));
            if (wanted & 1)
                v_store(planes + i, v_sub_saturated(cross, dot));
            if (wanted & 2)
                v_store(planes + stride + i, v_sub_saturated(dot, cross));
            if (wanted & 4)
                v_store(planes + 2 * stride + i, v_sub_saturated(steep_cross, steep_dot));
            if (wanted & 8)
                v_store(planes + 3 * stride + i, v_sub_saturated(steep_dot, steep_cross));
        }
    }
}

/* What a tile is worked on with. A row's planes hold its even columns, then the odd ones, where candidates are two apart, so that
 * what neighbouring candidates need is always next to each other. */
typedef struct tile {
    const asj_field *field;
    int32_t margin;                                     /* columns to the left of the tile */
    size_t stride;                                      /* from plane to plane */
    int16_t used[2][ASJ_FIELD_MAX_OFFSETS];             /* of each family, in even and odd rows: see gamma_planes() */
    uint16_t *ring;
    int16_t *row;                                       /* of the gradient, taken apart */
    uint32_t places[DEPTHS][ASJ_FIELD_MAX_OFFSETS];     /* of each offset in the ring, by the place of the centre's row in it */
    uint16_t *slots;
    int16_t *z;
} tile;

/* The slots of asj_sector_plan for a group of pixels, the first one number x of the tile's row; places: of all offsets. */
static void fill_slots(const tile *t, const uint32_t *places, int32_t x)
{
    const asj_sector_plan *plan = &t->field->plan;
    const int16_t *const boundary = plan->boundary, *const extra = plan->extra; /* once: see batch_strengths() */
    const int32_t plain_count = plan->plain_count, extra_count = plan->slot_count - plain_count;
    const uint16_t *const ring = t->ring + x;
    uint16_t *slot = t->slots;
    vec sum[GROUP];
    for (int v = 0; v < GROUP; v++)
        sum[v] = v_zero();
    const uint32_t *place = places;
    for (int32_t j = 0; j < plain_count; j++, slot += GROUP_PIXELS) {
        for (const uint32_t *const end = places + boundary[j]; place < end; place++) {
            const uint16_t *gamma = ring + *place;
            for (int v = 0; v < GROUP; v++)
                sum[v] = v_add(sum[v], v_load(gamma + v * V_LANES));
        }
        for (int v = 0; v < GROUP; v++)
            v_store(slot + v * V_LANES, sum[v]);
    }
    for (int32_t e = 0; e < extra_count; e++, slot += GROUP_PIXELS) {
        const uint16_t *from = t->slots + (ptrdiff_t)extra[e] * GROUP_PIXELS;
        for (int v = 0; v < GROUP; v++)
            v_store(slot + v * V_LANES, v_add(sum[v], v_load(from + v * V_LANES)));
    }
}

/* Sectors of each pixel as bits: word i of a lane holds WORD of them from sector i WORD on, the first one highest. Such a word is
 * positive. */
#define WORD 15
#define WORDS ((ASJ_FIELD_MAX_SECTORS + WORD - 1) / WORD)
typedef vec sector_words[WORDS];

/* Sectors up to the end of the word that begins with sector k. */
static inline int32_t word_end(int32_t k, int32_t count)
{
    return k + WORD < count ? k + WORD : count;
}

/* One more bit, where `sector` is -1. */
static inline vec put_in(vec bits, vec sector)
{
    return v_sub(v_add(bits, bits), sector);
}

/* Strengths of a group from its slots; strong[v]: which reach the least of a candidate's branch, of vector v. */
static void fill_strengths(const tile *t, sector_words strong[GROUP])
{
    const asj_sectors *s = &t->field->sectors;
    const asj_sector_plan *plan = &t->field->plan;
    const int16_t *const first = plan->low, *const last = plan->high; /* once: see batch_strengths() */
    const uint16_t *const slots = t->slots;
    const int32_t count = s->count, *limits = t->field->limits[0];
    int16_t *z = t->z + t->field->suppress * GROUP_PIXELS;
    for (int32_t word = 0, k = 0; k < count; word++) {
        vec bits[GROUP];
        for (int v = 0; v < GROUP; v++)
            bits[v] = v_zero();
        for (const int32_t end = word_end(k, count); k < end; k++, z += GROUP_PIXELS, limits += 4) {
            const uint16_t *low = slots + (ptrdiff_t)first[k] * GROUP_PIXELS, *high = slots + (ptrdiff_t)last[k] * GROUP_PIXELS;
            const vec mean = v_set1_32(limits[0]), scale = v_set1_32(limits[1]), least = v_set1_32(limits[3]);
            for (int v = 0; v < GROUP; v++) {
                const vec sum = v_sub(v_load(high + v * V_LANES), v_load(low + v * V_LANES));
                const vec strength = v_high_unsigned(v_sub_saturated(sum, mean), scale);
                bits[v] = put_in(bits[v], v_greater(strength, least));
                v_store(z + v * V_LANES, strength);
            }
        }
        for (int v = 0; v < GROUP; v++)
            strong[v][word] = bits[v];
    }
}

/* Bit k of the result is bit k + by of `count` sectors. */
static inline uint64_t turn(uint64_t sectors, int32_t count, int32_t by)
{
    return (sectors >> by | sectors << (count - by)) & (((uint64_t)1 << count) - 1);
}

/* Whether two of the sectors whose bits are set are at least `apart` from 0 and from pi. All that may be the first one's partner
 * are united by doubling, which takes the same steps at every pixel. */
static inline int has_pair(uint64_t sectors, int32_t count, int32_t apart)
{
    const int32_t wanted = count / 2 - 2 * apart + 1;
    uint64_t from = sectors;
    for (int32_t width = 1, more; width < wanted; width += more) {
        more = width < wanted - width ? width : wanted - width;
        from |= turn(from, count, more);
    }
    return (sectors & turn(from, count, apart)) != 0;
}

/* The sectors of a word that are peaks, from sector k on. */
static inline vec find_peaks(const tile *t, const int16_t *here, int32_t k, int32_t end, peak_walk *walk)
{
    const int32_t reach = t->field->suppress;
    vec bits = v_zero();
    for (vec is_peak[3]; reach == 2 && k + 3 <= end; k += 3, here += 3 * GROUP_PIXELS) {
        next_peaks(walk, here, GROUP_PIXELS, NULL, is_peak);
        bits = put_in(put_in(put_in(bits, is_peak[0]), is_peak[1]), is_peak[2]);
    }
    for (; k < end; k++, here += GROUP_PIXELS)
        bits = put_in(bits, peak(here, GROUP_PIXELS, reach, v_zero()));
    return bits;
}

/* Candidates among the pixels of vector v, some of whose sectors are strong: the peaks among these as bits, then their pairs. */
static uint32_t find_candidates(const tile *t, int v, const sector_words strong)
{
    const asj_field *field = t->field;
    const int32_t count = field->sectors.count;
    const int16_t *here = t->z + field->suppress * GROUP_PIXELS + v * V_LANES;
    const vec zero = v_zero(), minus_one = v_set1(-1);
    uint16_t words[WORDS][V_LANES];
    peak_walk walk = {{zero, zero, zero}, {zero, zero}};
    vec seen = zero, twice = zero;
    if (field->suppress == 2)
        walk = start_peaks(here, GROUP_PIXELS);
    for (int32_t word = 0, k = 0; k < count; word++, k += WORD) {
        const vec peaks = find_peaks(t, here + (ptrdiff_t)k * GROUP_PIXELS, k, word_end(k, count), &walk);
        const vec bits = v_and(peaks, strong[word]), any = v_greater(bits, zero);
        const vec more = v_and(bits, v_add(bits, minus_one)); /* without the lowest bit */
        twice = v_or(twice, v_or(v_and(seen, any), v_greater(more, zero)));
        seen = v_or(seen, any);
        v_store(words[word], bits);
    }
    uint32_t found = 0;
    for (uint32_t lanes = v_bits(twice); lanes; lanes &= lanes - 1) {
        const int i = __builtin_ctz(lanes);
        uint64_t sectors = 0; /* from the last one to the first one: pairs are the same */
        for (int32_t word = 0, k = 0; k < count; word++, k += WORD)
            sectors = sectors << (word_end(k, count) - k) | words[word][i];
        found |= (uint32_t)has_pair(sectors, count, field->apart) << i;
    }
    return found;
}

/* Whether the strong sectors of any pixel may hold two that are `apart`. */
static inline int may_have_pair(const sector_words words, int32_t count, int32_t apart)
{
    const vec zero = v_zero();
    vec seen = zero, found = zero;
    for (int32_t word = 0; word * WORD < count; word++) {
        const vec bits = words[word], any = v_greater(bits, zero);
        vec near = v_and(bits, v_sub(zero, bits)); /* the last bit, and those that are too near it */
        for (int32_t i = 1; i < apart; i++)
            near = v_or(near, v_add(near, near));
        found = v_or(found, v_or(v_and(seen, any), v_greater(bits, v_and(near, v_set1(INT16_MAX)))));
        seen = v_or(seen, any);
    }
    return v_any(found);
}

/* Eight bits in even places. */
static inline uint32_t spread(uint32_t bits)
{
    bits = (bits | bits << 4) & 0x0f0f;
    bits = (bits | bits << 2) & 0x3333;
    return (bits | bits << 1) & 0x5555;
}

/* Masks of the runs of a row of the tile; `runs` of them are inside it. places: see fill_slots(). */
static void tile_row(const tile *t, const uint32_t *places, int32_t runs, uint16_t *masks)
{
    const int32_t step = t->field->step, per_run = ASJ_LANES / step, per_group = GROUP_PIXELS / per_run;
    for (int32_t first = 0; first < runs; first += per_group) {
        const int32_t last = runs - first < per_group ? runs : first + per_group;
        uint16_t found[GROUP_PIXELS / 8] = {0};
        sector_words strong[GROUP];
        fill_slots(t, places, first * per_run);
        fill_strengths(t, strong);
        repeat_ends(t->z, t->field->sectors.count, t->field->suppress, GROUP_PIXELS);
        for (int v = 0; v < GROUP; v++) {
            const int worth = may_have_pair(strong[v], t->field->sectors.count, t->field->apart);
            const uint32_t bits = worth ? find_candidates(t, v, strong[v]) : 0;
            for (int part = 0; part < V_LANES; part += 8) {
                const int pixel = v * V_LANES + part;
                const uint32_t eight = bits >> part & 255;
                found[pixel / per_run] |= (uint16_t)(step > 1 ? spread(eight) : eight << pixel % per_run);
            }
        }
        memcpy(masks + first, found, (size_t)(last - first) * sizeof *masks);
    }
}

/* Rows of a tile are too short for the processor to see what it reads next. */
static void fetch_row(const int16_t *row, int32_t width)
{
    for (int32_t i = 0; i < width; i += 32)
        __builtin_prefetch(row + i);
}

/* Takes a row apart: the even ones of 2 `count` numbers, and the odd ones. */
static void split_row(const int16_t *row, int32_t count, int16_t *even, int16_t *odd)
{
    for (int32_t i = 0; i < count; i += V_LANES) {
        const vec a = v_load(row + 2 * i), b = v_load(row + 2 * i + V_LANES);
        v_store(even + i, v_in_order(v_even(a, b)));
        v_store(odd + i, v_in_order(v_odd(a, b)));
    }
}

/* Planes of row y into their place in the ring; gx, gy: at the first column of the left margin; `width`: columns of each kind. */
static void fill_planes(const tile *t, int32_t y, const int16_t *gx, const int16_t *gy, int32_t width)
{
    const asj_sector_plan *plan = &t->field->plan;
    const int32_t step = t->field->step, depth = 2 * t->field->sectors.radius + 1;
    const size_t half = t->stride / (size_t)step, row = t->stride * 4 * (size_t)plan->family_count;
    uint16_t *planes = t->ring + (size_t)((y + depth) % depth) * row;
    int16_t *x_row = t->row, *y_row = x_row + t->stride;
    if (step > 1) {
        split_row(gx, width, x_row, x_row + half);
        split_row(gy, width, y_row, y_row + half);
    }
    for (int32_t column = 0; column < step; column++) {
        const size_t at = (size_t)column * half;
        gamma_planes(plan, t->used[y & 1], 4 * column, step > 1 ? x_row + at : gx, step > 1 ? y_row + at : gy, width, t->stride,
                     planes + at);
    }
}

static void open_tile(const asj_field *field, uint16_t *scratch, tile *t)
{
    const asj_sectors *s = &field->sectors;
    const int32_t step = field->step, depth = 2 * s->radius + 1;
    const size_t half = asj_field_plane_stride(field);
    t->field = field;
    t->margin = (s->radius + step - 1) / step * step;
    t->stride = half * (size_t)step;
    t->ring = scratch;
    t->row = (int16_t *)scratch + (size_t)depth * t->stride * 4 * (size_t)field->plan.family_count;
    t->slots = (uint16_t *)t->row + 2 * t->stride;
    t->z = (int16_t *)t->slots + (size_t)field->plan.slot_count * ASJ_FIELD_TILE;
    for (int32_t f = 0; f < field->plan.family_count; f++) {
        const int32_t even = field->plan.used[0][f], odd = field->plan.used[1][f], both = even | odd, all = (both | both >> 4) & 15;
        t->used[0][f] = (int16_t)(step > 1 ? even : all);
        t->used[1][f] = (int16_t)(step > 1 ? odd : all);
    }
    const int32_t row = 4 * field->plan.family_count * (int32_t)t->stride;
    for (int32_t i = 0; i < s->offset_count; i++) {
        const int32_t column = s->dx[i] + t->margin;
        const int32_t place = field->plan.plane[i] * (int32_t)t->stride + column % step * (int32_t)half + column / step;
        for (int32_t centre = 0, y = (s->dy[i] + depth) % depth; centre < depth; centre++, y = y + 1 < depth ? y + 1 : 0)
            t->places[centre][i] = (uint32_t)(place + y * row);
    }
}

static void field_tile(const asj_field *field, const asj_frame *frame, const asj_tile *part, uint16_t *scratch, uint16_t *masks)
{
    const int32_t run = part->run, runs = part->runs, top = part->top, bottom = part->bottom;
    const int32_t radius = field->sectors.radius, depth = 2 * radius + 1, per_run = ASJ_LANES / field->step;
    const int32_t groups = (runs * per_run + GROUP_PIXELS - 1) / GROUP_PIXELS;
    tile t;
    open_tile(field, scratch, &t);
    const int32_t width = groups * GROUP_PIXELS + 2 * t.margin / field->step;
    for (int32_t y = top - radius; y < bottom + radius; y++) {
        const ptrdiff_t at = y * frame->stride + run * ASJ_LANES - t.margin;
        if (y + AHEAD < bottom + radius) {
            fetch_row(frame->gradient_x + at + AHEAD * frame->stride, width * field->step);
            fetch_row(frame->gradient_y + at + AHEAD * frame->stride, width * field->step);
        }
        const int32_t centre = y - radius;
        uint16_t *found = masks + (ptrdiff_t)centre * frame->blocks + run;
        fill_planes(&t, y, frame->gradient_x + at, frame->gradient_y + at, width);
        if (centre < top)
            continue;
        if (!asj_field_has_candidates(field, centre)) {
            memset(found, 0, (size_t)runs * sizeof *found);
            continue;
        }
        tile_row(&t, t.places[centre % depth], runs, found);
        asj_field_thin(field, frame, run, runs, found);
    }
}

#endif
