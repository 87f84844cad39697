/* SPDX-License-Identifier: BSD-2-Clause */
/* The region decides twice. Candidates (step 2) that lie too far from it for any junction to move into it are not tested: that is
 * what saves time. Of the junctions that were found those outside are dropped at the end: that is exact. In between the image is
 * what it is without a region: what lies outside still speaks for or against a junction inside, and branches reach as far.
 *
 * A junction lies, in px of its octave, at most max_move and what its location may move (locate.c) from its candidate (validate.c:
 * has_moved_far()); so candidates stay up to `reach` = that, rounded up, and one more around the region. Pixel (i, j) of octave o
 * stands for what lies between i 2^o and (i + 1) 2^o in the image, pixel k from k to k + 1; j likewise. */
#include "region.h"
#include "core/reserved.h"
#include "core/watch.h"
#include "locate.h"

#include <math.h>
#include <string.h>

/* First pixel and the one after the last, along x and along y. */
typedef struct rectangle {
    int32_t left, right, top, bottom;
} rectangle;

static rectangle rectangle_of(const asj_image *image, const asj_region *region)
{
    if (region->width == 0)
        return (rectangle){0, image->width, 0, image->height};
    return (rectangle){region->x, region->x + region->width, region->y, region->y + region->height};
}

static const uint8_t *mask_row(const asj_image *mask, int32_t y)
{
    return (const uint8_t *)mask->data + y * (mask->stride ? mask->stride : (ptrdiff_t)mask->width);
}

static int lies_within(int32_t first, int32_t length, int32_t whole)
{
    return first >= 0 && length > 0 && first < whole && length <= whole - first;
}

asj_status asj_region_check(asj_context *context, const asj_image *image, const asj_region *region)
{
    if (!region)
        return ASJ_OK;
    if (!asj_is_zero(region->reserved, sizeof region->reserved))
        return asj_fail(context, ASJ_ERROR_OPTION, ASJ_RESERVED_MESSAGE);
    const int everywhere = region->x == 0 && region->y == 0 && region->width == 0 && region->height == 0;
    if (!everywhere && (!lies_within(region->x, region->width, image->width) ||
                        !lies_within(region->y, region->height, image->height)))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "a region of %d x %d pixels at (%d, %d) is not within an image of %d x %d",
                        (int)region->width, (int)region->height, (int)region->x, (int)region->y, (int)image->width,
                        (int)image->height);
    const asj_image *mask = region->mask;
    if (!mask)
        return ASJ_OK;
    if (mask->format != ASJ_FORMAT_GRAY8)
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the mask is not gray8");
    if (mask->width != image->width || mask->height != image->height)
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "a mask of %d x %d pixels for an image of %d x %d", (int)mask->width,
                        (int)mask->height, (int)image->width, (int)image->height);
    if (!mask->data)
        return asj_fail(context, ASJ_ERROR_IMAGE, "the mask has no data");
    asj_image levels = *mask;
    levels.white = 0; /* as the format has it */
    return asj_image_check(context, &levels);
}

static int32_t reach_of(const asj_detection_run *run)
{
    return (int32_t)ceil(run->options->max_move + asj_locate_farthest_move(run->options)) + 1;
}

/* Pixels of the octave whose neighbourhood meets first .. end - 1 of the image. */
static void octave_range(const asj_detection_run *run, int32_t first, int32_t end, int32_t size, int32_t *from, int32_t *to)
{
    const int32_t reach = reach_of(run);
    const double scale = asj_octave_scale(run->octave);
    *from = (int32_t)floor(first / scale) - reach;
    *to = (int32_t)ceil(end / scale) + reach;
    *from = *from > 0 ? *from : 0;
    *to = *to < size ? *to : size;
    *from = *from < *to ? *from : *to; /* the last pixel of the image may belong to no pixel of the octave */
}

void asj_region_rows(const asj_detection_run *run, int32_t *top, int32_t *bottom)
{
    *top = 0;
    *bottom = run->frame->height;
    if (run->region) {
        const rectangle r = rectangle_of(run->image, run->region);
        octave_range(run, r.top, r.bottom, run->frame->height, top, bottom);
    }
}

/* Rows first .. end - 1 of the mask, which go down it: how many of them allow each column. */
typedef struct band {
    int32_t first, end;
    uint16_t *count;
} band;

static void move_band(const asj_image *mask, int32_t first, int32_t end, band *b)
{
    for (; b->end < end; b->end++) {
        const uint8_t *row = mask_row(mask, b->end);
        for (int32_t x = 0; x < mask->width; x++)
            b->count[x] = (uint16_t)(b->count[x] + (row[x] != 0));
    }
    for (; b->first < first; b->first++) {
        const uint8_t *row = mask_row(mask, b->first);
        for (int32_t x = 0; x < mask->width; x++)
            b->count[x] = (uint16_t)(b->count[x] - (row[x] != 0));
    }
}

