/* SPDX-License-Identifier: BSD-2-Clause */
/* The level-line field of an image.
 *
 * Source: von Gioi, Jakubowicz, Morel, Randall, "LSD: A fast line segment detector with a false detection control", PAMI 32(4),
 * 2010, sections 2.1 to 2.4:
 *   - the image is reduced to 0.8 of its size by a Gaussian of standard deviation 0.6 / 0.8 px, against stairs and noise;
 *   - gradient on 2 x 2 pixels,  gx = (i(x+1,y) + i(x+1,y+1) - i(x,y) - i(x,y+1)) / 2,
 *                                gy = (i(x,y+1) + i(x+1,y+1) - i(x,y) - i(x+1,y)) / 2,
 *     level-line angle  atan(gx / -gy), here the unit vector (-gy, gx) / |g|;
 *   - rounding grey levels to whole numbers errs by q = 2 at most, hence the level line by asin(q / |g|): where that exceeds the
 *     angle tolerance,  |g| <= q / sin(22.5 deg),  no level line is defined;
 *   - samples in order of |g|, in 1024 classes.
 *
 * Pixels are areas: working pixel i covers the image's (i .. i + 1) / 0.8 - 1/2, so its centre is (i + 1/2) / 0.8 - 1/2. Samples
 * stand half a working pixel further (asj_levels_place()). Outside the image its border pixels repeat.
 *
 * The Gaussian's taps are whole numbers in 1/4096 that sum to one; sums of at most 4096 x 255 x 128 fit 32 bits. Factors are handed
 * to compilers as signed 16-bit numbers, which they multiply several at once: no grey value is above 255 x 128. */
#include "line_segments_levels.h"
#include "core/watch.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define PHASES 4           /* (i + 1/2) / 0.8 - 1/2 has four fractions */
#define REACH 3            /* taps to either side of the pixel before the centre, and one more */
#define TAPS (2 * REACH + 2)
#define ONE 4096
#define BLUR (0.6 / ASJ_LEVELS_SCALE) /* px */
#define QUANTISATION 2     /* grey levels */
#define SINE 0.3826834323650898 /* of 22.5 degrees */
#define CLASSES 1024
#define ROWS 32            /* in a part of the loop: one more is reduced for each */

double asj_levels_place(double value)
{
    return (value + 1) / ASJ_LEVELS_SCALE - 0.5;
}

/* The pixel at or before the centre of working pixel i, and how far it is: (5 i + 5/2 - 2) / 4 = (10 i + 1) / 8. */
static int32_t pixel_before(int32_t i, double *rest)
{
    const int32_t eighths = 10 * i + 1;
    *rest = eighths % 8 / 8.0;
    return eighths / 8;
}

static void make_taps(int16_t taps[PHASES][TAPS])
{
    for (int32_t phase = 0; phase < PHASES; phase++) {
        double weights[TAPS], total = 0, rest;
        int32_t sum = 0;
        pixel_before(phase, &rest);
        for (int32_t k = 0; k < TAPS; k++) {
            const double d = (k - REACH - rest) / BLUR;
            weights[k] = exp(-0.5 * d * d);
            total += weights[k];
        }
        for (int32_t k = 0; k < TAPS; k++) {
            taps[phase][k] = (int16_t)(ONE * weights[k] / total + 0.5);
            sum += taps[phase][k];
        }
        taps[phase][REACH] = (int16_t)(taps[phase][REACH] + ONE - sum);
    }
}

static int32_t inside(int32_t i, int32_t size)
{
    return i < 0 ? 0 : i < size ? i : size - 1;
}

static uint16_t weighted(const int16_t taps[TAPS], const uint16_t *values)
{
    int32_t sum = ONE / 2;
    for (int32_t k = 0; k < TAPS; k++)
        sum += taps[k] * (int16_t)values[k];
    return (uint16_t)(sum / ONE);
}

static void weigh_columns(const asj_frame *frame, int32_t top, const int16_t taps[TAPS], uint16_t *restrict column)
{
    const uint16_t *rows[TAPS];
    for (int32_t k = 0; k < TAPS; k++)
        rows[k] = frame->gray + inside(top + k, frame->height) * frame->stride;
    for (int32_t x = 0; x < frame->width; x++) {
        int32_t sum = ONE / 2;
        for (int32_t k = 0; k < TAPS; k++)
            sum += taps[k] * (int16_t)rows[k][x];
        column[x] = (uint16_t)(sum / ONE);
    }
}

/* One row of the reduced image: down the columns first, then along the row. */
static void reduce_row(const asj_frame *frame, int32_t y, int32_t width, const int16_t (*taps)[TAPS], uint16_t *column,
                       uint16_t *out)
{
    double rest;
    weigh_columns(frame, pixel_before(y, &rest) - REACH, taps[y % PHASES], column);
    for (int32_t x = 0; x < width; x++) {
        const int32_t left = pixel_before(x, &rest) - REACH;
        uint16_t values[TAPS];
        if (left >= 0 && left + TAPS <= frame->width) {
            out[x] = weighted(taps[x % PHASES], column + left);
            continue;
        }
        for (int32_t k = 0; k < TAPS; k++)
            values[k] = column[inside(left + k, frame->width)];
        out[x] = weighted(taps[x % PHASES], values);
    }
}

