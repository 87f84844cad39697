/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 on a device: candidates for junctions, as in field.c. Two forms with the same results: field_pixels, a work item for
 * each pixel of the rows that have candidates, for devices with thousands of them; field_tiles, a work item for a tile of the
 * image, for processors: there the planes of sector_plan.h, which neighbours share, save most of the work. Both look only at
 * pixels that may be candidates, every step-th of every step-th row. Planes of the frame and the table: contract.h. */

typedef struct field_table {
    __global const int *families, *offsets, *boundaries, *extras, *sectors;
} field_table;

static field_table open_table(const field_sizes *s, __global const int *table)
{
    field_table t;
    t.families = table;
    t.offsets = t.families + 2 * s->families;
    t.boundaries = t.offsets + FIELD_OFFSET_INTS * s->offsets;
    t.extras = t.boundaries + s->plain_slots;
    t.sectors = t.extras + (s->slots - s->plain_slots);
    return t;
}

/* Distances between two sectors that are neither parallel nor opposite, as bits. */
static ulong make_partners(const field_sizes *s)
{
    const int first = s->apart, last = s->sectors / 2 - s->apart;
    return last < first ? 0 : (((ulong)1 << (last + 1)) - 1) & ~(((ulong)1 << first) - 1);
}

/* Whether two of the sectors whose bits are set have such a distance. */
static int has_pair(ulong sectors, int count, ulong partners)
{
    ulong found = 0;
    for (ulong rest = sectors; rest; rest &= rest - 1) {
        const int k = 63 - (int)clz(rest & (0 - rest));
        found |= (sectors >> k | sectors << (count - k)) & partners;
    }
    return found != 0;
}

/* Of LANES pixels those that are inside the image. */
static uint inside_only(uint mask, int inside)
{
    return mask & (inside < LANES ? (1u << max(inside, 0)) - 1 : 0xffffu);
}

/* ---- field_pixels: a work-group takes get_local_size() pixels that may be candidates, along the row a multiple of LANES ---- */

static int strength(__local const ushort *slot, int step, __global const int *sector)
{
    const int sum = (ushort)(slot[sector[SECTOR_HIGH] * step] - slot[sector[SECTOR_LOW] * step]);
    return (uint)max(sum - sector[SECTOR_MEAN], 0) * (uint)sector[SECTOR_SCALE] >> 16;
}

/* The peaks of a pixel, one bit for each sector. */
static ulong find_peaks(const field_sizes *s, __global const int *sectors, __local const ushort *slot, int step)
{
    ulong peaks = 0;
    for (int k = 0; k < s->sectors; k++) {
        const int here = strength(slot, step, sectors + FIELD_SECTOR_INTS * k);
        int largest = here >= sectors[FIELD_SECTOR_INTS * k + SECTOR_LEAST];
        for (int d = 1; largest && d <= s->suppress; d++) {
            const int before = k >= d ? k - d : k - d + s->sectors, after = k + d < s->sectors ? k + d : k + d - s->sectors;
            largest = here > strength(slot, step, sectors + FIELD_SECTOR_INTS * before) &&
                      here >= strength(slot, step, sectors + FIELD_SECTOR_INTS * after);
        }
        peaks |= (ulong)largest << k;
    }
    return peaks;
}

/* The slots of a pixel, `step` apart; (gx, gy) of the pixel at `here`, rows `pitch` apart. */
static void fill_slots(const field_sizes *s, const field_table *t, __local const short2 *here, int pitch, __local ushort *slot,
                       int step)
{
    ushort sum = 0;
    int i = 0;
    for (int j = 0; j < s->plain_slots; j++) {
        for (const int end = t->boundaries[j]; i < end; i++) {
            __global const int *o = t->offsets + FIELD_OFFSET_INTS * i;
            const short2 g = here[o[OFFSET_DY] * pitch + o[OFFSET_DX]];
            const int cross = (g.x * o[OFFSET_Y] >> 16) - (g.y * o[OFFSET_CROSS_X] >> 16);
            const int dot = (g.x * o[OFFSET_X] >> 16) - (g.y * o[OFFSET_DOT_Y] >> 16);
            sum += (ushort)max((int)abs(cross) - (int)abs(dot), 0);
        }
        slot[j * step] = sum;
    }
    for (int j = s->plain_slots; j < s->slots; j++)
        slot[j * step] = sum + slot[t->extras[j - s->plain_slots] * step];
}

