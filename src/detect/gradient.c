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
 * g scale < 2^31 because |g| c <= 256 D / T. At the image border neighbours outside are replaced by the border pixel itself, which
 * the gray plane repeats there.
 * The window's sum is that of five column sums, which slide down the image, in two halves of 16 bits: the sum of the low bytes of
 * |g| and the sum of the high bytes.
 * ">>" of a negative number is the arithmetic shift on every compiler that we know; it is checked below at compile time. */
#include "gradient.h"
#include "core/threads.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define SIGMA_0 (ASJ_GRADIENT_SIGMA / 10000.0)
#define LEAST_PIXELS 32768 /* for a thread: about 40 us */
#define BANDS_PER_THREAD 4 /* so that a thread that comes late costs little; each band sums up four rows more than it needs */
#define LEAST_ROWS 32      /* of a band */
#define MOST_PIXELS (1 << 21) /* of a band: between two the caller may be asked whether to go on */

typedef char arithmetic_shift_is_needed[(-3 >> 1) == -2 ? 1 : -1];

/* Floor of the square root, for 0 <= s < 2^31. sqrtf() of the rounded float is off by one at most; the comparisons mend that on
 * any hardware. */
static inline int32_t integer_sqrt(int32_t s)
{
    int32_t root = (int32_t)sqrtf((float)s);
    root -= root * root > s;
    root += (root + 1) * (root + 1) <= s;
    return root;
}

/* floor(a / b) for whole numbers below 2^31: the quotient in double precision is within 2^-53 of itself of the true one, which is
 * at least 2^-31 of itself away from the next whole number unless it is one. */
static inline int32_t quotient(int32_t a, int32_t b)
{
    return (int32_t)((double)a / (double)b);
}

void asj_gradient_slide(const asj_gradient_row *row, uint16_t *norms, uint16_t *low, uint16_t *high)
{
    for (int32_t x = 0; x < row->width; x++) {
        const int32_t dx = row->gray[x + 1] - row->gray[x - 1], dy = row->below[x] - row->above[x];
        const uint16_t come = (uint16_t)integer_sqrt(dx * dx + dy * dy), leave = norms[x];
        norms[x] = come;
        low[x] = (uint16_t)(low[x] + (come & 255) - (leave & 255));
        high[x] = (uint16_t)(high[x] + (come >> 8) - (leave >> 8));
    }
}

asj_gradient_factors asj_gradient_set_factors(int32_t columns, int32_t rows, uint32_t epsilon)
{
    const uint32_t limit = (uint32_t)(256 / (SIGMA_0 * ASJ_GRADIENT_LIMIT) + 0.5), count = (uint32_t)(columns * rows);
    return (asj_gradient_factors){(uint32_t)(ASJ_GRADIENT_ONE / SIGMA_0 * count + 0.5) << 16, count * epsilon, count * limit};
}

/* Factors: those of the pixel's window. */
static inline void normalise(const asj_gradient_row *row, int32_t x, const asj_gradient_factors *factors, const uint16_t *norms,
                             const uint16_t *low, const uint16_t *high, int16_t *gx, int16_t *gy)
{
    const int32_t dx = row->gray[x + 1] - row->gray[x - 1], dy = row->below[x] - row->above[x];
    uint32_t denominator = factors->epsilon;
    for (int32_t i = -2; i <= 2; i++)
        denominator += low[x + i] + 256u * high[x + i];
    const uint32_t least = norms[x] * factors->limit >> 8;
    const int32_t scale = quotient((int32_t)factors->numerator, (int32_t)(denominator > least ? denominator : least));
    gx[x] = (int16_t)((dx * scale + 32768) >> 16);
    gy[x] = (int16_t)((dy * scale + 32768) >> 16);
}

void asj_gradient_pixel(const asj_gradient_row *row, int32_t x, const uint16_t *norms, const uint16_t *low, const uint16_t *high,
                        int16_t *gx, int16_t *gy)
{
    const int32_t columns = (x + 2 < row->width ? x + 2 : row->width - 1) - (x > 2 ? x - 2 : 0) + 1;
    const asj_gradient_factors factors = asj_gradient_set_factors(columns, row->window_rows, row->epsilon);
    normalise(row, x, &factors, norms, low, high, gx, gy);
}

