/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 4 on a device: rays that follow branches, as in src/detect/ray_walk.c, over local junctions, as in src/detect/field.c.
 *
 * Rays visit 5 to 10 % of the runs of LANES pixels. So both go in turns: a ray walks until it comes to a run whose local junctions
 * are not known, asks for all runs of its next steps, and stops (scan_walk); then those that were asked for are computed
 * (scan_runs or scan_pixels). Each run that was asked for has an entry: its number in entries[] and its branches in branches[].
 * asked[] is touched by atomic operations only, known[] (1 + entry, 0 = not known) written when entries are computed only, so
 * nothing is read while it is written. The order of the entries differs from time to time, the results do not.
 *
 * An image that the device has no room for is worked on in bands of rows, which overlap by more than a step needs. A ray that comes
 * to the end of the band waits for another one.
 *
 * Planes and tables: contract.h. */

/* ---- local junctions ---- */

typedef struct scan_table {
    __global const int *offsets, *boundaries, *extras, *sectors;
} scan_table;

static scan_table open_table(const scan_sizes *s, __global const int *table)
{
    scan_table t;
    t.offsets = table;
    t.boundaries = t.offsets + SCAN_OFFSET_INTS * s->offsets;
    t.extras = t.boundaries + s->plain_slots;
    t.sectors = t.extras + (s->slots - s->plain_slots);
    return t;
}

/* Sums of gamma up to each slot at LANES pixels, whose gradient stands at gx, gy. */
static void run_slots(const scan_sizes *s, const scan_table *t, __global const short *gx, __global const short *gy, int stride,
                      ushort16 *slots)
{
    ushort16 sum = 0;
    int i = 0, j = 0;
    for (; j < s->plain_slots; j++) {
        for (const int end = t->boundaries[j]; i < end; i++) {
            __global const int *o = t->offsets + SCAN_OFFSET_INTS * i;
            const int at = o[OFFSET_DY] * stride + o[OFFSET_DX];
            const short16 x = vload16(0, gx + at), y = vload16(0, gy + at);
            const short16 cross = high_product(x, (short)o[OFFSET_Y]) - high_product(y, (short)o[OFFSET_CROSS_X]);
            const short16 dot = high_product(x, (short)o[OFFSET_X]) - high_product(y, (short)o[OFFSET_DOT_Y]);
            sum += gamma16(cross, dot);
        }
        slots[j] = sum;
    }
    for (; j < s->slots; j++)
        slots[j] = sum + slots[t->extras[j - s->plain_slots]];
}

static void run_strengths(const scan_sizes *s, __global const int *sector, const ushort16 *slots, short16 *strengths)
{
    for (int k = 0; k < s->sectors; k++, sector += FIELD_SECTOR_INTS) {
        const ushort16 sum = slots[sector[SECTOR_HIGH]] - slots[sector[SECTOR_LOW]];
        const ushort16 mean = (ushort)sector[SECTOR_MEAN], scale = (ushort)sector[SECTOR_SCALE];
        strengths[k] = as_short16(high_product_unsigned(excess(sum, mean), scale));
    }
}

/* -1 where sector k is a peak. */
static short16 is_peak(const scan_sizes *s, const short16 *strengths, int k, int least)
{
    const short16 here = strengths[k];
    short16 before = (short)(least - 1), after = 0;
    if (!any16(here > before))
        return 0;
    for (int d = 1; d <= s->suppress; d++) {
        before = max(before, strengths[k >= d ? k - d : k - d + s->sectors]);
        after = max(after, strengths[k + d < s->sectors ? k + d : k + d - s->sectors]);
    }
    return (here > before) & (here >= after);
}

/* A branch takes a place of a list that falls, when it is stronger than what is there or `moves`, being what had the place before;
 * returns the one that goes on to the next place. Of equals the one put in first comes first. Strength in the high half, angle
 * (1/65536 of a turn) in the low half. */
static uint take_place(uint *place, uint branch, int *moves)
{
    const uint other = *place;
    *moves |= branch >> 16 > other >> 16;
    *place = *moves ? branch : other;
    return *moves ? other : branch;
}

