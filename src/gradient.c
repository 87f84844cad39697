/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 1: normalised gradient.
 *
 *     g  = ((I(x+1,y) - I(x-1,y)) / 2, (I(x,y+1) - I(x,y-1)) / 2)        grey levels per pixel
 *     n5 = mean of |g| over the 5x5 window around the pixel, clipped at the border
 *     g~ = g / (max(n5 + epsilon, |g| / (sigma_0 L)) sigma_0)             sigma_0 = 0.7825, L = 3.5
 *
 * Source: the paper takes the normalised gradient from the isotropic detector (ACJ): division by the local mean norm. Under white
 * noise g~ then has independent components of unit variance, so that |g~| is the Rayleigh variable of the null model ("Null
 * Hypothesis and Distribution"). sigma_0 is the measured standard deviation of g_x / n5 in white noise for these very differences.
 *
 * Departures:
 *   - epsilon keeps flat surfaces flat: without it sensor and compression noise on a wall is blown up to unit strength.
 *   - one fixed scale for both axes. The paper gives each axis zero mean and unit variance over the image (option `standardise`
 *     restores it), which makes strengths depend on picture content and bends orientations.
 *   - L: one pixel's norm is cut at L times the local mean. White noise exceeds it once in 500 pixels (Rayleigh tail) and clean
 *     edges do not reach it; it bounds the sum over a sector, so that 16-bit arithmetic cannot overflow (sector.c).
 *
 * Everything is done in whole numbers, so that every back end gives the same bits. Gray levels come in 1/128, hence differences
 * over two pixels in 1/256 grey level per pixel; |g| is the exact integer square root. With S the window's sum of |g| over c pixels
 * and D = max(S + c round(256 epsilon), (|g| c T) >> 8), T = round(256 / (sigma_0 L)),
 *     scale = floor(65536 C_c / D),  C_c = round(1024 c / sigma_0) < 32768,     g~ = (g scale + 32768) >> 16     in 1/1024.
 * g scale < 2^31 because |g| c <= 256 D / T. At the image border neighbours outside are replaced by the border pixel itself.
 * ">>" of a negative number is the arithmetic shift on every compiler that we know; asj_gradient() checks it at compile time. */
#include "gradient.h"

#include <math.h>
#include <string.h>

#define SIGMA_0 0.7825

typedef char arithmetic_shift_is_needed[(-3 >> 1) == -2 ? 1 : -1];

typedef struct rows {
    uint16_t *norms[5]; /* |g| of the last five rows, in 1/256, at [2 .. width + 1], zeros at both ends */
    uint32_t *sums;     /* column sums of those five rows, same layout */
} rows;

/* Floor of the square root, for 0 <= s < 2^31. sqrtf() of the rounded float is off by one at most; the comparisons mend that on
 * any hardware. */
static inline int32_t integer_sqrt(int32_t s)
{
    int32_t root = (int32_t)sqrtf((float)s);
    root -= root * root > s;
    root += (root + 1) * (root + 1) <= s;
    return root;
}

static void difference_row(const asj_frame *frame, int32_t y, int32_t *restrict dx, int32_t *restrict dy)
{
    const int32_t width = frame->width;
    const uint16_t *row = frame->gray + (ptrdiff_t)y * frame->stride;
    const uint16_t *above = y > 0 ? row - frame->stride : row;
    const uint16_t *below = y + 1 < frame->height ? row + frame->stride : row;
    for (int32_t x = 1; x + 1 < width; x++)
        dx[x] = row[x + 1] - row[x - 1];
    dx[0] = row[width > 1 ? 1 : 0] - row[0];
    dx[width - 1] = row[width - 1] - row[width > 1 ? width - 2 : 0];
    for (int32_t x = 0; x < width; x++)
        dy[x] = below[x] - above[x];
}

static void norm_row(const asj_frame *frame, int32_t y, int32_t *dx, int32_t *dy, uint16_t *norm)
{
    difference_row(frame, y, dx, dy);
    for (int32_t x = 0; x < frame->width; x++)
        norm[x + 2] = (uint16_t)integer_sqrt(dx[x] * dx[x] + dy[x] * dy[x]);
}

/* floor(a / b) for whole numbers below 2^32: the quotient in double precision is within 2^-53 of itself of the true one, which is
 * at least 2^-32 of itself away from the next whole number unless it is one. */
static inline uint32_t quotient(uint32_t a, uint32_t b)
{
    return (uint32_t)((double)a / (double)b);
}

static void normalise_row(const asj_frame *frame, int32_t y, const rows *window, uint32_t epsilon,
                          const int32_t *dx, const int32_t *dy)
{
    const int32_t width = frame->width, height = frame->height;
    const uint32_t window_rows = (uint32_t)((y + 2 < height ? y + 2 : height - 1) - (y > 2 ? y - 2 : 0) + 1);
    const uint32_t limit = (uint32_t)(256 / (SIGMA_0 * ASJ_GRADIENT_LIMIT) + 0.5);
    const uint16_t *norm = window->norms[y % 5];
    int16_t *gx = frame->gradient_x + (ptrdiff_t)y * frame->stride;
    int16_t *gy = frame->gradient_y + (ptrdiff_t)y * frame->stride;
    for (int32_t x = 0; x < width; x++) {
        const uint32_t *sum = window->sums + x;
        uint32_t columns = (uint32_t)((x + 2 < width ? x + 2 : width - 1) - (x > 2 ? x - 2 : 0) + 1);
        uint32_t count = columns * window_rows;
        uint32_t numerator = (uint32_t)(ASJ_GRADIENT_ONE / SIGMA_0 * count + 0.5) << 16;
        uint32_t denominator = sum[0] + sum[1] + sum[2] + sum[3] + sum[4] + count * epsilon;
        uint32_t least = (norm[x + 2] * count * limit) >> 8;
        int32_t scale = (int32_t)quotient(numerator, denominator > least ? denominator : least);
        gx[x] = (int16_t)((dx[x] * scale + 32768) >> 16);
        gy[x] = (int16_t)((dy[x] * scale + 32768) >> 16);
    }
}

/* Adds |g| of row y to the window and takes that of row y - 5 out; rows outside the image count as zero. */
static void slide(const asj_frame *frame, int32_t y, rows *window, int32_t *dx, int32_t *dy)
{
    uint16_t *norm = window->norms[(y + 5) % 5];
    for (int32_t x = 2; x < frame->width + 2; x++)
        window->sums[x] -= norm[x];
    if (y < frame->height)
        norm_row(frame, y, dx, dy, norm);
    else
        memset(norm + 2, 0, (size_t)frame->width * sizeof *norm);
    for (int32_t x = 2; x < frame->width + 2; x++)
        window->sums[x] += norm[x];
}

/* Rows first .. last - 1. `scratch` has room for gradient_scratch() bytes. */
static void gradient_band(const asj_frame *frame, uint32_t epsilon, int32_t first, int32_t last, void *scratch)
{
    const size_t length = (size_t)frame->width + 4;
    rows window;
    window.sums = scratch;
    int32_t *dx = (int32_t *)(window.sums + length), *dy = dx + length;
    for (int i = 0; i < 5; i++)
        window.norms[i] = (uint16_t *)(dy + length) + (size_t)i * length;
    memset(window.sums, 0, length * sizeof *window.sums);
    memset(window.norms[0], 0, 5 * length * sizeof *window.norms[0]);
    for (int32_t y = first > 2 ? first - 2 : 0; y < first + 2; y++)
        slide(frame, y, &window, dx, dy);
    for (int32_t y = first; y < last; y++) {
        slide(frame, y + 2, &window, dx, dy);
        difference_row(frame, y, dx, dy);
        normalise_row(frame, y, &window, epsilon, dx, dy);
    }
}

static size_t gradient_scratch(int32_t width)
{
    return (3 * sizeof(uint32_t) + 5 * sizeof(uint16_t)) * ((size_t)width + 4);
}

/* The paper's standardisation: each axis to zero mean and unit variance over the image, in whole numbers:
 * g' = ((g - mean) factor + 2^11) >> 12, factor = round(4096 x 1024 / sd), cut to 16 bits. */
static void standardise(const asj_frame *frame, int16_t *plane)
{
    int64_t sum = 0, squares = 0, count = (int64_t)frame->width * frame->height;
    for (int32_t y = 0; y < frame->height; y++)
        for (int32_t x = 0; x < frame->width; x++) {
            int32_t g = plane[(ptrdiff_t)y * frame->stride + x];
            sum += g;
            squares += g * g;
        }
    double mean = (double)sum / (double)count;
    double variance = (double)squares / (double)count - mean * mean;
    if (!(variance > 0))
        return;
    const int32_t shift = (int32_t)lrint(mean);
    const int64_t factor = llrint(4096 * ASJ_GRADIENT_ONE / sqrt(variance));
    const int32_t limit = (int32_t)(ASJ_GRADIENT_LIMIT * ASJ_GRADIENT_ONE * 0.7); /* each axis: norm below the limit */
    for (int32_t y = 0; y < frame->height; y++)
        for (int32_t x = 0; x < frame->width; x++) {
            int16_t *g = plane + (ptrdiff_t)y * frame->stride + x;
            int64_t value = ((int64_t)(*g - shift) * factor + 2048) >> 12;
            *g = (int16_t)(value > limit ? limit : value < -limit ? -limit : value);
        }
}

asj_status asj_gradient(asj_context *context, asj_frame *frame, const asj_detect_options *options)
{
    const uint32_t epsilon = (uint32_t)lrint(256 * options->gradient_epsilon);
    const int32_t threads = context->threads;
    const size_t size = (gradient_scratch(frame->width) + ASJ_ALIGNMENT - 1) / ASJ_ALIGNMENT * ASJ_ALIGNMENT;
    char *scratch = asj_allocate(&context->memory, (size_t)threads, size);
    if (!scratch)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the gradient's rows");
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(static)
#endif
    for (int32_t band = 0; band < threads; band++) {
        int32_t first = (int32_t)((int64_t)frame->height * band / threads);
        int32_t last = (int32_t)((int64_t)frame->height * (band + 1) / threads);
        if (first < last)
            gradient_band(frame, epsilon, first, last, scratch + (size_t)band * size);
    }
    asj_release(&context->memory, scratch);
    if (options->standardise) {
        standardise(frame, frame->gradient_x);
        standardise(frame, frame->gradient_y);
    }
    return ASJ_OK;
}

static inline int32_t clamp(int32_t value, int32_t last)
{
    return value < 0 ? 0 : value > last ? last : value;
}

/* At x0 + fx, y0 + fy, from the rows y0 - 1 .. y0 + 2 and the columns x0 - 1 .. x0 + 2: central differences at the four pixels
 * around, bilinear, then from 1/128 to grey levels. */
static inline void sample(const uint16_t *const row[4], const int32_t column[4], double fx, double fy, double *gx, double *gy)
{
#define I(i, j) row[i][column[j]]
    double top = (I(1, 2) - I(1, 0)) * (1 - fx) + (I(1, 3) - I(1, 1)) * fx;
    double low = (I(2, 2) - I(2, 0)) * (1 - fx) + (I(2, 3) - I(2, 1)) * fx;
    *gx = (top * (1 - fy) + low * fy) * (1.0 / (2 * ASJ_GRAY_ONE));
    top = (I(2, 1) - I(0, 1)) * (1 - fx) + (I(2, 2) - I(0, 2)) * fx;
    low = (I(3, 1) - I(1, 1)) * (1 - fx) + (I(3, 2) - I(1, 2)) * fx;
    *gy = (top * (1 - fy) + low * fy) * (1.0 / (2 * ASJ_GRAY_ONE));
#undef I
}

static void sample_at_border(const asj_frame *frame, double x, double y, double *gx, double *gy)
{
    const int32_t right = frame->width - 1, bottom = frame->height - 1;
    x = x < 0 ? 0 : x > right ? right : x;
    y = y < 0 ? 0 : y > bottom ? bottom : y;
    int32_t x0 = (int32_t)x, y0 = (int32_t)y;
    const int32_t column[4] = {clamp(x0 - 1, right), x0, clamp(x0 + 1, right), clamp(x0 + 2, right)};
    const uint16_t *row[4];
    for (int i = 0; i < 4; i++)
        row[i] = frame->gray + (ptrdiff_t)clamp(y0 - 1 + i, bottom) * frame->stride;
    sample(row, column, x - x0, y - y0, gx, gy);
}

void asj_gradient_sample(const asj_frame *frame, double x, double y, double *gx, double *gy)
{
    static const int32_t column[4] = {-1, 0, 1, 2};
    if (!(x >= 1 && y >= 1 && x < frame->width - 2 && y < frame->height - 2)) {
        sample_at_border(frame, x, y, gx, gy);
        return;
    }
    const int32_t x0 = (int32_t)x, y0 = (int32_t)y;
    const uint16_t *middle = frame->gray + y0 * frame->stride + x0;
    const uint16_t *const row[4] = {middle - frame->stride, middle, middle + frame->stride, middle + 2 * frame->stride};
    sample(row, column, x - x0, y - y0, gx, gy);
}