/* The whole number at or below, or at or above, a place, from 0 to `size`. */
static inline int32_t floor_within(double at, int32_t size)
{
    return at <= 0 ? 0 : at >= size ? size : (int32_t)at;
}

static inline int32_t ceil_within(double at, int32_t size)
{
    const int32_t below = floor_within(at, size);
    return below + (below < size && at > below);
}

static void clear_bit(uint16_t *bits, int32_t x)
{
    bits[x / ASJ_LANES] = (uint16_t)(bits[x / ASJ_LANES] & ~(1u << x % ASJ_LANES));
}

/* Pixels *first .. *end - 1 of the image, `size` in all, that lie around pixel i of the octave. */
static void image_range(const asj_detection_run *run, int32_t i, int32_t size, int32_t *first, int32_t *end)
{
    const int32_t reach = reach_of(run), before = i - reach, after = i + reach + 1;
    const double scale = asj_octave_scale(run->octave);
    *first = floor_within(before * scale, size);
    *end = ceil_within(after * scale, size);
}

/* Bits of candidates with no allowed column near go. */
static void clear_far(const asj_detection_run *run, const uint16_t *allowed, uint16_t *bits)
{
    int32_t last = -1; /* the last pixel of the image that is allowed, of those before `next` */
    for (int32_t x = 0, next = 0; x < run->frame->width; x++) {
        int32_t first, end;
        image_range(run, x, run->image->width, &first, &end);
        for (; next < end; next++)
            last = allowed[next] ? next : last;
        if (last < first)
            clear_bit(bits, x);
    }
}

/* Row y of the octave: bits of candidates outside left .. right - 1, or with no allowed column (NULL = all are) near, go. */
static void clear_row(const asj_detection_run *run, int32_t y, int32_t left, int32_t right, const uint16_t *allowed)
{
    uint16_t *bits = run->candidates + (ptrdiff_t)y * run->frame->blocks;
    for (int32_t x = 0; x < left; x++)
        clear_bit(bits, x);
    for (int32_t x = right; x < run->frame->width; x++)
        clear_bit(bits, x);
    if (allowed)
        clear_far(run, allowed, bits);
}

asj_status asj_region_clear_candidates(asj_detection_run *run)
{
    const asj_image *mask = run->region->mask;
    const size_t row_size = (size_t)run->frame->blocks * sizeof *run->candidates;
    int32_t top, bottom, left, right;
    band near = {.count = mask ? asj_allocate_zero(&run->context->memory, (size_t)mask->width, sizeof *near.count) : NULL};
    if (mask && !near.count)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for a row of the mask");
    asj_watch watch;
    asj_watch_start(&watch, run->context, ASJ_STAGE_CANDIDATES);
    const rectangle r = rectangle_of(run->image, run->region);
    octave_range(run, r.left, r.right, run->frame->width, &left, &right);
    asj_region_rows(run, &top, &bottom);
    for (int32_t y = 0; y < run->frame->height && !asj_watch_stops(&watch, NULL); y++) {
        if (y < top || y >= bottom) {
            memset(run->candidates + (ptrdiff_t)y * run->frame->blocks, 0, row_size);
            continue;
        }
        int32_t first, end;
        image_range(run, y, run->image->height, &first, &end);
        if (mask)
            move_band(mask, first, end, &near);
        clear_row(run, y, left, right, near.count);
    }
    asj_release(&run->context->memory, near.count);
    return asj_watch_end(&watch);
}

/* The pixel that a location rounds to, as the float that the caller sees; the nearest one of the image where a junction lies beyond
 * its border. */
static int32_t pixel_of(double location, int32_t size)
{
    const double rounded = floor((double)(float)location + 0.5);
    return rounded < 0 ? 0 : rounded > size - 1 ? size - 1 : (int32_t)rounded;
}

size_t asj_region_keep(const asj_image *image, const asj_region *region, asj_hypothesis *hypotheses, size_t count)
{
    const rectangle r = rectangle_of(image, region);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const int32_t x = pixel_of(hypotheses[i].x, image->width), y = pixel_of(hypotheses[i].y, image->height);
        if (x >= r.left && x < r.right && y >= r.top && y < r.bottom && (!region->mask || mask_row(region->mask, y)[x] != 0))
            hypotheses[kept++] = hypotheses[i];
    }
    return kept;
}
