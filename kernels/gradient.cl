/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 1 on a device: the normalised gradient of gradient.c, where the formulas are explained. A work item takes eight pixels
 * of a row. Both kernels write the margin too, as zeros. */

/* C_c = round(1024 c / sigma_0) */
#define UNITS(c) ((2 * GRADIENT_ONE * 10000 * (c) + GRADIENT_SIGMA) / (2 * GRADIENT_SIGMA))

/* Floor of the square root, 0 <= s < 2^31: the estimate is off by one at most. */
static int8 integer_sqrt(int8 s)
{
    int8 root = convert_int8(sqrt(convert_float8(s)));
    root += root * root > s;
    return root - ((root + 1) * (root + 1) <= s);
}

/* Floor of a / b, 0 <= a < 2^31 - 2^12, 0 < b < 2^31. The first estimate is good to 2^-20 of itself, the second, of what is left,
 * to one. */
static int8 quotient(int8 a, int8 b)
{
    const float8 inverse = 1.0f / convert_float8(b);
    int8 q = convert_int8(convert_float8(a) * inverse);
    int8 rest = a - q * b;
    const int8 more = convert_int8(convert_float8(rest) * inverse);
    rest -= more * b;
    q += more;
    return q + (rest < 0) - (rest >= b);
}

/* Differences over two pixels, in 1/256 grey level per pixel; zero outside the image. */
static void differences(__global const ushort *gray, int x, int y, int width, int height, int stride, int base, int8 *dx, int8 *dy)
{
    const int8 column = x + (int8)(0, 1, 2, 3, 4, 5, 6, 7);
    __global const ushort *row = gray + (size_t)(y - base) * (size_t)stride + (size_t)(x + MARGIN);
    const ushort8 here = vload8(0, row);
    const ushort8 left = select(vload8(0, row - 1), here, convert_ushort8(column == 0));
    const ushort8 right = select(vload8(0, row + 1), here, convert_ushort8(column == width - 1));
    const ushort8 above = y > 0 ? vload8(0, row - stride) : here, below = y + 1 < height ? vload8(0, row + stride) : here;
    const int8 inside = column < width;
    *dx = (convert_int8(right) - convert_int8(left)) & inside;
    *dy = (convert_int8(below) - convert_int8(above)) & inside;
}

__kernel void gradient_norms(__global const ushort *gray, __global ushort8 *norms, int width, int height, int stride, int base,
                             int first, int last)
{
    const int x = GRADIENT_PIXELS * (int)get_global_id(0) - MARGIN, y = first + (int)get_global_id(1);
    if (x >= stride - MARGIN || y >= last)
        return;
    int8 dx = 0, dy = 0;
    if (x >= 0 && x < width && y >= 0 && y < height)
        differences(gray, x, y, width, height, stride, base, &dx, &dy);
    norms[((size_t)(y - base) * (size_t)stride + (size_t)(x + MARGIN)) / 8] = convert_ushort8(integer_sqrt(dx * dx + dy * dy));
}

/* Sums of the norms of five neighbours in a row; rows outside the image have none. */
static int8 row_sum(__global const ushort *norms, int x, int y, int height, int stride, int base)
{
    int8 sum = 0;
    if (y >= 0 && y < height) {
        __global const ushort *row = norms + (size_t)(y - base) * (size_t)stride + (size_t)(x + MARGIN);
        for (int column = -2; column <= 2; column++)
            sum += convert_int8(vload8(0, row + column));
    }
    return sum;
}

/* Numbers of pixels in the windows of a row. */
static int8 window_counts(int x, int y, int width, int height)
{
    const int8 column = x + (int8)(0, 1, 2, 3, 4, 5, 6, 7);
    const int rows = min(y + 2, height - 1) - max(y - 2, 0) + 1;
    /* vectors on both sides of min() and max(): Oclgrind 21 takes a scalar there for a vector */
    return rows * max(min(column + 2, (int8)(width - 1)) - max(column - 2, (int8)0) + 1, (int8)1);
}

/* Here a work item takes GRADIENT_ROWS such pieces, one below the other, so that they share the sums of rows. */
__kernel void gradient_normalise(__global const ushort *gray, __global const ushort *norms, __global short8 *gradient_x,
                                 __global short8 *gradient_y, int width, int height, int stride, int base, int first, int last,
                                 int epsilon)
{
    const int x = GRADIENT_PIXELS * (int)get_global_id(0) - MARGIN, top = first + GRADIENT_ROWS * (int)get_global_id(1);
    if (x >= stride - MARGIN || top >= last)
        return;
    const int inside = x >= 0 && x < width, rows = inside ? height : 0; /* beside the image all is zero */
    int8 sum_0 = row_sum(norms, x, top - 2, rows, stride, base), sum_1 = row_sum(norms, x, top - 1, rows, stride, base);
    int8 sum_2 = row_sum(norms, x, top, rows, stride, base), sum_3 = row_sum(norms, x, top + 1, rows, stride, base);
    for (int y = top; y < min(top + GRADIENT_ROWS, last); y++) {
        const size_t at = (size_t)(y - base) * (size_t)stride + (size_t)(x + MARGIN);
        const int8 sum_4 = row_sum(norms, x, y + 2, rows, stride, base);
        int8 dx = 0, dy = 0;
        if (y >= 0 && y < rows) {
            const int8 count = window_counts(x, y, width, height), sum = sum_0 + sum_1 + sum_2 + sum_3 + sum_4;
            const int8 least = (convert_int8(vload8(0, norms + at)) * count * GRADIENT_LIMIT) >> 8;
            const int8 scale = quotient(UNITS(count) << 16, max(sum + count * epsilon, least));
            differences(gray, x, y, width, height, stride, base, &dx, &dy);
            dx = (dx * scale + 32768) >> 16;
            dy = (dy * scale + 32768) >> 16;
        }
        gradient_x[at / 8] = convert_short8(dx);
        gradient_y[at / 8] = convert_short8(dy);
        sum_0 = sum_1;
        sum_1 = sum_2;
        sum_2 = sum_3;
        sum_3 = sum_4;
    }
}
