/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7 on a device: canonical patches, as in patch.c. A work-group takes a patch; on processors it has one work item, whose
 * loops over samples compilers turn into vectors. */

/* Grey levels of a grid, those of this work item, and their sums. */
static patch_sums sample(__global const ushort *planes, const patch_pyramid *p, __global const patch_grid *grid, int size,
                         __local ushort *grey)
{
    const int level = grid->level, middle = 1 << (PATCH_GRID_BITS - 1);
    const int last_x = (p->width[0] - 1) << PATCH_GRID_BITS, last_y = (p->height[0] - 1) << PATCH_GRID_BITS;
    const int right = (p->width[level] - 1) << 8, bottom = (p->height[level] - 1) << 8, stride = p->width[level] + 1;
    const int ax = grid->ax, ay = grid->ay, bx = grid->bx, by = grid->by;
    __global const ushort *plane = planes + p->offset[level];
    patch_sums sums = {0, 0, 0};
    for (int j = (int)get_local_id(1); j < size; j += (int)get_local_size(1))
        for (int i = (int)get_local_id(0); i < size; i += (int)get_local_size(0)) {
            const int x = grid->x + i * ax + j * bx, y = grid->y + i * ay + j * by;
            const int ix = clamp((((x + middle) >> level) - middle) >> (PATCH_GRID_BITS - 8), 0, right);
            const int iy = clamp((((y + middle) >> level) - middle) >> (PATCH_GRID_BITS - 8), 0, bottom);
            const int wx = ix & 255, wy = iy & 255, at = (iy >> 8) * stride + (ix >> 8);
            const int upper = (256 - wx) * plane[at] + wx * plane[at + 1];
            const int lower = (256 - wx) * plane[at + stride] + wx * plane[at + stride + 1];
            const int g = ((256 - wy) * (upper >> 1) + wy * (lower >> 1) + (1 << 14)) >> 15;
            sums.inside += (x >= 0) & (y >= 0) & (x <= last_x) & (y <= last_y);
            sums.sum += g;
            sums.squares += (ulong)(g * g);
            grey[j * size + i] = (ushort)g;
        }
    return sums;
}

/* floor(sqrt(x)) for x < 2^50, digit by digit. */
static long whole_root(ulong x)
{
    ulong root = 0;
    for (ulong bit = (ulong)1 << 48; bit; bit >>= 2) {
        const ulong next = root + bit;
        root >>= 1;
        if (x >= next) {
            x -= next;
            root += bit;
        }
    }
    return (long)root;
}

/* What N g - sum is multiplied with, N = size^2, in 2^-32: as asj_patch_unit_scale(). */
static int unit_scale(const patch_sums *s, int size)
{
    const int samples = size * size;
    const long root = whole_root(s->squares * (ulong)samples - (ulong)((long)s->sum * s->sum));
    return (int)(((long)PATCH_UNIT_ONE << 32) / ((root + samples * PATCH_GRAY_ONE) * size));
}

/* plain_scale: 0 = patches are brought to zero mean and unit norm, else levels are multiplied with it, in 2^-32.
 * sums: one for each work item, and one for the patch. */
__kernel void patch_describe(__global const ushort *planes, patch_pyramid pyramid, __global const patch_grid *grids, int size,
                             int plain_scale, __global short *units, __global int *inside, __local ushort *grey,
                             __local patch_sums *sums)
{
    const int samples = size * size, items = (int)(get_local_size(0) * get_local_size(1));
    const int item = (int)(get_local_id(1) * get_local_size(0) + get_local_id(0));
    const size_t patch = get_group_id(0);
    const patch_sums none = {0, 0, 0};
    __local patch_sums *all = sums + items;
    grids += patch;
    units += patch * (size_t)samples;
    if (grids->level >= 0) {
        sums[item] = sample(planes, &pyramid, grids, size, grey);
    } else {
        sums[item] = none;
        for (int n = item; n < samples; n += items)
            grey[n] = 0;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item == 0) {
        patch_sums s = none;
        for (int i = 0; i < items; i++) {
            s.inside += sums[i].inside;
            s.sum += sums[i].sum;
            s.squares += sums[i].squares;
        }
        inside[patch] = s.inside;
        all->inside = plain_scale ? plain_scale : unit_scale(&s, size);
        all->sum = plain_scale ? 0 : s.sum;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const int sum = all->sum, factor = plain_scale ? 1 : samples;
    const long scale = all->inside;
    for (int n = item; n < samples; n += items)
        units[n] = (short)((scale * (factor * grey[n] - sum) + ((long)1 << 31)) >> 32);
}
