/* SPDX-License-Identifier: BSD-2-Clause */
/* Region growing and its refinement (von Gioi et al., PAMI 2010, sections 2.5 and 2.8).
 *
 * Growing: from a seed, the eight neighbours of each sample join whose level line is within the tolerance of the region's angle
 * (modulo 2 pi: light and dark side count), which is that of the sum of all unit vectors so far.
 *
 * A region may be no straight edge: two edges that meet at an obtuse angle, or a curve. It is one when at least 0.7 of the samples'
 * worth of the rectangle's area belong to the region. If not, it is grown again from its seed with twice the standard deviation of
 * the angles near the seed, no farther from it than the rectangle is wide; if that does not do, the samples farthest from the seed
 * are taken away, the radius being reduced to 0.75 time after time.
 *
 * Departure: angles are compared by sines and cosines of their differences, without a transcendental function, so that they are the
 * same everywhere. Within the tolerance a sine is at most 2.6 % below its angle. */
#include "line_segments_region.h"

#include <math.h>

#define DENSITY 0.7
#define SHRINK 0.75

/* Where the neighbours' coordinates go, cut at the border. */
static void around(int32_t at, int32_t size, int32_t *first, int32_t *last)
{
    *first = at > 0 ? at - 1 : at;
    *last = at + 1 < size ? at + 1 : at;
}

void asj_region_grow(const asj_levels *levels, int32_t seed, double cosine, asj_support_region *region)
{
    double x = (double)levels->direction[seed].x, y = (double)levels->direction[seed].y;
    double least = cosine * sqrt(x * x + y * y);
    region->samples[0] = seed;
    region->used[seed] = 1;
    region->count = 1;
    for (int32_t i = 0; i < region->count; i++) {
        int32_t left, right, top, bottom;
        around(region->samples[i] % levels->width, levels->width, &left, &right);
        around(region->samples[i] / levels->width, levels->height, &top, &bottom);
        for (int32_t row = top; row <= bottom; row++)
            for (int32_t column = left; column <= right; column++) {
                const int32_t at = row * levels->width + column;
                const double dx = (double)levels->direction[at].x, dy = (double)levels->direction[at].y;
                if (region->used[at] || !(levels->norm[at] > 0) || dx * x + dy * y < least)
                    continue;
                region->used[at] = 1;
                region->samples[region->count++] = at;
                x += dx;
                y += dy;
                least = cosine * sqrt(x * x + y * y);
            }
    }
    const double size = sqrt(x * x + y * y);
    region->x = x / size;
    region->y = y / size;
}

static int dense(const asj_support_region *region, const asj_rectangle *r)
{
    return region->count >= DENSITY * asj_rectangle_length(r) * asj_rectangle_width(r);
}

static double squared_distance(const asj_levels *levels, int32_t a, int32_t b)
{
    const double dx = a % levels->width - b % levels->width, dy = a / levels->width - b / levels->width;
    return dx * dx + dy * dy;
}

/* cos of twice the standard deviation of the angles, about that of the seed, within `radius` of it. */
static double narrower_cosine(const asj_levels *levels, const asj_support_region *region, double radius)
{
    const asj_unit_vector seed = levels->direction[region->samples[0]];
    double sum = 0, squares = 0, count = 0;
    for (int32_t i = 0; i < region->count; i++) {
        const asj_unit_vector *d = &levels->direction[region->samples[i]];
        if (squared_distance(levels, region->samples[0], region->samples[i]) > radius * radius)
            continue;
        const double sine = (double)(seed.x * d->y - seed.y * d->x);
        sum += sine;
        squares += sine * sine;
        count++;
    }
    const double mean = sum / count, variance = squares / count - mean * mean;
    return sqrt(fmax(1 - 4 * fmax(variance, 0), 0));
}

/* Drops the samples that are farther than `radius` from the first. */
static void cut(const asj_levels *levels, double radius, asj_support_region *region)
{
    const int32_t seed = region->samples[0];
    int32_t kept = 0;
    for (int32_t i = 0; i < region->count; i++) {
        const int32_t at = region->samples[i];
        if (squared_distance(levels, seed, at) <= radius * radius)
            region->samples[kept++] = at;
        else
            region->used[at] = 0;
    }
    region->count = kept;
}

static asj_rectangle rectangle_of(const asj_levels *levels, const asj_support_region *region)
{
    return asj_rectangle_of(levels, region->samples, region->count, region->x, region->y);
}

static double farthest(const asj_levels *levels, const asj_support_region *region)
{
    double most = 0;
    for (int32_t i = 0; i < region->count; i++)
        most = fmax(most, squared_distance(levels, region->samples[0], region->samples[i]));
    return sqrt(most);
}

int asj_region_approximate(const asj_levels *levels, asj_support_region *region, asj_rectangle *rectangle)
{
    *rectangle = rectangle_of(levels, region);
    if (dense(region, rectangle))
        return 1;
    const double cosine = narrower_cosine(levels, region, asj_rectangle_width(rectangle));
    const int32_t seed = region->samples[0];
    for (int32_t i = 0; i < region->count; i++)
        region->used[region->samples[i]] = 0;
    asj_region_grow(levels, seed, cosine, region);
    *rectangle = rectangle_of(levels, region);
    for (double radius = farthest(levels, region); region->count >= 2 && !dense(region, rectangle); radius *= SHRINK) {
        cut(levels, SHRINK * radius, region);
        *rectangle = rectangle_of(levels, region);
    }
    return region->count >= 2;
}
