/* SPDX-License-Identifier: BSD-2-Clause */
/* Exact coverage. Pixels that one polygon covers whole take its paint at their centre (the mean of a linear shade). Every other
 * pixel starts as its square in the colour of the last polygon that covers it whole; each later polygon cuts it along its edges
 * into convex fragments: those outside keep their colour, the one inside takes the new. The pixel is the area-weighted sum of
 * the paints at the fragments' centroids, which is the integral exactly: shared edges leave no seam, unlike compositing by
 * coverage. */
#include "render.h"

#include "random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_FRAGMENTS 256
#define FRAGMENT_CORNERS 24

typedef struct fragment {
    synth_point corners[FRAGMENT_CORNERS];
    int32_t count;
    int32_t owner; /* polygon index, -1 background */
} fragment;

/* What one polygon does to one row of pixels: it touches first .. last and covers inner_first .. inner_last whole. */
typedef struct row_span {
    int32_t first, last, inner_first, inner_last;
} row_span;

typedef struct renderer {
    const synth_scene *scene;
    row_span *spans;   /* one a polygon */
    int32_t *base;     /* per pixel of the row: last polygon that covers it whole */
    uint8_t *mixed;    /* per pixel of the row: some polygon covers a part of it */
    fragment *now, *next;
    int32_t now_count, next_count;
    int overflow;
} renderer;

/* Keeps the part of a convex polygon where turn(a, b, .) has the given sign (boundary included). */
static void clip(const fragment *in, synth_point a, synth_point b, double sign, fragment *out)
{
    out->count = 0;
    out->owner = in->owner;
    for (int32_t i = 0; i < in->count; i++) {
        const synth_point p = in->corners[i], q = in->corners[(i + 1) % in->count];
        const double dp = sign * ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x));
        const double dq = sign * ((b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x));
        if (dp >= 0.0 && out->count < FRAGMENT_CORNERS)
            out->corners[out->count++] = p;
        if (((dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0)) && out->count < FRAGMENT_CORNERS) {
            const double t = dp / (dp - dq);
            const synth_point cut = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
            out->corners[out->count++] = cut;
        }
    }
}