void asj_gradient_normalise(const asj_gradient_row *row, const uint16_t *norms, const uint16_t *low, const uint16_t *high,
                            int16_t *gx, int16_t *gy)
{
    const asj_gradient_factors inside = asj_gradient_set_factors(5, row->window_rows, row->epsilon);
    for (int32_t x = 0; x < row->width && x < 2; x++)
        asj_gradient_pixel(row, x, norms, low, high, gx, gy);
    for (int32_t x = 2; x < row->width - 2; x++)
        normalise(row, x, &inside, norms, low, high, gx, gy);
    for (int32_t x = row->width - 2 > 2 ? row->width - 2 : 2; x < row->width; x++)
        asj_gradient_pixel(row, x, norms, low, high, gx, gy);
}

/* A row of the plane with its neighbours; those outside the image are the row itself. */
static void find_row(const asj_frame *frame, int32_t y, asj_gradient_row *row)
{
    row->gray = frame->gray + (ptrdiff_t)y * frame->stride;
    row->above = y > 0 ? row->gray - frame->stride : row->gray;
    row->below = y + 1 < frame->height ? row->gray + frame->stride : row->gray;
}

/* Elements of a row of norms or sums. */
static size_t row_length(int32_t width)
{
    return ((size_t)width + 31) / 32 * 32 + 2 * ASJ_GRADIENT_PAD;
}

/* Rows first .. last - 1. `scratch` holds gradient_scratch() zeros: the column sums in two halves, |g| of the last five rows, and a
 * row of the plane that is constant. */
static void gradient_band(const asj_gradient_ops *ops, const asj_frame *frame, uint32_t epsilon, int32_t first, int32_t last,
                          uint16_t *scratch)
{
    const size_t length = row_length(frame->width);
    uint16_t *low = scratch + ASJ_GRADIENT_PAD, *high = low + length, *norms = high + length, *zeros = norms + 5 * length;
    asj_gradient_row row = {zeros, zeros, zeros, frame->width, 0, epsilon};
    for (int32_t y = first > 2 ? first - 2 : 0; y < last + 2; y++) {
        uint16_t *ring = norms + (size_t)(y % 5) * length;
        if (y < frame->height)
            find_row(frame, y, &row);
        else
            row.above = row.gray = row.below = zeros;
        ops->slide(&row, ring, low, high);
        if (y < first + 2)
            continue;
        const int32_t centre = y - 2;
        row.window_rows = (y < frame->height ? y : frame->height - 1) - (centre > 2 ? centre - 2 : 0) + 1;
        find_row(frame, centre, &row);
        ops->normalise(&row, norms + (size_t)(centre % 5) * length, low, high,
                       frame->gradient_x + (ptrdiff_t)centre * frame->stride,
                       frame->gradient_y + (ptrdiff_t)centre * frame->stride);
    }
}

/* Elements. */
static size_t gradient_scratch(int32_t width)
{
    return 8 * row_length(width);
}

/* What a loop over bands of rows works on. */
typedef struct job {
    const asj_gradient_ops *ops;
    const asj_frame *frame;
    uint32_t epsilon;
    int32_t threads, bands;
    asj_scratch scratch;
    asj_watch *watch;
} job;

static int32_t first_row(const job *j, int64_t band)
{
    return (int32_t)(j->frame->height * band / j->bands);
}

static void do_bands(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t band = part->first; band < part->end && !asj_watch_stops(j->watch, part); band++) {
        uint16_t *scratch = asj_thread_scratch(&j->scratch, part);
        memset(scratch, 0, j->scratch.size * sizeof *scratch);
        gradient_band(j->ops, j->frame, j->epsilon, first_row(j, band), first_row(j, band + 1), scratch);
    }
}

/* ---- the paper's standardisation ----
 *
 * Each axis to zero mean and unit variance over the image, in whole numbers:
 * g' = ((g - mean) factor + 2^11) >> 12, factor = round(4096 x 1024 / sd), cut where its norm could exceed ASJ_GRADIENT_LIMIT: at
 * 2.45 standard deviations. The paper does not cut; sums of sectors are 16 bits here. */

/* Whole numbers: threads may add them up in any order. */
typedef struct moments {
    int64_t sum, squares;
} moments;

