/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7 on a device: products of all pairs of unit vectors and the best partners, as in compare.c and rank.c, for a block of
 * rows: of L-junctions of image 1. Lists are kept in order of score, of equals the smaller index first: one order, however the
 * work is divided. */

/* Sixteen products, added in pairs. Compilers for processors have one instruction for that, and find it when nothing comes between
 * the two products: `all`, -1, keeps them together where its value is not known at compile time. */
static int8 multiply(short16 a, short16 b, int all)
{
    return (convert_int8(a.even) * convert_int8(b.even) + convert_int8(a.odd) * convert_int8(b.odd)) & all;
}

static int add_up(int8 v)
{
    const int4 s = v.lo + v.hi;
    return s.x + s.y + s.z + s.w;
}

static void store(int8 sum0, int8 sum1, int columns, __global int *to)
{
    to[0] = add_up(sum0);
    if (columns > 1)
        to[1] = add_up(sum1);
}

/* Vectors of `line` times 16 numbers. Behind the last frame the last one is taken again. */
static void multiply_frames(__global const short16 *left, __global const short16 *right, int line, int rows, int columns, int pitch,
                            __global int *to, int all)
{
    __global const short16 *l1 = left + min(1, rows - 1) * line, *l2 = left + min(2, rows - 1) * line;
    __global const short16 *l3 = left + min(3, rows - 1) * line, *r1 = right + min(1, columns - 1) * line;
    int8 s00 = 0, s01 = 0, s10 = 0, s11 = 0, s20 = 0, s21 = 0, s30 = 0, s31 = 0;
    for (int k = 0; k < line; k++) {
        const short16 b0 = right[k], b1 = r1[k];
        s00 += multiply(left[k], b0, all);
        s01 += multiply(left[k], b1, all);
        s10 += multiply(l1[k], b0, all);
        s11 += multiply(l1[k], b1, all);
        s20 += multiply(l2[k], b0, all);
        s21 += multiply(l2[k], b1, all);
        s30 += multiply(l3[k], b0, all);
        s31 += multiply(l3[k], b1, all);
    }
    store(s00, s01, columns, to);
    if (rows > 1)
        store(s10, s11, columns, to + pitch);
    if (rows > 2)
        store(s20, s21, columns, to + 2 * (size_t)pitch);
    if (rows > 3)
        store(s30, s31, columns, to + 3 * (size_t)pitch);
}

/* products[row * pitch + column] of frame first + row of image 1 and frame `column` of image 2. Work items along axis 0 share
 * columns. */
__kernel void distance_products(__global const short *left, __global const short *right, int length, int first, int rows,
                                int columns, int pitch, __global int *products)
{
    const int row = (int)get_global_id(0) * PRODUCT_ROWS, column = (int)get_global_id(1) * PRODUCT_COLUMNS;
    if (row < rows && column < columns)
        multiply_frames((__global const short16 *)(left + (size_t)(first + row) * (size_t)length),
                        (__global const short16 *)(right + (size_t)column * (size_t)length), length / 16, rows - row,
                        columns - column, pitch, products + (size_t)row * (size_t)pitch + (size_t)column, -1);
}

/* The same for processors; all = -1. */
__kernel void distance_products_paired(__global const short *left, __global const short *right, int length, int first, int rows,
                                       int columns, int pitch, __global int *products, int all)
{
    const int row = (int)get_global_id(0) * PRODUCT_ROWS, column = (int)get_global_id(1) * PRODUCT_COLUMNS;
    if (row < rows && column < columns)
        multiply_frames((__global const short16 *)(left + (size_t)(first + row) * (size_t)length),
                        (__global const short16 *)(right + (size_t)column * (size_t)length), length / 16, rows - row,
                        columns - column, pitch, products + (size_t)row * (size_t)pitch + (size_t)column, all);
}

/* scores[i * count2 + j] of L-junction first + i of image 1 and j of image 2: the largest product of two frames that can be used.
 * frames[i]: where the frames of an L-junction begin; those of `first` stand in row 0 of the products. */