__kernel void field_pixels(__global const short *gradient_x, __global const short *gradient_y, int width, int stride, int base,
                           int top, int bottom, int blocks, __global const int *table, field_sizes sizes, __global ushort *masks,
                           __local short2 *gradient, __local ushort *slots, __local uchar *found)
{
    const field_table t = open_table(&sizes, table);
    const int columns = (int)get_local_size(0), rows = (int)get_local_size(1), items = columns * rows, step = sizes.step;
    const int item = (int)(get_local_id(1) * get_local_size(0) + get_local_id(0)), per_mask = LANES / step;
    const int pitch = (columns - 1) * step + 1 + 2 * sizes.radius, area = pitch * ((rows - 1) * step + 1 + 2 * sizes.radius);
    const int aligned = (top + step - 1) / step * step;
    const int left = (int)get_group_id(0) * columns * step, first = aligned + (int)get_group_id(1) * rows * step;
    for (int i = item; i < area; i += items) {
        const int x = left - sizes.radius + i % pitch, y = first - sizes.radius + i / pitch;
        const int inside = x < width + sizes.radius && y < bottom + sizes.radius;
        const size_t at = (size_t)(y - base) * (size_t)stride + (size_t)(x + MARGIN);
        gradient[i] = inside ? (short2)(gradient_x[at], gradient_y[at]) : (short2)(0, 0);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const int column = (int)get_local_id(0), across = column * step, down = (int)get_local_id(1) * step;
    fill_slots(&sizes, &t, gradient + (down + sizes.radius) * pitch + across + sizes.radius, pitch, slots + item, items);
    found[item] = (uchar)has_pair(find_peaks(&sizes, t.sectors, slots + item, items), sizes.sectors, make_partners(&sizes));
    barrier(CLK_LOCAL_MEM_FENCE);
    const int x = left + across, y = first + down;
    if (column % per_mask == 0 && x < width) {
        uint mask = 0;
        for (int i = 0; i < per_mask; i++)
            mask |= (uint)found[item + i] << i * step;
        __global ushort *to = masks + x / LANES;
        for (int row = y == aligned ? top : y; row < min(y + step, bottom); row++)
            to[(size_t)(row - top) * (size_t)blocks] = (ushort)(row == y ? inside_only(mask, width - x) : 0);
    }
}

/* ---- field_tiles: a work item takes FIELD_TILE x tile_rows pixels, FIELD_GROUP vectors of candidates at once; it is the whole
 * work-group. Where candidates are two apart, planes hold a row's even columns, then the odd ones, `odd` vectors farther on: what
 * neighbouring candidates need is always next to each other ---- */

/* 16 numbers from anywhere. */
struct __attribute__((packed)) anywhere {
    ushort16 numbers;
};

static ushort16 load(__local const ushort *from)
{
    return ((__local const struct anywhere *)from)->numbers;
}

/* The planes of src/detect/sector_plan.h for a vector of pixels. */
static void gamma_vectors(short16 x, short16 y, __global const int *family, int families, int plane_stride,
                          __local ushort16 *planes)
{
    for (int f = 0; f < families; f++, family += 2, planes += 4 * plane_stride) {
        const short16 a = (short)family[0], b = (short)family[1];
        const short16 xa = high_product(x, a), xb = high_product(x, b);
        const ushort16 cross = magnitude(xb - high_product(y, a)), dot = magnitude(xa - high_product(y, -b));
        const ushort16 steep_cross = magnitude(xa - high_product(y, b)), steep_dot = magnitude(xb - high_product(y, -a));
        planes[0] = excess(cross, dot);
        planes[plane_stride] = excess(dot, cross);
        planes[2 * plane_stride] = excess(steep_cross, steep_dot);
        planes[3 * plane_stride] = excess(steep_dot, steep_cross);
    }
}

/* Those of one row: `width` vectors in a row, or half as many of each kind, odd columns `odd` vectors after even ones. */
static void gamma_planes(__global const int *family, int families, __global const short *gx, __global const short *gy, int width,
                         int odd, int plane_stride, __local ushort16 *planes)
{
    for (int i = 0; odd == 0 && i < width; i++)
        gamma_vectors(vload16(i, gx), vload16(i, gy), family, families, plane_stride, planes + i);
    for (int i = 0; odd > 0 && 2 * i < width; i++) {
        const short16 x = vload16(2 * i, gx), right_x = vload16(2 * i + 1, gx);
        const short16 y = vload16(2 * i, gy), right_y = vload16(2 * i + 1, gy);
        gamma_vectors((short16)(x.even, right_x.even), (short16)(y.even, right_y.even), family, families, plane_stride,
                      planes + i);
        gamma_vectors((short16)(x.odd, right_x.odd), (short16)(y.odd, right_y.odd), family, families, plane_stride,
                      planes + odd + i);
    }
}

/* The slots of a group of pixels; at[i]: where offset i's gamma of the group's first pixel is. */
static void group_slots(const field_sizes *s, const field_table *t, __local const ushort *planes, const int *at,
                        __local ushort16 *slots)
{
    ushort16 s0 = 0, s1 = 0, s2 = 0, s3 = 0;
    __local ushort16 *slot = slots;
    int i = 0, j = 0;
    for (; j < s->plain_slots; j++, slot += FIELD_GROUP) {
        for (const int end = t->boundaries[j]; i < end; i++) {
            __local const ushort *gamma = planes + at[i];
            s0 += load(gamma);
            s1 += load(gamma + LANES);
            s2 += load(gamma + 2 * LANES);
            s3 += load(gamma + 3 * LANES);
        }
        slot[0] = s0;
        slot[1] = s1;
        slot[2] = s2;
        slot[3] = s3;
    }
    for (; j < s->slots; j++, slot += FIELD_GROUP) {
        __local const ushort16 *low = slots + t->extras[j - s->plain_slots] * FIELD_GROUP;
        slot[0] = s0 + low[0];
        slot[1] = s1 + low[1];
        slot[2] = s2 + low[2];
        slot[3] = s3 + low[3];
    }
}

/* Strengths of a group, with `suppress` sectors repeated at either end; returns whether any reaches the least of a candidate's
 * branch. */
static int group_strengths(const field_sizes *s, __global const int *sector, __local const ushort16 *slots,
                           __local short16 *strengths)
{
    __local short16 *z = strengths + s->suppress * FIELD_GROUP;
    short16 some = 0;
    for (int k = 0; k < s->sectors; k++, sector += FIELD_SECTOR_INTS, z += FIELD_GROUP) {
        __local const ushort16 *low = slots + sector[SECTOR_LOW] * FIELD_GROUP, *high = slots + sector[SECTOR_HIGH] * FIELD_GROUP;
        const ushort16 mean = (ushort)sector[SECTOR_MEAN], scale = (ushort)sector[SECTOR_SCALE];
        const short16 least = (short)(sector[SECTOR_LEAST] - 1);
        for (int v = 0; v < FIELD_GROUP; v++) {
            z[v] = as_short16(high_product_unsigned(excess(high[v] - low[v], mean), scale));
            some |= z[v] > least;
        }
    }
    if (!any16(some))
        return 0;
    for (int i = 0; i < s->suppress * FIELD_GROUP; i++) {
        strengths[i] = strengths[s->sectors * FIELD_GROUP + i];
        z[i] = strengths[s->suppress * FIELD_GROUP + i];
    }
    return 1;
}

/* -1 where the sector at z is a peak. */
static short16 is_peak(__local const short16 *z, int suppress, int least)
{
    short16 before = (short)(least - 1), after = 0;
    for (int d = 1; d <= suppress; d++) {
        before = max(before, z[-d * FIELD_GROUP]);
        after = max(after, z[d * FIELD_GROUP]);
    }
    return (z[0] > before) & (z[0] >= after);
}

/* The candidates among LANES pixels; z: their strengths of sector 0. */
static uint find_candidates(const field_sizes *s, __global const int *sector, __local const short16 *z, ulong partners)
{
    union {
        ushort16 vectors[4];
        ushort numbers[4][LANES];
    } words;
    union {
        short16 vector;
        short numbers[LANES];
    } twice;
    short16 seen = 0;
    uint mask = 0;
    twice.vector = 0;
    for (int word = 0, k = 0; word < 4; word++) {
        short16 bits = 0;
        for (int bit = 0; bit < 16 && k < s->sectors; bit++, k++, z += FIELD_GROUP, sector += FIELD_SECTOR_INTS) {
            const short16 peak = is_peak(z, s->suppress, sector[SECTOR_LEAST]);
            twice.vector |= seen & peak;
            seen |= peak;
            bits |= peak & (short)(1 << bit);
        }
        words.vectors[word] = as_ushort16(bits);
    }
    if (!any16(twice.vector))
        return 0;
    for (int i = 0; i < LANES; i++)
        if (twice.numbers[i]) {
            const ulong peaks = words.numbers[0][i] | (ulong)words.numbers[1][i] << 16 | (ulong)words.numbers[2][i] << 32 |
                                (ulong)words.numbers[3][i] << 48;
            mask |= (uint)has_pair(peaks, s->sectors, partners) << i;
        }
    return mask;
}

/* Eight bits in even places. */
static uint spread(uint bits)
{
    bits = (bits | bits << 4) & 0x0f0fu;
    bits = (bits | bits << 2) & 0x3333u;
    return (bits | bits << 1) & 0x5555u;
}

__kernel void field_tiles(__global const short *gradient_x, __global const short *gradient_y, int width, int stride, int base,
                          int top, int bottom, int blocks, __global const int *table, field_sizes sizes, __global ushort *masks,
                          int tile_rows, int plane_stride, __local ushort16 *planes, __local ushort16 *slots,
                          __local short16 *strengths)
{
    const field_table t = open_table(&sizes, table);
    const int radius = sizes.radius, depth = 2 * radius + 1, row_size = 4 * sizes.families * plane_stride, step = sizes.step;
    const int odd = step > 1 ? plane_stride / 2 : 0, margin = (radius + step - 1) / step * step;
    const int left = FIELD_TILE * (int)get_global_id(0), right = min(left + FIELD_TILE, blocks * LANES);
    const int reach = (right - left + 2 * margin + LANES - 1) / LANES;
    const int first = top + tile_rows * (int)get_global_id(1), last = min(first + tile_rows, bottom);
    const ulong partners = make_partners(&sizes);
    int at[FIELD_MAX_OFFSETS];
    for (int y = first - radius; y < last + radius; y++) {
        const size_t from = (size_t)(y - base) * (size_t)stride + (size_t)(left - margin + MARGIN);
        const int centre = y - radius;
        gamma_planes(t.families, sizes.families, gradient_x + from, gradient_y + from, reach, odd, plane_stride,
                     planes + (y + depth) % depth * row_size);
        if (centre < first)
            continue;
        __global ushort *to = masks + (size_t)(centre - top) * (size_t)blocks + (size_t)(left / LANES);
        if (centre % step != 0) {
            for (int i = 0; i < (right - left) / LANES; i++)
                to[i] = 0;
            continue;
        }
        for (int i = 0; i < sizes.offsets; i++) {
            __global const int *o = t.offsets + FIELD_OFFSET_INTS * i;
            const int column = o[OFFSET_DX] + margin, plane = o[OFFSET_PLANE] * plane_stride + column % step * odd;
            at[i] = ((centre + o[OFFSET_DY] + depth) % depth * row_size + plane) * LANES + column / step;
        }
        for (int x = left; x < right; x += FIELD_GROUP * LANES * step) {
            group_slots(&sizes, &t, (__local const ushort *)planes + (x - left) / step, at, slots);
            const int interesting = group_strengths(&sizes, t.sectors, slots, strengths);
            for (int v = 0; v < FIELD_GROUP; v++) {
                __local const short16 *z = strengths + sizes.suppress * FIELD_GROUP + v;
                const uint mask = interesting ? find_candidates(&sizes, t.sectors, z, partners) : 0;
                for (int part = 0; part < step; part++) {
                    const int place = x + (v * step + part) * LANES;
                    const uint bits = step > 1 ? spread(mask >> 8 * part & 255) : mask;
                    if (place < right)
                        to[(place - left) / LANES] = (ushort)inside_only(bits, width - place);
                }
            }
        }
    }
}