typedef struct axis {
    const job *j;
    int16_t *plane;
    int32_t shift;
    int64_t factor;
} axis;

/* In the thread's scratch, of which every row is longer. */
static moments *moments_of(const job *j, int32_t thread)
{
    return (moments *)(void *)(j->scratch.memory + (size_t)thread * j->scratch.size);
}

static void sum_bands(const void *data, const asj_part *part)
{
    const axis *a = data;
    const asj_frame *frame = a->j->frame;
    moments sums = *moments_of(a->j, part->thread);
    for (int64_t band = part->first; band < part->end && !asj_watch_stops(a->j->watch, part); band++)
        for (int32_t y = first_row(a->j, band); y < first_row(a->j, band + 1); y++)
            for (int32_t x = 0; x < frame->width; x++) {
                const int32_t g = a->plane[(ptrdiff_t)y * frame->stride + x];
                sums.sum += g;
                sums.squares += g * g;
            }
    *moments_of(a->j, part->thread) = sums;
}

static void scale_bands(const void *data, const asj_part *part)
{
    const axis *a = data;
    const asj_frame *frame = a->j->frame;
    const int32_t limit = (int32_t)(ASJ_GRADIENT_LIMIT * ASJ_GRADIENT_ONE * 0.7); /* each axis: norm below the limit */
    for (int64_t band = part->first; band < part->end && !asj_watch_stops(a->j->watch, part); band++)
        for (int32_t y = first_row(a->j, band); y < first_row(a->j, band + 1); y++)
            for (int32_t x = 0; x < frame->width; x++) {
                int16_t *g = a->plane + (ptrdiff_t)y * frame->stride + x;
                const int64_t value = ((int64_t)(*g - a->shift) * a->factor + 2048) >> 12;
                *g = (int16_t)(value > limit ? limit : value < -limit ? -limit : value);
            }
}

static void standardise(asj_context *context, const job *j, int16_t *plane)
{
    const double count = (double)j->frame->width * j->frame->height;
    axis a = {j, plane, 0, 0};
    moments all = {0, 0};
    for (int32_t t = 0; t < j->threads; t++)
        *moments_of(j, t) = (moments){0, 0};
    asj_parallel(context, j->threads, j->bands, 1, sum_bands, &a);
    for (int32_t t = 0; t < j->threads; t++) {
        all.sum += moments_of(j, t)->sum;
        all.squares += moments_of(j, t)->squares;
    }
    const double mean = (double)all.sum / count, variance = (double)all.squares / count - mean * mean;
    if (!(variance > 0) || j->watch->stopped)
        return;
    a.shift = (int32_t)lrint(mean);
    a.factor = llrint(4096 * ASJ_GRADIENT_ONE / sqrt(variance));
    asj_parallel(context, j->threads, j->bands, 1, scale_bands, &a);
}

asj_status asj_gradient(asj_context *context, asj_frame *frame, const asj_detect_options *options)
{
    const uint32_t epsilon = (uint32_t)lrint(256 * options->gradient_epsilon);
    const int32_t threads = asj_threads_for(context, (int64_t)frame->width * frame->height, LEAST_PIXELS);
    const int32_t many = BANDS_PER_THREAD * threads, few = threads == 1 || frame->height < LEAST_ROWS * many ? threads : many;
    const int32_t least = (int32_t)((int64_t)frame->width * frame->height / MOST_PIXELS), bands = few > least ? few : least;
    const size_t size = gradient_scratch(frame->width);
    asj_status status = asj_grow(&context->memory, &frame->rows, &frame->row_capacity, (size_t)threads * size, sizeof(uint16_t), 0);
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for the gradient's rows");
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
    const job j = {context->ops->gradient, frame, epsilon, threads, bands, {frame->rows, size}, &watch};
    asj_parallel(context, threads, bands, 1, do_bands, &j);
    if (options->standardise) {
        standardise(context, &j, frame->gradient_x);
        standardise(context, &j, frame->gradient_y);
    }
    return asj_watch_end(&watch);
}

const asj_gradient_ops asj_gradient_reference = {
    .planes = asj_gradient, .slide = asj_gradient_slide, .normalise = asj_gradient_normalise};
