/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3 on a device: the strongest branches at candidates, for each radius, as in src/isotropic.c; the host judges them. Two forms
 * with the same results: isotropic_candidates, a work-group for each candidate, for devices with thousands of work items;
 * isotropic_windows, a work item for two windows of pixels, for processors. Planes of the frame as in gradient.cl.
 *
 * A peak is one number: its sum in the upper half, its sector in the lower; 0 = none. Those of candidate c for radius r go to
 * peaks[(c * radii + r) * most], in the order of asj_isotropic_insert().
 *
 * The table, in ints (src/cl/isotropic_ops.c): RADIUS_INTS for each radius, which say where in the table the rest is. */

#define MARGIN 32
#define STRENGTH_ONE 256
#define MAX_BRANCHES 5

#define RADIUS_INTS 9
enum {
    RADIUS_SECTORS, RADIUS_SUPPRESS, RADIUS_PLAIN_SLOTS, RADIUS_SLOTS,
    RADIUS_OFFSETS,     /* number of offsets when gammas of its own are made; 0 = those of the radius before serve it */
    RADIUS_OFFSET_AT,   /* OFFSET_INTS for each of these */
    RADIUS_FROM_AT,     /* for each of its own offsets: which of those it is */
    RADIUS_SLOT_AT,     /* where each plain slot ends; which plain slot each extra slot adds to the total */
    RADIUS_SECTOR_AT    /* SECTOR_INTS for each sector */
};
#define OFFSET_INTS 6
enum { OFFSET_DX, OFFSET_DY, OFFSET_X, OFFSET_Y, OFFSET_CROSS_X, OFFSET_DOT_Y };
#define SECTOR_INTS 6
enum { SECTOR_LOW, SECTOR_HIGH, SECTOR_MEAN, SECTOR_SCALE, SECTOR_FIRST, SECTOR_SIZE };

/* ---- isotropic_candidates ---- */

/* gamma at offset o of the pixel at (gx, gy). */
static ushort gamma(__global const short *gx, __global const short *gy, int stride, __global const int *o)
{
    const int at = o[OFFSET_DY] * stride + o[OFFSET_DX], x = gx[at], y = gy[at];
    const int cross = (x * o[OFFSET_Y] >> 16) - (y * o[OFFSET_CROSS_X] >> 16);
    const int dot = (x * o[OFFSET_X] >> 16) - (y * o[OFFSET_DOT_Y] >> 16);
    return (ushort)max((int)abs(cross) - (int)abs(dot), 0);
}

/* The sum of a sector: a circular run of the radius' `count` offsets. */
static uint sector_sum(__local const ushort *gammas, __global const int *from, int count, __global const int *sector)
{
    ushort sum = 0;
    for (int i = 0, at = sector[SECTOR_FIRST]; i < sector[SECTOR_SIZE]; i++, at = at + 1 < count ? at + 1 : 0)
        sum += gammas[from[at]];
    return sum;
}

static uint strength(uint sum, __global const int *sector)
{
    return (uint)max((int)sum - sector[SECTOR_MEAN], 0) * (uint)sector[SECTOR_SCALE] >> 16;
}

/* Whether sector k is a peak. */
static int is_largest(__local const uint *strengths, int k, int count, int suppress)
{
    const uint here = strengths[k];
    int largest = here > STRENGTH_ONE;
    for (int d = 1; largest && d <= suppress; d++)
        largest = here > strengths[k >= d ? k - d : k - d + count] && here >= strengths[k + d < count ? k + d : k + d - count];
    return largest;
}

/* Those of the peaks that are not 0, put into a list of at most `most`. */
static void list_peaks(__local const uint *peaks, int count, int most, __global uint *to)
{
    uint list[MAX_BRANCHES] = {0, 0, 0, 0, 0};
    for (int k = 0; k < count; k++) {
        uint next = peaks[k];
        for (int i = 0; next && i < MAX_BRANCHES; i++)
            if (next >> 16 > list[i] >> 16) {
                const uint old = list[i];
                list[i] = next;
                next = old;
            }
    }
    for (int i = 0; i < most; i++)
        to[i] = list[i];
}