/* The samples between two rows of the reduced image. */
static void level_row(const uint16_t *above, const uint16_t *below, int32_t width, asj_unit_vector *direction, float *norm)
{
    const float unit = 0.5f / ASJ_GRAY_ONE, least = (float)(QUANTISATION / SINE);
    for (int32_t x = 0; x < width; x++) {
        const int32_t falling = below[x + 1] - above[x], rising = above[x + 1] - below[x];
        const float gx = (float)(falling + rising) * unit, gy = (float)(falling - rising) * unit;
        const float size = sqrtf(gx * gx + gy * gy);
        const int is = size > least;
        norm[x] = is ? size : 0;
        direction[x] = is ? (asj_unit_vector){-gy / size, gx / size} : (asj_unit_vector){0, 0};
    }
}

/* Steepest first; in a class from top to bottom, from left to right. One thread: what comes next, segment after segment, takes far
 * longer and is of one, too. */
static asj_status sort_samples(asj_levels *levels, asj_watch *watch)
{
    int32_t starts[CLASSES + 1] = {0};
    float most = 0;
    for (int32_t y = 0; y < levels->height && !asj_watch_stops(watch, NULL); y++) {
        const float *norm = levels->norm + (size_t)y * (size_t)levels->width;
        for (int32_t x = 0; x < levels->width; x++)
            most = norm[x] > most ? norm[x] : most;
    }
    const float classes = most > 0 ? (CLASSES - 1) / most : 0;
    for (int32_t y = 0; y < levels->height && !asj_watch_stops(watch, NULL); y++) {
        const float *norm = levels->norm + (size_t)y * (size_t)levels->width;
        for (int32_t x = 0; x < levels->width; x++)
            if (norm[x] > 0)
                starts[CLASSES - (int32_t)(norm[x] * classes)]++;
    }
    for (int32_t c = 0; c < CLASSES; c++)
        starts[c + 1] += starts[c];
    levels->order_count = starts[CLASSES];
    for (int32_t y = 0; y < levels->height && !asj_watch_stops(watch, NULL); y++) {
        const float *norm = levels->norm + (size_t)y * (size_t)levels->width;
        for (int32_t x = 0; x < levels->width; x++)
            if (norm[x] > 0)
                levels->order[starts[CLASSES - 1 - (int32_t)(norm[x] * classes)]++] = y * levels->width + x;
    }
    return asj_watch_end(watch);
}

/* What a loop over rows works on. */
typedef struct job {
    const asj_frame *frame;
    const asj_levels *levels;
    asj_watch *watch;
    int16_t taps[PHASES][TAPS];
    uint16_t *scratch; /* three rows for each thread */
} job;

static void fill_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_levels *levels = j->levels;
    const ptrdiff_t row = j->frame->width;
    uint16_t *above = j->scratch + 3 * row * part->thread, *below = above + row, *const column = below + row;
    reduce_row(j->frame, (int32_t)part->first, levels->width + 1, j->taps, column, above);
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++) {
        const size_t at = (size_t)y * (size_t)levels->width;
        reduce_row(j->frame, (int32_t)y + 1, levels->width + 1, j->taps, column, below);
        level_row(above, below, levels->width, levels->direction + at, levels->norm + at);
        uint16_t *swap = above;
        above = below;
        below = swap;
    }
}

asj_status asj_levels_create(asj_context *context, const asj_frame *frame, int32_t stage, asj_levels *levels)
{
    asj_memory *memory = &context->memory;
    memset(levels, 0, sizeof *levels);
    levels->width = (int32_t)(frame->width * 4LL / 5) - 1;
    levels->height = (int32_t)(frame->height * 4LL / 5) - 1;
    if (levels->width < 1 || levels->height < 1) {
        levels->width = levels->height = 0;
        return ASJ_OK;
    }
    const size_t count = (size_t)levels->width * (size_t)levels->height, row = (size_t)frame->width;
    uint16_t *scratch = asj_allocate(memory, 3 * row * (size_t)context->threads, sizeof *scratch);
    levels->direction = asj_allocate(memory, count, sizeof *levels->direction);
    levels->norm = asj_allocate(memory, count, sizeof *levels->norm);
    levels->order = asj_allocate(memory, count, sizeof *levels->order);
    if (scratch && levels->direction && levels->norm && levels->order) {
        asj_watch watch;
        job j = {.frame = frame, .levels = levels, .watch = &watch, .scratch = scratch};
        make_taps(j.taps);
        asj_watch_start(&watch, context, stage);
        asj_parallel(context, context->threads, levels->height, ROWS, fill_some, &j);
        asj_release(memory, scratch);
        const asj_status status = sort_samples(levels, &watch); /* nothing, once it is to stop */
        if (status != ASJ_OK)
            asj_levels_free(memory, levels);
        return status;
    }
    asj_release(memory, scratch);
    asj_levels_free(memory, levels);
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the level lines of %d x %d pixels", (int)frame->width,
                    (int)frame->height);
}

void asj_levels_free(asj_memory *memory, asj_levels *levels)
{
    asj_release(memory, levels->direction);
    asj_release(memory, levels->norm);
    asj_release(memory, levels->order);
    memset(levels, 0, sizeof *levels);
}