static void insert(uint *list, uint branch)
{
    int moves = 0;
    for (int i = 0; i < SCAN_BRANCHES; i++)
        branch = take_place(list + i, branch, &moves);
}

/* The vertex of the parabola through three neighbouring strengths. */
static uint interpolate(int sectors, int k, int before, int peak, int after)
{
    const int shift = (after - before) * (65536 / sectors) / (2 * (2 * peak - before - after));
    return (uint)peak << 16 | (uint)(65536 * k / sectors + shift & 65535);
}

/* Two forms with the same results: scan_runs, a work item for each entry, for processors; scan_pixels, one for each pixel, for
 * devices with thousands of them. */
__kernel void scan_runs(__global const short *gradient_x, __global const short *gradient_y, int stride, int base, int blocks,
                        __global const int *table, scan_sizes sizes, __global const uint *entries, int first, int last,
                        __global uint *branches, __global uint *known)
{
    const int entry = first + (int)get_global_id(0);
    if (entry >= last)
        return;
    const scan_table t = open_table(&sizes, table);
    const uint run = entries[entry];
    const int x = (int)(run % (uint)blocks) * LANES, y = (int)(run / (uint)blocks);
    const size_t at = (size_t)(y - base) * (size_t)stride + (size_t)(x + MARGIN);
    ushort16 slots[SCAN_MAX_SLOTS];
    short16 strengths[SCAN_MAX_SECTORS];
    uint list[LANES * SCAN_BRANCHES];
    run_slots(&sizes, &t, gradient_x + at, gradient_y + at, stride, slots);
    run_strengths(&sizes, t.sectors, slots, strengths);
    for (int i = 0; i < LANES * SCAN_BRANCHES; i++)
        list[i] = 0;
    for (int k = 0; k < sizes.sectors; k++) {
        const short16 peak = is_peak(&sizes, strengths, k, t.sectors[FIELD_SECTOR_INTS * k + SECTOR_LEAST]);
        short peaks[LANES], before[LANES], here[LANES], after[LANES];
        if (!any16(peak))
            continue;
        vstore16(peak, 0, peaks);
        vstore16(strengths[k > 0 ? k - 1 : sizes.sectors - 1], 0, before);
        vstore16(strengths[k], 0, here);
        vstore16(strengths[k + 1 < sizes.sectors ? k + 1 : 0], 0, after);
        for (int i = 0; i < LANES; i++)
            if (peaks[i])
                insert(list + i * SCAN_BRANCHES, interpolate(sizes.sectors, k, before[i], here[i], after[i]));
    }
    __global uint *to = branches + (size_t)entry * (LANES * SCAN_BRANCHES);
    for (int i = 0; i < LANES * SCAN_BRANCHES; i++)
        to[i] = list[i];
    known[run] = (uint)entry + 1;
}

/* slot: those of this pixel, `step` apart. */
static void pixel_slots(const scan_sizes *s, const scan_table *t, __global const short *gx, __global const short *gy, int stride,
                        __local ushort *slot, int step)
{
    ushort sum = 0;
    int i = 0, j = 0;
    for (; j < s->plain_slots; j++) {
        for (const int end = t->boundaries[j]; i < end; i++) {
            __global const int *o = t->offsets + SCAN_OFFSET_INTS * i;
            const int at = o[OFFSET_DY] * stride + o[OFFSET_DX], x = gx[at], y = gy[at];
            const int cross = (x * o[OFFSET_Y] >> 16) - (y * o[OFFSET_CROSS_X] >> 16);
            const int dot = (x * o[OFFSET_X] >> 16) - (y * o[OFFSET_DOT_Y] >> 16);
            sum += (ushort)max((int)abs(cross) - (int)abs(dot), 0);
        }
        slot[j * step] = sum;
    }
    for (; j < s->slots; j++)
        slot[j * step] = sum + slot[t->extras[j - s->plain_slots] * step];
}

static int pixel_strength(const scan_sizes *s, const scan_table *t, __local const ushort *slot, int step, int k)
{
    __global const int *sector = t->sectors + FIELD_SECTOR_INTS * (k < 0 ? k + s->sectors : k < s->sectors ? k : k - s->sectors);
    const int sum = (ushort)(slot[sector[SECTOR_HIGH] * step] - slot[sector[SECTOR_LOW] * step]);
    return (int)((uint)max(sum - sector[SECTOR_MEAN], 0) * (uint)sector[SECTOR_SCALE] >> 16);
}