__kernel void isotropic_candidates(__global const short *gradient_x, __global const short *gradient_y, int stride, int base,
                                   __global const int *table, int radii, int most, __global const uint *candidates,
                                   __global uint *peaks, __local ushort *gammas, __local uint *strengths, __local uint *found)
{
    const int candidate = (int)get_group_id(0), item = (int)get_local_id(0), items = (int)get_local_size(0);
    const uint place = candidates[candidate];
    const size_t at = (size_t)((int)(place >> 16) - base) * (size_t)stride + (size_t)((place & 0xffff) + MARGIN);
    __global uint *to = peaks + (size_t)candidate * (size_t)(radii * most);
    for (int r = 0; r < radii; r++, to += most) {
        __global const int *radius = table + RADIUS_INTS * r, *sectors = table + radius[RADIUS_SECTOR_AT];
        const int count = radius[RADIUS_SECTORS];
        for (int i = item; i < radius[RADIUS_OFFSETS]; i += items)
            gammas[i] = gamma(gradient_x + at, gradient_y + at, stride, table + radius[RADIUS_OFFSET_AT] + OFFSET_INTS * i);
        barrier(CLK_LOCAL_MEM_FENCE);
        const int own = table[radius[RADIUS_SLOT_AT] + radius[RADIUS_PLAIN_SLOTS] - 1]; /* the last plain slot is the total */
        for (int k = item; k < count; k += items) {
            __global const int *sector = sectors + SECTOR_INTS * k;
            const uint sum = sector_sum(gammas, table + radius[RADIUS_FROM_AT], own, sector);
            strengths[k] = strength(sum, sector);
            found[k] = sum << 16 | (uint)k;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (int k = item; k < count; k += items)
            if (!is_largest(strengths, k, count, radius[RADIUS_SUPPRESS]))
                found[k] = 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item == 0)
            list_peaks(found, count, most, to);
    }
}

/* ---- isotropic_windows: the work-group is one item; it takes windows 2 i and 2 i + 1, lanes 0..7 and 8..15 ---- */

#define WINDOW 8
#define LANES 16

typedef struct window {
    int x, y;      /* of its first pixel */
    uint bits;     /* bit i: pixel x + i is a candidate */
    uint first;    /* number of the first of these */
} window;

static void window_gammas(__global const short *gx, __global const short *gy, int second, int stride, __global const int *o,
                          int count, __local ushort16 *gammas)
{
    for (int i = 0; i < count; i++, o += OFFSET_INTS) {
        const int at = o[OFFSET_DY] * stride + o[OFFSET_DX];
        const short16 x = (short16)(vload8(0, gx + at), vload8(0, gx + at + second));
        const short16 y = (short16)(vload8(0, gy + at), vload8(0, gy + at + second));
        const short16 cross = high_product(x, (short)o[OFFSET_Y]) - high_product(y, (short)o[OFFSET_CROSS_X]);
        const short16 dot = high_product(x, (short)o[OFFSET_X]) - high_product(y, (short)o[OFFSET_DOT_Y]);
        gammas[i] = gamma16(cross, dot);
    }
}

/* Slots of src/sector_plan.h. */
static void window_slots(__global const int *radius, __global const int *table, __local const ushort16 *gammas,
                         __local ushort16 *slots)
{
    __global const int *from = table + radius[RADIUS_FROM_AT], *slot = table + radius[RADIUS_SLOT_AT];
    ushort16 sum = 0;
    int i = 0, j = 0;
    for (; j < radius[RADIUS_PLAIN_SLOTS]; j++) {
        for (const int end = slot[j]; i < end; i++)
            sum += gammas[from[i]];
        slots[j] = sum;
    }
    for (; j < radius[RADIUS_SLOTS]; j++)
        slots[j] = sum + slots[slot[j]];
}

