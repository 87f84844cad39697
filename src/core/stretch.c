/* SPDX-License-Identifier: BSD-2-Clause */
/* Interpolation between the pixels around (bilinear).
 *
 * Pixel X of the copy is centred at u = (X + 1/2) w / W - 1/2 of the image: between pixel i = floor(u) and the next one, whose
 * weights are 1 - f and f with f = u - i in 1/256. Outside, the pixels of the border repeat. Sums of whole numbers, rounded once;
 * of floats, products that are exact in double precision. So the copy is the same on every machine and with any number of
 * threads. */
#include "image.h"
#include "stretch.h"
#include "watch.h"
#include "shared/pixels.h"

#include <math.h>
#include <string.h>

#define ONE 256
#define LEAST_PIXELS 16384 /* for a thread */

/* Between which two pixels a pixel of the copy lies. */
typedef struct tap {
    int32_t first, second; /* bytes from the row's start, or rows */
    uint32_t weight;       /* of the second, in 1/ONE */
} tap;

typedef struct job {
    const asj_image *image;
    ptrdiff_t stride;
    int32_t channels, sample; /* of a pixel, and bytes of a channel */
    int32_t width;            /* of the copy */
    const tap *columns, *rows;
    char *pixels;
    asj_watch *watch;
} job;

static void fill_taps(tap *taps, int32_t wanted, int32_t there, int32_t bytes)
{
    for (int32_t x = 0; x < wanted; x++) {
        const double u = (x + 0.5) * there / wanted - 0.5, f = u - floor(u);
        const int32_t i = (int32_t)floor(u), last = there - 1;
        taps[x].first = (i < 0 ? 0 : i) * bytes;
        taps[x].second = (i + 1 > last ? last : i + 1) * bytes;
        taps[x].weight = (uint32_t)floor(f * ONE + 0.5);
    }
}

static uint32_t sample_at(const char *from, int32_t bytes)
{
    uint16_t wide;
    if (bytes == 1)
        return *(const uint8_t *)from;
    memcpy(&wide, from, sizeof wide);
    return wide;
}

static void put_whole(const job *j, const char *upper, const char *lower, const tap *c, uint32_t down, char *to)
{
    const uint64_t right = c->weight, left = ONE - right, up = ONE - down;
    const uint64_t above = left * sample_at(upper + c->first, j->sample) + right * sample_at(upper + c->second, j->sample);
    const uint64_t below = left * sample_at(lower + c->first, j->sample) + right * sample_at(lower + c->second, j->sample);
    const uint64_t sum = (up * above + down * below + ONE * ONE / 2) / (ONE * ONE);
    const uint16_t wide = (uint16_t)sum;
    if (j->sample == 1)
        *(uint8_t *)to = (uint8_t)sum;
    else
        memcpy(to, &wide, sizeof wide);
}

static double float_at(const char *from)
{
    float value;
    memcpy(&value, from, sizeof value);
    return (double)value;
}

static void put_float(const char *upper, const char *lower, const tap *c, uint32_t down, char *to)
{
    const double right = (double)c->weight / ONE, left = 1 - right, below = (double)down / ONE, above = 1 - below;
    const float value = (float)(left * above * float_at(upper + c->first) + right * above * float_at(upper + c->second) +
                                (left * below * float_at(lower + c->first) + right * below * float_at(lower + c->second)));
    memcpy(to, &value, sizeof value);
}

static void stretch_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    const int32_t bytes = j->channels * j->sample;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++) {
        const tap *row = &j->rows[y];
        const char *upper = (const char *)j->image->data + row->first * j->stride;
        const char *lower = (const char *)j->image->data + row->second * j->stride;
        char *to = j->pixels + y * j->width * bytes;
        for (int32_t x = 0; x < j->width; x++)
            for (int32_t k = 0; k < j->channels; k++, to += j->sample) {
                const int32_t offset = k * j->sample;
                if (j->sample == (int32_t)sizeof(float))
                    put_float(upper + offset, lower + offset, &j->columns[x], row->weight, to);
                else
                    put_whole(j, upper + offset, lower + offset, &j->columns[x], row->weight, to);
            }
    }
}

/* Channels of a pixel and bytes of each. */
static void describe(job *j, int32_t format)
{
    j->sample = format == ASJ_FORMAT_GRAY16 ? 2 : format == ASJ_FORMAT_GRAY_FLOAT ? (int32_t)sizeof(float) : 1;
    j->channels = asj_pixel_size(format) / j->sample;
}

asj_status asj_stretch_image(asj_context *context, asj_memory *memory, const asj_image *image, int32_t width, int32_t height,
                             asj_image *stretched, void **pixels)
{
    job j = {.image = image, .width = width};
    asj_watch watch;
    describe(&j, image->format);
    const int32_t bytes = j.channels * j.sample;
    j.stride = image->stride ? image->stride : (ptrdiff_t)image->width * bytes;
    tap *columns = asj_allocate(memory, (size_t)width, sizeof *columns), *rows = asj_allocate(memory, (size_t)height, sizeof *rows);
    *pixels = asj_allocate(memory, (size_t)width * (size_t)height, (size_t)bytes);
    if (columns && rows && *pixels) {
        fill_taps(columns, width, image->width, bytes);
        fill_taps(rows, height, image->height, 1);
        j.columns = columns;
        j.rows = rows;
        j.pixels = *pixels;
        asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
        j.watch = &watch;
        asj_parallel(context, asj_threads_for(context, (int64_t)width * height, LEAST_PIXELS), height, 0, stretch_rows, &j);
        *stretched = (asj_image){*pixels, image->format, width, height, image->white, 0};
    }
    const asj_status status =
        columns && rows && *pixels ? asj_watch_end(&watch)
                                   : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for an image of %d x %d pixels", (int)width,
                                              (int)height);
    asj_release(memory, columns);
    asj_release(memory, rows);
    if (status != ASJ_OK) {
        asj_release(memory, *pixels);
        *pixels = NULL;
    }
    return status;
}