/* The branches of a pixel. */
static uint4 pixel_branches(const scan_sizes *s, const scan_table *t, __local const ushort *slot, int step)
{
    uint first = 0, second = 0, third = 0, fourth = 0;
    for (int k = 0; k < s->sectors; k++) {
        const int here = pixel_strength(s, t, slot, step, k);
        int peak = here >= t->sectors[FIELD_SECTOR_INTS * k + SECTOR_LEAST];
        for (int d = 1; peak && d <= s->suppress; d++)
            peak = here > pixel_strength(s, t, slot, step, k - d) && here >= pixel_strength(s, t, slot, step, k + d);
        if (!peak)
            continue;
        const int before = pixel_strength(s, t, slot, step, k - 1), after = pixel_strength(s, t, slot, step, k + 1);
        uint branch = interpolate(s->sectors, k, before, here, after);
        int moves = 0;
        branch = take_place(&first, branch, &moves);
        branch = take_place(&second, branch, &moves);
        branch = take_place(&third, branch, &moves);
        take_place(&fourth, branch, &moves);
    }
    return (uint4)(first, second, third, fourth);
}

/* A work-group takes whole entries. slots: sizes.slots for each work item. */
__kernel void scan_pixels(__global const short *gradient_x, __global const short *gradient_y, int stride, int base, int blocks,
                          __global const int *table, scan_sizes sizes, __global const uint *entries, int first, int last,
                          __global uint *branches, __global uint *known, __local ushort *slots)
{
    const int entry = first + (int)(get_global_id(0) / LANES), lane = (int)(get_global_id(0) % LANES);
    if (entry >= last)
        return;
    const scan_table t = open_table(&sizes, table);
    const uint run = entries[entry];
    const int x = (int)(run % (uint)blocks) * LANES + lane, y = (int)(run / (uint)blocks), step = (int)get_local_size(0);
    const size_t at = (size_t)(y - base) * (size_t)stride + (size_t)(x + MARGIN);
    __local ushort *slot = slots + get_local_id(0);
    pixel_slots(&sizes, &t, gradient_x + at, gradient_y + at, stride, slot, step);
    vstore4(pixel_branches(&sizes, &t, slot, step), (size_t)entry * LANES + (size_t)lane, branches);
    if (lane == 0)
        known[run] = (uint)entry + 1;
}

/* ---- rays ---- */

/* cos and sin of d / r in 2^-30 at [r SCAN_TABLE_WIDTH + d], then those of SCAN_UNITS angles in 2^-14. */
typedef struct scan_angles {
    __global const int2 *arc, *units;
} scan_angles;

typedef struct sample {
    long x, y;
    int cosine, sine; /* 2^-14 */
} sample;

static sample place(const scan_ray *ray, const scan_angles *angles, int r, int d)
{
    const int size = abs(d);
    const int2 turn = r < SCAN_TABLE_RADIUS ? angles->arc[r * SCAN_TABLE_WIDTH + size]
                                            : (int2)(1 << 30, (int)(((uint)size << 30) / (uint)r));
    const long c = turn.x, s = d < 0 ? -turn.y : turn.y;
    const long ex = (c * ray->ux - s * ray->uy) >> 30, ey = (c * ray->uy + s * ray->ux) >> 30;
    sample at;
    at.x = (ray->x + ((r * ex) >> 14) + 32768) >> 16;
    at.y = (ray->y + ((r * ey) >> 14) + 32768) >> 16;
    at.cosine = (int)(ex >> 16);
    at.sine = (int)(ey >> 16);
    return at;
}

enum { OUTSIDE = -1, AWAY = -2 }; /* of the image; of the band */

/* The run of a sample, or one of these. */
static int run_at(const scan_image *image, const sample *at)
{
    if (at->x < 0 || at->y < 0 || at->x >= image->width || at->y >= image->height)
        return OUTSIDE;
    if (at->y < image->low || at->y >= image->high)
        return AWAY;
    return ((int)at->y - image->low) * image->blocks + (int)at->x / LANES;
}

