/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3 on a device: the strongest branches at candidates, for each radius, as in isotropic.c; the host judges them. Two forms
 * with the same results: isotropic_candidates, a work-group for each candidate, for devices with thousands of work items;
 * isotropic_batches, a work item for LANES candidates, for processors. Planes and table: contract.h.
 *
 * A peak is one number: its sum in the upper half, its sector in the lower; 0 = none. Those of candidate c for radius r go to
 * peaks[(c * radii + r) * most], in the order of asj_isotropic_judge(). A candidate is x in the lower half, y in the upper. */

/* ---- isotropic_candidates ---- */

/* gamma at offset i of a run of the pixel at (gx, gy). */
static ushort gamma(__global const short *gx, __global const short *gy, int stride, __global const int *run, int i)
{
    const int at = run[RUN_DY] * stride + run[RUN_DX] + i, x = gx[at], y = gy[at];
    const int cross = (x * run[RUN_Y + i] >> 16) - (y * run[RUN_CROSS_X + i] >> 16);
    const int dot = (x * run[RUN_X + i] >> 16) - (y * run[RUN_DOT_Y + i] >> 16);
    return (ushort)max((int)abs(cross) - (int)abs(dot), 0);
}

/* The sum of a sector: circularly so many of the radius' `count` offsets. */
static uint sector_sum(__local const ushort *gammas, __global const int *places, int count, __global const int *sector)
{
    ushort sum = 0;
    for (int i = 0, at = sector[SECTOR_FIRST]; i < sector[SECTOR_SIZE]; i++, at = at + 1 < count ? at + 1 : 0)
        sum += gammas[places[at]];
    return sum;
}

static uint strength(uint sum, __global const int *sector)
{
    return (uint)max((int)sum - sector[SECTOR_MEAN], 0) * (uint)sector[SECTOR_SCALE] >> 16;
}

/* Whether sector k is a peak. */
static int is_largest(__local const uint *strengths, int k, int count, int suppress, uint least)
{
    const uint here = strengths[k];
    int largest = here >= least;
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
        int moves = 0; /* what has had to leave its place takes the next one, also from its equal */
        for (int i = 0; next && i < MAX_BRANCHES; i++) {
            moves |= next >> 16 > list[i] >> 16;
            if (moves) {
                const uint old = list[i];
                list[i] = next;
                next = old;
            }
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
        __global const int *runs = table + radius[RADIUS_RUN_AT];
        const int count = radius[RADIUS_SECTORS];
        for (int i = item; i < radius[RADIUS_RUNS] * RUN; i += items)
            gammas[i] = gamma(gradient_x + at, gradient_y + at, stride, runs + i / RUN * RUN_INTS, i % RUN);
        barrier(CLK_LOCAL_MEM_FENCE);
        const int own = table[radius[RADIUS_SLOT_AT] + radius[RADIUS_PLAIN_SLOTS] - 1]; /* the last plain slot is the total */
        for (int k = item; k < count; k += items) {
            __global const int *sector = sectors + ISOTROPIC_SECTOR_INTS * k;
            const uint sum = sector_sum(gammas, table + radius[RADIUS_PLACE_AT], own, sector);
            strengths[k] = strength(sum, sector);
            found[k] = sum << 16 | (uint)k;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (int k = item; k < count; k += items)
            if (!is_largest(strengths, k, count, radius[RADIUS_SUPPRESS], (uint)sectors[ISOTROPIC_SECTOR_INTS * k + SECTOR_LEAST]))
                found[k] = 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item == 0)
            list_peaks(found, count, most, to);
    }
}

/* ---- isotropic_batches: a work item is the whole work-group ---- */

/* The numbers of a and b in turns, in each half: those from its first four, or from its last. */
#define FIRST_FOUR(a, b) (a).s0, (b).s0, (a).s1, (b).s1, (a).s2, (b).s2, (a).s3, (b).s3
#define LAST_FOUR(a, b) (a).s4, (b).s4, (a).s5, (b).s5, (a).s6, (b).s6, (a).s7, (b).s7

/* Turns the two squares of 8 x 8 numbers that stand side by side in v: columns become rows. Taking row i and
 * row i + 4 in turns, three times, does that. Unrolled, the rows stay in registers. */
static void turn_squares(ushort16 v[RUN])
{
    ushort16 t[RUN];
#pragma unroll
    for (int round = 0; round < 3; round++) {
#pragma unroll
        for (int i = 0; i < RUN / 2; i++) {
            t[2 * i] = (ushort16)(FIRST_FOUR(v[i].lo, v[i + RUN / 2].lo), FIRST_FOUR(v[i].hi, v[i + RUN / 2].hi));
            t[2 * i + 1] = (ushort16)(LAST_FOUR(v[i].lo, v[i + RUN / 2].lo), LAST_FOUR(v[i].hi, v[i + RUN / 2].hi));
        }
#pragma unroll
        for (int i = 0; i < RUN; i++)
            v[i] = t[i];
    }
}

static short16 twice(__global const int *factors)
{
    const short8 once = convert_short8(vload8(0, factors));
    return (short16)(once, once);
}

/* Gammas at all runs; at[i]: candidate i in the planes. */
static void batch_gammas(__global const short *gradient_x, __global const short *gradient_y, const int *at, int stride,
                         __global const int *run, int count, __local ushort16 *gammas)
{
    for (int r = 0; r < count; r++, run += RUN_INTS, gammas += RUN) {
        const int to = run[RUN_DY] * stride + run[RUN_DX];
        const short16 ux = twice(run + RUN_X), uy = twice(run + RUN_Y);
        const short16 cross_x = twice(run + RUN_CROSS_X), dot_y = twice(run + RUN_DOT_Y);
        __global const short *gx = gradient_x + to, *gy = gradient_y + to;
        ushort16 v[RUN];
#pragma unroll
        for (int i = 0; i < RUN; i++) {
            const short16 x = (short16)(vload8(0, gx + at[i]), vload8(0, gx + at[i + RUN]));
            const short16 y = (short16)(vload8(0, gy + at[i]), vload8(0, gy + at[i + RUN]));
            v[i] = gamma16(high_product(x, uy) - high_product(y, cross_x), high_product(x, ux) - high_product(y, dot_y));
        }
        turn_squares(v);
#pragma unroll
        for (int i = 0; i < RUN; i++)
            gammas[i] = v[i];
    }
}

