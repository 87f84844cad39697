/* SPDX-License-Identifier: BSD-2-Clause */
/* Two planes beside the luma, of opponent colours: what luma does not tell apart differs in one of them.
 *
 *     red - green     127.5 + (R - G) / 2
 *     blue - yellow   127.5 + (B - (R + G) / 2) / 2
 *
 * in grey levels, 0 .. 255. (The axes of opponent colour vision, Hering 1878, without the luma's weights: a grey pixel is in the
 * middle of both.) Whole numbers in 1/ASJ_GRAY_ONE of a grey level, rounded down once: the same on every machine.
 *
 * Noise. The null model of the detector takes the noise of neighbouring pixels for independent. That of colour planes seldom is:
 * JPEG and video keep colours at half the size, smoothed, in blocks, whose borders are straight and meet at right angles; and
 * cameras interpolate two of three channels. A plane is smooth when pixels two apart differ by more than neighbours do in more than
 * SMOOTH of all places where the one is not as the other. Of independent noise it is one half (of 20 rooms with such noise, blur
 * and edges .50 to .54, one of few colours .60), of ten photographs .77 to .95. Of flat colours without noise only edges count, and
 * those are smooth. */
#include "colour_plane.h"
#include "gray_level.h"
#include "shared/pixels.h"

#include <stdlib.h>

#define SMOOTH 0.65
#define ROWS 4 /* each fourth row is looked at */

static int32_t level(const uint16_t *levels, uint8_t sample)
{
    return levels ? levels[sample] : sample * ASJ_GRAY_ONE;
}

void asj_colour_row(const uint8_t *pixel, int32_t width, int32_t step, int32_t red, const uint16_t *levels, int32_t plane,
                    uint16_t *to)
{
    for (int32_t x = 0; x < width; x++, pixel += step) {
        const int32_t r = level(levels, pixel[red]), g = level(levels, pixel[1]), b = level(levels, pixel[2 - red]);
        to[x] = (uint16_t)(plane == ASJ_PLANE_RED_GREEN ? (ASJ_GRAY_MAX + r - g) / 2 : (2 * ASJ_GRAY_MAX + 2 * b - r - g) / 4);
    }
}

static int32_t has_colours(const uint8_t *pixel, int32_t width, int32_t step)
{
    for (int32_t x = 0; x < width; x++, pixel += step)
        if (pixel[0] != pixel[1] || pixel[1] != pixel[2])
            return 1;
    return 0;
}

/* How often pixels two apart differ by more than neighbours do, and how often by less. */
typedef struct tally {
    int64_t more, less;
} tally;

static void count(const uint16_t *row, int32_t width, tally *sum)
{
    for (int32_t x = 0; x + 2 < width; x++) {
        const int32_t near = abs(row[x + 1] - row[x]), far = abs(row[x + 2] - row[x]);
        sum->more += far > near;
        sum->less += far < near;
    }
}

asj_status asj_colour_planes_look(asj_context *context, const asj_image *image, asj_colour_planes *planes)
{
    *planes = (asj_colour_planes){.count = 1};
    if (image->format < ASJ_FORMAT_RGB8 || image->format > ASJ_FORMAT_BGRA8)
        return ASJ_OK;
    const int32_t step = asj_pixel_size(image->format), width = image->width;
    const int32_t red = image->format == ASJ_FORMAT_RGB8 || image->format == ASJ_FORMAT_RGBA8 ? 0 : 2;
    const ptrdiff_t stride = image->stride ? image->stride : (ptrdiff_t)width * step;
    const uint8_t *first = image->data;
    for (int32_t y = 0; y < image->height && planes->count == 1; y++)
        planes->count = has_colours(first + y * stride, width, step) ? ASJ_PLANES : 1;
    if (planes->count == 1)
        return ASJ_OK;
    uint16_t *row = asj_allocate(&context->memory, (size_t)width, sizeof *row);
    if (!row)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %d pixels", (int)width);
    for (int32_t plane = ASJ_PLANE_RED_GREEN; plane < ASJ_PLANES; plane++) {
        tally sum = {0, 0};
        for (int32_t y = 0; y < image->height; y += ROWS) {
            asj_colour_row(first + y * stride, width, step, red, NULL, plane, row);
            count(row, width, &sum);
        }
        planes->smooth[plane] = (double)sum.more > SMOOTH * (double)(sum.more + sum.less);
    }
    asj_release(&context->memory, row);
    return ASJ_OK;
}