/* Twice the area, and the centroid. */
static double twice_area(const fragment *f, synth_point *centroid)
{
    double sum = 0.0, sx = 0.0, sy = 0.0;
    const synth_point o = f->corners[0];
    for (int32_t i = 1; i + 1 < f->count; i++) {
        const synth_point a = f->corners[i], b = f->corners[i + 1];
        const double area = (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
        sum += area;
        sx += area * (a.x - o.x + b.x - o.x);
        sy += area * (a.y - o.y + b.y - o.y);
    }
    centroid->x = sum != 0.0 ? o.x + sx / (3.0 * sum) : o.x;
    centroid->y = sum != 0.0 ? o.y + sy / (3.0 * sum) : o.y;
    return sum;
}

static void keep(renderer *r, const fragment *f)
{
    synth_point centroid;
    if (f->count < 3 || twice_area(f, &centroid) < 1e-14)
        return;
    if (r->next_count == MAX_FRAGMENTS) {
        r->overflow = 1;
        return;
    }
    r->next[r->next_count++] = *f;
}

static void paint_over(renderer *r, int32_t index)
{
    const synth_polygon *polygon = &r->scene->polygons[index];
    r->next_count = 0;
    for (int32_t i = 0; i < r->now_count; i++) {
        fragment inside = r->now[i], part;
        for (int32_t k = 0; k < polygon->count && inside.count >= 3; k++) {
            const synth_point a = polygon->corners[k], b = polygon->corners[(k + 1) % polygon->count];
            clip(&inside, a, b, -1.0, &part);
            keep(r, &part);
            clip(&inside, a, b, 1.0, &part);
            inside = part;
        }
        inside.owner = index;
        keep(r, &inside);
    }
    fragment *swap = r->now;
    r->now = r->next;
    r->next = swap;
    r->now_count = r->next_count;
}

static double owner_gray(const synth_scene *scene, int32_t owner, synth_point p)
{
    return synth_paint_at(owner < 0 ? &scene->background : &scene->polygons[owner].paint, p.x, p.y);
}

static double mixed_pixel(renderer *r, int32_t x, int32_t y)
{
    const double l = x - 0.5, t = y - 0.5;
    const fragment square = {{{l, t}, {l + 1.0, t}, {l + 1.0, t + 1.0}, {l, t + 1.0}}, 4, r->base[x]};
    r->now[0] = square;
    r->now_count = 1;
    for (int32_t i = r->base[x] + 1; i < r->scene->count; i++)
        if (x >= r->spans[i].first && x <= r->spans[i].last)
            paint_over(r, i);
    double sum = 0.0, weight = 0.0;
    for (int32_t i = 0; i < r->now_count; i++) {
        synth_point centroid;
        const double area = twice_area(&r->now[i], &centroid);
        sum += area * owner_gray(r->scene, r->now[i].owner, centroid);
        weight += area;
    }
    return sum / weight;
}

/* Interval of x where the horizontal line at y meets the polygon; 0 when it does not. */
static int chord(const synth_polygon *polygon, double y, double *low, double *high)
{
    *low = HUGE_VAL;
    *high = -HUGE_VAL;
    for (int32_t k = 0; k < polygon->count; k++) {
        const synth_point a = polygon->corners[k], b = polygon->corners[(k + 1) % polygon->count];
        if ((a.y < y && b.y < y) || (a.y > y && b.y > y))
            continue;
        const double x1 = a.y == b.y ? a.x : a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
        const double x2 = a.y == b.y ? b.x : x1;
        *low = fmin(*low, fmin(x1, x2));
        *high = fmax(*high, fmax(x1, x2));
    }
    return *low <= *high;
}

static int32_t clamp_column(double x, int32_t width)
{
    return x < -1.0 ? -1 : x > (double)width ? width : (int32_t)x;
}

/* The polygon is convex, so it covers a pixel whole when it covers the pixel's upper and lower side. */
static row_span span_of(const synth_polygon *polygon, int32_t y, int32_t width)
{
    row_span span = {1, 0, 1, 0};
    const double top = y - 0.5, bottom = y + 0.5;
    double low, high, low1, high1, low2, high2;
    const int upper = chord(polygon, top, &low1, &high1), lower = chord(polygon, bottom, &low2, &high2);
    low = fmin(low1, low2);
    high = fmax(high1, high2);
    for (int32_t k = 0; k < polygon->count; k++)
        if (polygon->corners[k].y >= top && polygon->corners[k].y <= bottom) {
            low = fmin(low, polygon->corners[k].x);
            high = fmax(high, polygon->corners[k].x);
        }
    if (!(low <= high) || high < -0.5 || low > width - 0.5)
        return span;
    span.first = clamp_column(ceil(low - 0.5 - 1e-9), width);
    span.last = clamp_column(floor(high + 0.5 + 1e-9), width);
    span.first = span.first < 0 ? 0 : span.first;
    span.last = span.last > width - 1 ? width - 1 : span.last;
    if (upper && lower) {
        span.inner_first = clamp_column(ceil(fmax(low1, low2) + 0.5), width);
        span.inner_last = clamp_column(floor(fmin(high1, high2) - 0.5), width);
        span.inner_first = span.inner_first < 0 ? 0 : span.inner_first;
        span.inner_last = span.inner_last > width - 1 ? width - 1 : span.inner_last;
    }
    return span;
}

static void render_row(renderer *r, int32_t y, double *row)
{
    const int32_t width = r->scene->width;
    for (int32_t x = 0; x < width; x++) {
        r->base[x] = -1;
        r->mixed[x] = 0;
    }
    for (int32_t i = 0; i < r->scene->count; i++) {
        const row_span span = r->spans[i] = span_of(&r->scene->polygons[i], y, width);
        for (int32_t x = span.first; x <= span.last; x++) {
            const int whole = x >= span.inner_first && x <= span.inner_last;
            r->mixed[x] = !whole;
            if (whole)
                r->base[x] = i;
        }
    }
    /* A pixel that is mixed, then touched no more, stays mixed; one covered whole later is not mixed any more: but a mixed
     * pixel touched by a later partial cover is, and `mixed` holds the last answer, which is right in all these cases. */
    for (int32_t x = 0; x < width; x++) {
        const synth_point centre = {x, y};
        row[x] = r->mixed[x] ? mixed_pixel(r, x, y) : owner_gray(r->scene, r->base[x], centre);
    }
}

int synth_render(const synth_scene *scene, double *samples)
{
    if (scene->failed || scene->width < 1 || scene->height < 1)
        return -1;
    renderer r = {scene, NULL, NULL, NULL, NULL, NULL, 0, 0, 0};
    r.spans = malloc(((size_t)scene->count + 1) * sizeof *r.spans);
    r.base = malloc((size_t)scene->width * sizeof *r.base);
    r.mixed = malloc((size_t)scene->width);
    r.now = malloc(MAX_FRAGMENTS * sizeof *r.now);
    r.next = malloc(MAX_FRAGMENTS * sizeof *r.next);
    const int ready = r.spans && r.base && r.mixed && r.now && r.next;
    for (int32_t y = 0; ready && y < scene->height; y++)
        render_row(&r, y, samples + (size_t)y * (size_t)scene->width);
    free(r.spans);
    free(r.base);
    free(r.mixed);
    free(r.now);
    free(r.next);
    return ready && !r.overflow ? 0 : -1;
}

/* One pass along lines of `length` samples, `step` apart. */
static void blur_line(double *line, double *copy, int32_t length, size_t step, const double *taps, int32_t radius)
{
    for (int32_t i = 0; i < length; i++)
        copy[radius + i] = line[(size_t)i * step];
    for (int32_t i = 0; i < radius; i++) {
        copy[i] = copy[radius];
        copy[radius + length + i] = copy[radius + length - 1];
    }
    for (int32_t i = 0; i < length; i++) {
        double sum = 0.0;
        for (int32_t k = 0; k <= 2 * radius; k++)
            sum += taps[k] * copy[i + k];
        line[(size_t)i * step] = sum;
    }
}

int synth_blur(double *samples, int32_t width, int32_t height, double sigma)
{
    if (sigma <= 0.0)
        return 0;
    const int32_t radius = (int32_t)ceil(4.0 * sigma), longest = width > height ? width : height;
    double *taps = malloc((size_t)(2 * radius + 1) * sizeof *taps);
    double *copy = malloc((size_t)(longest + 2 * radius) * sizeof *copy);
    if (taps && copy) {
        double sum = 0.0;
        for (int32_t k = -radius; k <= radius; k++)
            sum += taps[k + radius] = exp(-0.5 * (k / sigma) * (k / sigma));
        for (int32_t k = 0; k <= 2 * radius; k++)
            taps[k] /= sum;
        for (int32_t y = 0; y < height; y++)
            blur_line(samples + (size_t)y * (size_t)width, copy, width, 1, taps, radius);
        for (int32_t x = 0; x < width; x++)
            blur_line(samples + x, copy, height, (size_t)width, taps, radius);
    }
    const int result = taps && copy ? 0 : -1;
    free(taps);
    free(copy);
    return result;
}

void synth_add_noise(double *samples, size_t count, double sd, uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    for (size_t i = 0; i < count && sd > 0.0; i++)
        samples[i] += sd * synth_random_normal(&random);
}

void synth_to_gray8(const double *samples, size_t count, uint8_t *pixels)
{
    for (size_t i = 0; i < count; i++) {
        const double rounded = floor(samples[i] + 0.5);
        pixels[i] = (uint8_t)(rounded < 0.0 ? 0.0 : rounded > 255.0 ? 255.0 : rounded);
    }
}

uint8_t *synth_photograph(const synth_scene *scene, double blur, double noise, uint64_t seed)
{
    const size_t count = (size_t)scene->width * (size_t)scene->height;
    double *samples = malloc(count * sizeof *samples);
    uint8_t *pixels = malloc(count);
    if (samples && pixels && synth_render(scene, samples) == 0 && synth_blur(samples, scene->width, scene->height, blur) == 0) {
        synth_add_noise(samples, count, noise, seed);
        synth_to_gray8(samples, count, pixels);
    } else {
        free(pixels);
        pixels = NULL;
    }
    free(samples);
    return pixels;
}

uint8_t *synth_noise_image(int32_t width, int32_t height, double mean, double sd, uint64_t seed)
{
    synth_scene scene;
    synth_scene_init(&scene, width, height, mean);
    uint8_t *pixels = synth_photograph(&scene, 0.0, sd, seed);
    synth_scene_free(&scene);
    return pixels;
}

uint64_t synth_checksum(const void *data, size_t size)
{
    const uint8_t *bytes = data;
    uint64_t hash = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    return hash;
}