/* Slots of src/detect/sector_plan.h. */
static void batch_slots(__global const int *radius, __global const int *table, __local const ushort16 *gammas,
                        __local ushort16 *slots)
{
    __global const int *places = table + radius[RADIUS_PLACE_AT], *slot = table + radius[RADIUS_SLOT_AT];
    ushort16 total = 0;
    int i = 0, j = 0;
    for (; j < radius[RADIUS_PLAIN_SLOTS]; j++) {
        ushort16 sum = 0;
        for (const int end = slot[j]; i < end; i++)
            sum += gammas[places[i]];
        total += sum;
        slots[j] = total;
    }
    for (; j < radius[RADIUS_SLOTS]; j++)
        slots[j] = total + slots[slot[j]];
}

/* Strengths, with `suppress` sectors repeated at either end. */
static void batch_strengths(__global const int *radius, __global const int *sector, __local const ushort16 *slots,
                            __local short16 *strengths)
{
    const int count = radius[RADIUS_SECTORS], suppress = radius[RADIUS_SUPPRESS];
    for (int k = 0; k < count; k++, sector += ISOTROPIC_SECTOR_INTS) {
        const ushort16 sum = slots[sector[SECTOR_HIGH]] - slots[sector[SECTOR_LOW]];
        const ushort16 mean = (ushort)sector[SECTOR_MEAN], scale = (ushort)sector[SECTOR_SCALE];
        strengths[k + suppress] = as_short16(high_product_unsigned(excess(sum, mean), scale));
    }
    for (int k = 0; k < suppress; k++) {
        strengths[k] = strengths[k + count];
        strengths[k + count + suppress] = strengths[k + suppress];
    }
}

/* Puts numbers where their sum is larger, or where they move on to from the place before, and returns the others. */
static uint16 put(uint16 *place, uint16 next, int16 *moves)
{
    const uint16 old = *place;
    *moves |= next > (old | 65535);
    *place = select(old, next, *moves);
    return select(next, old, *moves);
}

/* The five first peaks of each lane, in the order of asj_isotropic_judge(), one after the other. */
static void batch_peaks(__global const int *radius, __global const int *sector, __local const ushort16 *slots,
                        __local const short16 *strength, __local uint16 *list)
{
    const int suppress = radius[RADIUS_SUPPRESS];
    uint16 first = 0, second = 0, third = 0, fourth = 0, fifth = 0;
    strength += suppress;
    for (int k = 0; k < radius[RADIUS_SECTORS]; k++, sector += ISOTROPIC_SECTOR_INTS, strength++) {
        short16 before = (short)(sector[SECTOR_LEAST] - 1), after = 0;
        if (!any16(strength[0] > before))
            continue;
        for (int d = 1; d <= suppress; d++) {
            before = max(before, strength[-d]);
            after = max(after, strength[d]);
        }
        const short16 peak = (strength[0] > before) & (strength[0] >= after);
        if (!any16(peak))
            continue;
        const ushort16 sum = (slots[sector[SECTOR_HIGH]] - slots[sector[SECTOR_LOW]]) & as_ushort16(peak);
        uint16 next = convert_uint16(sum) << 16 | (convert_uint16(as_ushort16(peak)) & (uint)k);
        int16 moves = 0;
        next = put(&first, next, &moves);
        next = put(&second, next, &moves);
        next = put(&third, next, &moves);
        next = put(&fourth, next, &moves);
        put(&fifth, next, &moves);
    }
    list[0] = first;
    list[1] = second;
    list[2] = third;
    list[3] = fourth;
    list[4] = fifth;
}

__kernel void isotropic_batches(__global const short *gradient_x, __global const short *gradient_y, int stride, int base,
                                __global const int *table, int radii, int most, __global const uint *candidates,
                                __global uint *peaks, int count, __local ushort16 *gammas, __local ushort16 *slots,
                                __local short16 *strengths, __local uint16 *list)
{
    const int first = LANES * (int)get_global_id(0), lanes = min(count - first, LANES);
    int at[LANES];
    for (int i = 0; i < LANES; i++) { /* lanes to spare look where the first does */
        const uint place = candidates[first + (i < lanes ? i : 0)];
        at[i] = ((int)(place >> 16) - base) * stride + (int)(place & 0xffff) + MARGIN;
    }
    for (int r = 0; r < radii; r++) {
        __global const int *radius = table + RADIUS_INTS * r, *sectors = table + radius[RADIUS_SECTOR_AT];
        if (radius[RADIUS_RUNS] > 0)
            batch_gammas(gradient_x, gradient_y, at, stride, table + radius[RADIUS_RUN_AT], radius[RADIUS_RUNS], gammas);
        batch_slots(radius, table, gammas, slots);
        batch_strengths(radius, sectors, slots, strengths);
        batch_peaks(radius, sectors, slots, strengths, list);
        for (int i = 0; i < lanes; i++)
            for (int m = 0; m < most; m++)
                peaks[((size_t)(first + i) * (size_t)radii + (size_t)r) * (size_t)most + (size_t)m] =
                    ((__local const uint *)list)[m * LANES + i];
    }
}