/* gamma~ of a branch seen from the ray; *ahead: whether it points along the ray. */
static int junctionness(const scan_angles *angles, uint branch, const sample *at, int *ahead)
{
    const int2 unit = angles->units[(((branch & 65535) + 32) >> 6) & (SCAN_UNITS - 1)];
    const int along = unit.x * at->cosine + unit.y * at->sine, across = unit.x * at->sine - unit.y * at->cosine;
    const int difference = (int)abs(along) - (int)abs(across);
    *ahead = along > 0;
    return difference > 0 ? (int)((uint)(difference >> 14) * (branch >> 16) >> 14) : 0;
}

/* The branch closest to an angle modulo `turn`; of equals the first. */
static uint closest(uint4 list, int angle, int turn)
{
    const int4 distance = convert_int4(list & 65535) - angle & turn - 1;
    const int4 folded = select(min(distance, turn - distance), (int4)65536, list < 65536);
    uint best = list.s0;
    int least = folded.s0;
    best = folded.s1 < least ? list.s1 : best;
    least = min(folded.s1, least);
    best = folded.s2 < least ? list.s2 : best;
    least = min(folded.s2, least);
    return folded.s3 < least ? list.s3 : best;
}

/* Sums over the arc at radius r: forward, ahead, axial. Returns 0 when a run is not known, AWAY when one is in another band. */
static int arc_sums(const scan_image *image, const scan_angles *angles, const scan_ray *ray, int r, __global const uint *known,
                    __global const uint *branches, int4 *sums)
{
    *sums = 0;
    for (int d = -image->half_width; d <= image->half_width; d++) {
        const sample at = place(ray, angles, r, d);
        const int run = run_at(image, &at);
        int ahead;
        if (run == AWAY)
            return AWAY;
        if (run == OUTSIDE)
            continue;
        const uint entry = known[run];
        if (entry == 0)
            return 0;
        const uint4 list = vload4((size_t)(entry - 1) * LANES + (size_t)((int)at.x & LANES - 1), branches);
        if (list.s0 < 65536)
            continue;
        const int gamma = junctionness(angles, closest(list, ray->angle, 65536), &at, &ahead);
        sums->s0 += gamma;
        sums->s1 += ahead ? gamma : 0;
        if (image->axial)
            sums->s2 += junctionness(angles, closest(list, ray->angle, 32768), &at, &ahead);
    }
    return 1;
}

/* The step to a radius; returns 0 when the ray ends there. */
static int step(const scan_image *image, scan_ray *ray, int radius, int4 sums)
{
    ray->ahead_passes = sums.s1 >= image->threshold ? ray->ahead_passes + 1 : 0;
    ray->ahead_failures = ray->ahead_passes ? 0 : ray->ahead_failures + 1;
    ray->axial_failures = sums.s2 >= image->threshold ? 0 : ray->axial_failures + 1;
    if (ray->ahead_passes >= SCAN_REOPEN)
        ray->forward_failures = 0;
    else if (sums.s0 < image->threshold || ray->forward_failures > image->tolerance)
        ray->forward_failures++;
    else
        ray->forward_failures = 0;
    if (ray->forward_failures == 0)
        ray->forward = radius;
    if (ray->axial_failures == 0)
        ray->axial = radius;
    return ray->forward_failures <= image->tolerance ||
           (ray->ahead_failures <= image->bridge && ray->axial_failures <= image->tolerance);
}

/* Whether there is an edge along the ray at a radius; AWAY: that is for another band. */
static int has_edge(const scan_image *image, const scan_ray *ray, int r, __global const short *gradient_x,
                    __global const short *gradient_y)
{
    const long x = ray->x + (((long)r * ray->ux) >> 14) + 32768, y = ray->y + (((long)r * ray->uy) >> 14) + 32768;
    const long across_x = -(ray->uy >> 14), across_y = ray->ux >> 14;
    const int ux = ray->ux >> 16, uy = ray->uy >> 16;
    int sum = 0;
    if (x >> 16 < 0 || y >> 16 < 0 || x >> 16 >= image->width || y >> 16 >= image->height)
        return 0;
    if (y >> 16 < image->low || y >> 16 >= image->high)
        return AWAY;
    for (int d = -1; d <= 1; d++) {
        const int row = (int)((y + d * across_y) >> 16) - image->base, column = (int)((x + d * across_x) >> 16) + MARGIN;
        const size_t at = (size_t)row * (size_t)image->stride + (size_t)column;
        const int gx = gradient_x[at], gy = gradient_y[at];
        sum += max((int)abs(gy * ux - gx * uy) - (int)abs(gx * ux + gy * uy), 0);
    }
    return sum >= image->edge;
}