/* Strengths, with `suppress` sectors repeated at either end. */
static void window_strengths(__global const int *radius, __global const int *sector, __local const ushort16 *slots,
                             __local ushort16 *strengths)
{
    const int count = radius[RADIUS_SECTORS], suppress = radius[RADIUS_SUPPRESS];
    for (int k = 0; k < count; k++, sector += SECTOR_INTS) {
        const ushort16 sum = slots[sector[SECTOR_HIGH]] - slots[sector[SECTOR_LOW]];
        const ushort16 mean = (ushort)sector[SECTOR_MEAN], scale = (ushort)sector[SECTOR_SCALE];
        strengths[k + suppress] = high_product_unsigned(excess(sum, mean), scale);
    }
    for (int k = 0; k < suppress; k++) {
        strengths[k] = strengths[k + count];
        strengths[k + count + suppress] = strengths[k + suppress];
    }
}

/* -1 where the sector at row k of the strengths is a peak. */
static short16 is_peak(__local const ushort16 *strengths, int k, int suppress)
{
    const ushort16 here = strengths[k];
    ushort16 before = STRENGTH_ONE, after = 0;
    for (int d = 1; d <= suppress; d++) {
        before = max(before, strengths[k - d]);
        after = max(after, strengths[k + d]);
    }
    return (here > before) & (here >= after);
}

/* Puts numbers where their sum is larger, and returns the others. */
static uint16 put(uint16 *place, uint16 next)
{
    const uint16 old = *place;
    const int16 larger = next > (old | 65535);
    *place = select(old, next, larger);
    return select(next, old, larger);
}

/* The five first peaks of each lane, in the order of asj_isotropic_insert(), one after the other. */
static void window_peaks(__global const int *radius, __global const int *sector, __local const ushort16 *slots,
                         __local const ushort16 *strengths, __local uint16 *list)
{
    uint16 first = 0, second = 0, third = 0, fourth = 0, fifth = 0;
    for (int k = 0; k < radius[RADIUS_SECTORS]; k++, sector += SECTOR_INTS) {
        const short16 peak = is_peak(strengths, k + radius[RADIUS_SUPPRESS], radius[RADIUS_SUPPRESS]);
        if (!any16(peak))
            continue;
        const ushort16 sum = (slots[sector[SECTOR_HIGH]] - slots[sector[SECTOR_LOW]]) & as_ushort16(peak);
        uint16 next = convert_uint16(sum) << 16 | (convert_uint16(as_ushort16(peak)) & (uint)k);
        next = put(&first, next);
        next = put(&second, next);
        next = put(&third, next);
        next = put(&fourth, next);
        put(&fifth, next);
    }
    list[0] = first;
    list[1] = second;
    list[2] = third;
    list[3] = fourth;
    list[4] = fifth;
}

__kernel void isotropic_windows(__global const short *gradient_x, __global const short *gradient_y, int stride, int base,
                                __global const int *table, int radii, int most, __global const window *windows,
                                __global uint *peaks, __local ushort16 *gammas, __local ushort16 *slots,
                                __local ushort16 *strengths, __local uint16 *list)
{
    const window pair[2] = {windows[2 * get_global_id(0)], windows[2 * get_global_id(0) + 1]};
    const size_t at = (size_t)(pair[0].y - base) * (size_t)stride + (size_t)(pair[0].x + MARGIN);
    const int second = (pair[1].y - pair[0].y) * stride + pair[1].x - pair[0].x;
    for (int r = 0; r < radii; r++) {
        __global const int *radius = table + RADIUS_INTS * r, *sectors = table + radius[RADIUS_SECTOR_AT];
        if (radius[RADIUS_OFFSETS] > 0)
            window_gammas(gradient_x + at, gradient_y + at, second, stride, table + radius[RADIUS_OFFSET_AT],
                          radius[RADIUS_OFFSETS], gammas);
        window_slots(radius, table, gammas, slots);
        window_strengths(radius, sectors, slots, strengths);
        window_peaks(radius, sectors, slots, strengths, list);
        for (int w = 0; w < 2; w++) {
            size_t to = (size_t)pair[w].first * (size_t)(radii * most) + (size_t)(r * most);
            for (int i = 0; i < WINDOW; i++)
                if (pair[w].bits >> i & 1) {
                    for (int m = 0; m < most; m++)
                        peaks[to + m] = ((__local const uint *)list)[m * LANES + w * WINDOW + i];
                    to += radii * most;
                }
        }
    }
}
