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
 * cameras interpolate two of three channels. A plane is smooth when pixels two apart, along x or along y, differ by more than
 * neighbours do in SMOOTH of all places or more where the one is not as the other. Of independent noise it is one half (of 20 rooms
 * with such noise, blur and edges .50 to .58, one of few colours .64), of 13 photographs .80 to .98. Places where both differ by a
 * grey level at most do not count: that is what channels rounded by themselves make of any colours, and more than all else in JPEG
 * of low quality (a corridor at quality 50: 69 junctions, with colours 472 on the borders of blocks; 69 since). Of colours without
 * noise only edges count, and those are smooth. */
#include "colour_plane.h"
#include "gray_level.h"
#include "watch.h"
#include "shared/pixels.h"

#include <stdlib.h>

#define SMOOTH 0.65
#define APART 4 /* rows: of each fourth one noise is looked at */

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

int32_t asj_channels_of(const asj_image *image, asj_channels *c)
{
    c->red = asj_red_of(image->format);
    if (c->red < 0)
        return 0;
    c->step = asj_pixel_size(image->format);
    c->first = image->data;
    c->width = image->width;
    c->height = image->height;
    c->stride = image->stride ? image->stride : (ptrdiff_t)image->width * c->step;
    return 1;
}

static int32_t row_has_colours(const uint8_t *pixel, int32_t width, int32_t step)
{
    for (int32_t x = 0; x < width; x++, pixel += step)
        if (pixel[0] != pixel[1] || pixel[1] != pixel[2])
            return 1;
    return 0;
}

static int32_t any_colours(const asj_channels *c, asj_watch *watch)
{
    for (int32_t y = 0; y < c->height && !asj_watch_stops(watch, NULL); y++)
        if (row_has_colours(c->first + y * c->stride, c->width, c->step))
            return 1;
    return 0;
}

asj_status asj_image_has_colours(asj_context *context, const asj_image *image, int32_t *has)
{
    asj_channels c;
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
    *has = asj_channels_of(image, &c) && any_colours(&c, &watch);
    return asj_watch_end(&watch);
}

/* How often pixels two apart differ by more than neighbours do, and how often by less. */
typedef struct tally {
    int64_t more, less;
} tally;

static void count(int32_t first, int32_t second, int32_t third, tally *sum)
{
    const int32_t near = abs(second - first), far = abs(third - first);
    if (near <= ASJ_GRAY_ONE && far <= ASJ_GRAY_ONE)
        return;
    sum->more += far > near;
    sum->less += far < near;
}

static int32_t is_smooth(const tally *sum)
{
    return (double)sum->more >= SMOOTH * (double)(sum->more + sum->less);
}

/* rows: room for three. */
static int32_t plane_is_smooth(const asj_channels *c, int32_t plane, uint16_t *rows, asj_watch *watch)
{
    uint16_t *const row[] = {rows, rows + c->width, rows + 2 * (ptrdiff_t)c->width};
    tally across = {0, 0}, down = {0, 0};
    for (int32_t y = 0; y + 2 < c->height && !asj_watch_stops(watch, NULL); y += APART) {
        for (int32_t k = 0; k < 3; k++)
            asj_colour_row(c->first + (y + k) * c->stride, c->width, c->step, c->red, NULL, plane, row[k]);
        for (int32_t x = 0; x + 2 < c->width; x++)
            count(row[0][x], row[0][x + 1], row[0][x + 2], &across);
        for (int32_t x = 0; x < c->width; x++)
            count(row[0][x], row[1][x], row[2][x], &down);
    }
    return is_smooth(&across) || is_smooth(&down);
}

asj_status asj_colour_planes_look(asj_context *context, const asj_image *image, asj_colour_planes *planes)
{
    asj_channels c;
    asj_watch watch;
    *planes = (asj_colour_planes){.count = 1};
    asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
    if (!asj_channels_of(image, &c) || !any_colours(&c, &watch))
        return asj_watch_end(&watch);
    uint16_t *rows = asj_allocate(&context->memory, (size_t)c.width, 3 * sizeof *rows);
    if (!rows)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %d pixels", (int)c.width);
    planes->count = ASJ_PLANES;
    for (int32_t plane = ASJ_PLANE_RED_GREEN; plane < ASJ_PLANES; plane++)
        planes->smooth[plane] = plane_is_smooth(&c, plane, rows, &watch);
    asj_release(&context->memory, rows);
    return asj_watch_end(&watch);
}