/* Passes over the steps that have an edge under them beyond doubt. Returns 0 when another band has the rest of them. */
static int pass_over(const scan_image *image, scan_ray *ray, __global const short *gradient_x, __global const short *gradient_y)
{
    int end = max(ray->radius, ray->passed), edge;
    while ((edge = has_edge(image, ray, end, gradient_x, gradient_y)) > 0)
        end++;
    ray->passed = edge == AWAY ? end : 0;
    if (edge == AWAY)
        return 0;
    if (end - ray->radius <= SCAN_PLAIN)
        return 1;
    ray->forward = end - SCAN_PLAIN - 1;
    ray->axial = image->axial ? ray->forward : 0;
    ray->ahead_failures = 0;
    ray->radius = end - SCAN_PLAIN;
    return 1;
}

/* One step or a stride, as in src/detect/ray_walk.c; returns 0 when a run that it needs is not known, AWAY when the rest is for
 * another band. */
static int advance(const scan_image *image, const scan_angles *angles, scan_ray *ray, __global const short *gradient_x,
                   __global const short *gradient_y, __global const uint *known, __global const uint *branches)
{
    int stride = 1, goes_on = 1;
    int4 sums;
    if (ray->radius > ray->looked && image->tolerance > 0 && ray->forward_failures == 0 &&
        (!image->axial || ray->axial_failures == 0)) {
        if (!pass_over(image, ray, gradient_x, gradient_y))
            return AWAY;
        stride = SCAN_STRIDE;
    }
    const int summed = arc_sums(image, angles, ray, ray->radius + stride - 1, known, branches, &sums);
    if (summed != 1)
        return summed;
    if (stride > 1) {
        ray->looked = ray->radius + stride - 1;
        stride = sums.s1 >= image->threshold && (!image->axial || sums.s2 >= image->threshold) ? stride : 0;
        if (stride == 0 && image->rough && ray->forward > 0) {
            goes_on = !ray->missed;
            ray->looked = ray->radius++;
            ray->missed = 1;
        } else
            ray->missed = 0;
    }
    if (stride > 0)
        goes_on = step(image, ray, ray->radius + stride - 1, sums);
    ray->radius = goes_on ? ray->radius + stride : 0;
    return 1;
}

/* counts: entries; rays that go on; rays that wait for another band. */
__kernel void scan_walk(__global const short *gradient_x, __global const short *gradient_y, scan_image image,
                        __global const int2 *angle_table, __global scan_ray *rays, int count, __global const uint *known,
                        __global const uint *branches, volatile __global uint *asked, __global uint *entries,
                        volatile __global uint *counts)
{
    const int number = (int)get_global_id(0);
    if (number >= count)
        return;
    const scan_angles angles = {angle_table, angle_table + SCAN_TABLE_RADIUS * SCAN_TABLE_WIDTH};
    scan_ray ray = rays[number];
    if (ray.radius == 0)
        return;
    int advanced = 1;
    while (ray.radius && advanced == 1)
        advanced = advance(&image, &angles, &ray, gradient_x, gradient_y, known, branches);
    rays[number] = ray;
    if (ray.radius == 0)
        return;
    atomic_inc(counts + (advanced == AWAY ? 2 : 1));
    if (advanced == AWAY)
        return;
    for (int r = ray.radius, last = r + r / 4 + image.ahead; r < last; r++)
        for (int d = -image.half_width; d <= image.half_width; d++) {
            const sample at = place(&ray, &angles, r, d);
            const int run = run_at(&image, &at);
            if (run >= 0 && atomic_xchg(asked + run, 1) == 0)
                entries[atomic_inc(counts)] = (uint)run;
        }
}