__kernel void distance_scores(__global const int *products, int pitch, __global const uint *frames1, __global const uchar *usable1,
                              __global const uint *frames2, __global const uchar *usable2, int first, int count1, int count2,
                              __global int *scores)
{
    const int j = (int)get_global_id(0), i = (int)get_global_id(1);
    if (i >= count1 || j >= count2)
        return;
    const uint start = frames1[first], end = frames1[first + i + 1], begin2 = frames2[j], end2 = frames2[j + 1];
    int best = NO_PARTNER;
    for (uint f = frames1[first + i]; f < end; f++) {
        __global const int *row = products + (size_t)(f - start) * (size_t)pitch;
        if (!usable1[f])
            continue;
        for (uint g = begin2; g < end2; g++)
            best = usable2[g] ? max(best, row[g]) : best;
    }
    scores[(size_t)i * (size_t)count2 + (size_t)j] = best;
}

/* x, y within left, top, right, bottom. */
static int holds(float4 box, float2 at)
{
    return at.x >= box.x && at.x <= box.z && at.y >= box.y && at.y <= box.w;
}

/* Leaves the scores of pairs that lie where they are expected (src/match/expected.h), in px. */
__kernel void distance_expected(__global const float2 *points1, __global const float4 *boxes1, __global const float2 *points2,
                                __global const float4 *boxes2, int first, int count1, int count2, __global int *scores)
{
    const int j = (int)get_global_id(0), i = (int)get_global_id(1);
    if (i < count1 && j < count2 && !(holds(boxes1[first + i], points2[j]) && holds(boxes2[j], points1[first + i])))
        scores[(size_t)i * (size_t)count2 + (size_t)j] = NO_PARTNER;
}

/* Inserts into a list of (score, index) that falls; the earlier of equals stays first. */
static void offer(__global int2 *list, int limit, int score, int index)
{
    int k = limit - 1;
    for (; k > 0 && list[k - 1].x < score; k--)
        list[k] = list[k - 1];
    list[k] = (int2)(score, index);
}

/* The best partners of row i among the columns of part p, of `parts`: lists[((first + i) * parts + p) * limit]. */
__kernel void distance_rows(__global const int *scores, int first, int count1, int count2, int parts, int limit,
                            __global int2 *lists)
{
    const int p = (int)get_global_id(0), i = (int)get_global_id(1), columns = (count2 + parts - 1) / parts;
    if (p >= parts || i >= count1)
        return;
    __global const int *score = scores + (size_t)i * (size_t)count2;
    __global int2 *list = lists + ((size_t)(first + i) * (size_t)parts + (size_t)p) * (size_t)limit;
    int least = NO_PARTNER;
    for (int k = 0; k < limit; k++)
        list[k] = (int2)(NO_PARTNER, 0);
    for (int j = p * columns; j < min((p + 1) * columns, count2); j++)
        if (score[j] > least) {
            offer(list, limit, score[j], j);
            least = list[limit - 1].x;
        }
}

/* The parts' lists of row i become one: rows[(first + i) * limit]. Parts come in order of their columns. */
__kernel void distance_merge(__global const int2 *lists, int first, int count1, int parts, int limit, __global int2 *rows)
{
    const int i = (int)get_global_id(0);
    if (i >= count1)
        return;
    __global const int2 *from = lists + (size_t)i * (size_t)parts * (size_t)limit;
    __global int2 *list = rows + (size_t)(first + i) * (size_t)limit;
    for (int k = 0; k < limit; k++)
        list[k] = from[k];
    for (int k = limit; k < parts * limit; k++)
        if (from[k].x > list[limit - 1].x)
            offer(list, limit, from[k].x, from[k].y);
}

/* The block's rows, in order, are offered to the columns: columns[j * limit]. */
__kernel void distance_columns(__global const int *scores, int first, int count1, int count2, int limit, __global int2 *columns)
{
    const int j = (int)get_global_id(0);
    if (j >= count2)
        return;
    __global int2 *list = columns + (size_t)j * (size_t)limit;
    int least = list[limit - 1].x;
    for (int i = 0; i < count1; i++) {
        const int score = scores[(size_t)i * (size_t)count2 + (size_t)j];
        if (score > least) {
            offer(list, limit, score, first + i);
            least = list[limit - 1].x;
        }
    }
}
