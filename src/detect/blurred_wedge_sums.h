/* SPDX-License-Identifier: BSD-2-Clause */
/* The wedge of blurred_corner.c. Of one edge, with sigma its sign (1, -1), z = t / b, phi the normal density, f the gradient along
 * n of a step of 1:
 *     f = sigma exp(-s^2 / 2 b^2) N(z),    df/dt = sigma exp(-s^2 / 2 b^2) phi(z) / b,    df/ds = -f s / b^2
 * from which the changes with the corner (t and s move against it), the edge's angle (t by s, s by -t, n by -u) and b follow.
 *
 * The step h multiplies all of this. So the sums are taken with h = 1, and what depends on h follows from them.
 *
 * Where the edge is far from its beginning and the other one is nowhere near, N = 1 and df/dt = 0: everything is along n, but for
 * the turn of n, and in proportion to f. Most pixels of long bands are such.
 *
 * Pixels are collected and worked on BATCH at a time, in single precision, in loops that compilers make vectors of. Sums have PARTS
 * parts, which are added at the end: the same bits with any length of vectors. So this is compiled once as the reference
 * (blurred_wedge_sums.c) and once more for each instruction set with longer vectors that is worth it (simd). */
#ifndef ASJ_SRC_BLURRED_WEDGE_SUMS_H
#define ASJ_SRC_BLURRED_WEDGE_SUMS_H

#include "blurred_wedge.h"

#include <math.h>
#include <string.h>

#define NOTHING 4.0f /* standard deviations from where on a normal distribution is 0 or 1 */
#define BATCH 32
#define PARTS 8

enum {
    X = ASJ_WEDGE_X,
    Y = ASJ_WEDGE_Y,
    FIRST = ASJ_WEDGE_FIRST,
    BLUR = ASJ_WEDGE_BLUR,
    STEP = ASJ_WEDGE_STEP,
    PARAMETERS = ASJ_WEDGE_PARAMETERS
};

/* Pixels, from that of the corner; twice what is seen there; their weights, unless these follow from where they are. */
typedef struct wedge_pixels {
    int32_t count;
    int32_t x[BATCH], y[BATCH], seen_x[BATCH], seen_y[BATCH];
    float weight[BATCH];
} wedge_pixels;

/* x, y: the pixel of the corner. `plain`: px along an edge from where on its band has only this edge. */
typedef struct wedge_work {
    const asj_frame *frame;
    const asj_wedge *wedge;
    const asj_wedge_window *in;
    int32_t x, y;
    float part_x, part_y; /* of the corner, from its pixel */
    double plain;
    wedge_pixels pixels;         /* anywhere */
    wedge_pixels far;            /* of the band in turn, where it is plain */
    asj_wedge_sums *to;
} wedge_work;

static double add_parts(const float sum[PARTS])
{
    return (double)(((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7])));
}

static double dot(const float *a, const float *b, int32_t count)
{
    float sum[PARTS] = {0};
    for (int32_t i = 0; i < count; i += PARTS)
        for (int32_t lane = 0; lane < PARTS; lane++)
            sum[lane] += a[i + lane] * b[i + lane];
    return add_parts(sum);
}

static double total(const float *a)
{
    float sum[PARTS] = {0};
    for (int32_t i = 0; i < BATCH; i += PARTS)
        for (int32_t lane = 0; lane < PARTS; lane++)
            sum[lane] += a[i + lane];
    return add_parts(sum);
}

/* 1 where a <= b, else 0: without a comparison, which compilers may make a jump of. */
static inline float is_below(float a, float b)
{
    return 0.5f + copysignf(0.5f, b - a);
}

/* exp(-z^2 / 2) for |z| < NOTHING, to 8e-6 of itself, and 0 beyond: Taylor's series at an eighth, squared three times. */
static inline float bell(float z)
{
    const float square = z * z, inside = is_below(square, NOTHING * NOTHING), y = -(1.0f / 16) * square * inside;
    float e = 1.0f / 40320 + y * (1.0f / 362880);
    e = 1.0f / 720 + y * (1.0f / 5040 + y * e);
    e = 1.0f / 24 + y * (1.0f / 120 + y * e);
    e = 1 + y * (1 + y * (0.5f + y * (1.0f / 6 + y * e)));
    e *= e;
    e *= e;
    return e * e * inside;
}

/* The normal distribution function at z, density(z) being given, to 1e-7 (Abramowitz and Stegun, 26.2.17). */
static inline float normal(float z, float density)
{
    const float k = 1 / (1 + 0.2316419f * fabsf(z)), series = 1.781477937f + k * (-1.821255978f + k * 1.330274429f);
    const float tail = density * k * (0.319381530f + k * (-0.356563782f + k * series));
    const float ahead = is_below(0, z);
    return ahead + (1 - 2 * ahead) * tail;
}

/* What one edge adds to the gradient of the pixels, its components one behind the other, and to the changes of it. `turn`: those
 * with its angle. */
static void add_edge(const wedge_work *w, int edge, const wedge_pixels *restrict p, float (*restrict d)[2 * BATCH],
                     float *restrict turn)
{
    const float ux = (float)w->in->ux[edge], uy = (float)w->in->uy[edge], sign = edge == 0 ? 1 : -1;
    const float b = (float)w->wedge->p[BLUR], inverse = 1 / b, part_x = w->part_x, part_y = w->part_y;
    for (int32_t i = 0; i < BATCH; i++) {
        const float x = (float)p->x[i] - part_x, y = (float)p->y[i] - part_y;
        const float t = (x * ux + y * uy) * inverse, s = (y * ux - x * uy) * inverse;
        const float density = 0.3989422804f * bell(t), height = sign * bell(s), f = height * normal(t, density);
        const float along = height * density * inverse, across = -f * s * inverse;
        const float wider = (f * s * s) * inverse - along * t, turned = (along * s - across * t) * b;
        const float dx = across * uy - along * ux, dy = -(along * uy + across * ux);
        d[X][i] -= dx * uy;
        d[X][BATCH + i] += dx * ux;
        d[Y][i] -= dy * uy;
        d[Y][BATCH + i] += dy * ux;
        turn[i] = -turned * uy - f * ux;
        turn[BATCH + i] = turned * ux - f * uy;
        d[BLUR][i] -= wider * uy;
        d[BLUR][BATCH + i] += wider * ux;
        d[STEP][i] -= f * uy;
        d[STEP][BATCH + i] += f * ux;
    }
}

/* Pixels without weight fill the batch. */
static void fill(wedge_pixels *p)
{
    for (int32_t i = p->count; i < BATCH; i++) {
        p->x[i] = p->y[i] = p->seen_x[i] = p->seen_y[i] = 0;
        p->weight[i] = 0;
    }
    p->count = 0;
}

static void add_pixels(wedge_work *w)
{
    wedge_pixels *p = &w->pixels;
    asj_wedge_sums *to = w->to;
    float d[PARAMETERS][2 * BATCH], weighted[2 * BATCH], seen[2 * BATCH], by_weight[2 * BATCH];
    fill(p);
    memset(d, 0, sizeof d);
    for (int edge = 0; edge < 2; edge++)
        add_edge(w, edge, p, d, d[FIRST + edge]);
    for (int32_t i = 0; i < BATCH; i++) {
        seen[i] = 0.5f * (float)p->seen_x[i];
        seen[BATCH + i] = 0.5f * (float)p->seen_y[i];
        by_weight[i] = p->weight[i] * seen[i];
        by_weight[BATCH + i] = p->weight[i] * seen[BATCH + i];
    }
    to->total += dot(by_weight, seen, 2 * BATCH);
    to->weight += total(p->weight);
    for (int a = 0; a < PARAMETERS; a++) {
        for (int32_t i = 0; i < BATCH; i++) {
            weighted[i] = p->weight[i] * d[a][i];
            weighted[BATCH + i] = p->weight[i] * d[a][BATCH + i];
        }
        to->seen[a] += dot(by_weight, d[a], 2 * BATCH);
        for (int b = 0; b <= a; b++)
            to->products[a][b] += dot(weighted, d[b], 2 * BATCH);
    }
}

/* A plain stretch: the edge alone. In terms of f across, its turn, its widening and f itself, which the parameters change by
 * (across uy) n, -(across ux) n, turned n - f u, wider n and f n. These of a batch, and the same times the weights; what is seen
 * along n and u, the weights, and the squares of what is seen times these. */
typedef struct wedge_far {
    float across[BATCH], turned[BATCH], wider[BATCH], f[BATCH];
    float by_across[BATCH], by_turned[BATCH], by_wider[BATCH], by_f[BATCH];
    float along_n[BATCH], along_u[BATCH], weights[BATCH], squares[BATCH];
} wedge_far;

static inline void look_far(const wedge_work *w, int edge, const wedge_pixels *restrict p, wedge_far *restrict d)
{
    const float fx = (float)w->in->ux[edge], fy = (float)w->in->uy[edge], inverse = (float)(1 / w->wedge->p[BLUR]);
    const float part_x = w->part_x, part_y = w->part_y, last = (float)w->in->last[edge], narrow = (float)(1 / w->in->across);
    const float sign = edge == 0 ? 1 : -1;
    for (int32_t i = 0; i < BATCH; i++) {
        const float x = (float)p->x[i] - part_x, y = (float)p->y[i] - part_y, t = x * fx + y * fy, beside = y * fx - x * fy;
        const float seen_x = 0.5f * (float)p->seen_x[i], seen_y = 0.5f * (float)p->seen_y[i];
        const float place = beside * narrow, rest = 1 - place * place, inside = 0.5f * (rest + fabsf(rest));
        const float weight = p->weight[i] * inside * inside * is_below(t, last);
        const float s = beside * inverse, f = sign * bell(s), across = -f * s * inverse, turned = -across * t;
        const float wider = f * s * s * inverse;
        d->across[i] = across;
        d->turned[i] = turned;
        d->wider[i] = wider;
        d->f[i] = f;
        d->by_across[i] = weight * across;
        d->by_turned[i] = weight * turned;
        d->by_wider[i] = weight * wider;
        d->by_f[i] = weight * f;
        d->along_n[i] = seen_y * fx - seen_x * fy;
        d->along_u[i] = seen_x * fx + seen_y * fy;
        d->weights[i] = weight;
        d->squares[i] = weight * (seen_x * seen_x + seen_y * seen_y);
    }
}

static void add_far(wedge_work *w, int edge)
{
    const double ux = w->in->ux[edge], uy = w->in->uy[edge];
    const int angle = FIRST + edge;
    asj_wedge_sums *to = w->to;
    wedge_far d;
    fill(&w->far);
    look_far(w, edge, &w->far, &d);
    const double square = dot(d.by_across, d.across, BATCH), with_turn = dot(d.by_across, d.turned, BATCH);
    const double with_width = dot(d.by_across, d.wider, BATCH), with_f = dot(d.by_across, d.f, BATCH);
    const double f_square = dot(d.by_f, d.f, BATCH), seen = dot(d.by_across, d.along_n, BATCH);
    double (*m)[PARAMETERS] = to->products;
    m[X][X] += square * uy * uy;
    m[Y][X] -= square * ux * uy;
    m[Y][Y] += square * ux * ux;
    m[angle][X] += with_turn * uy;
    m[angle][Y] -= with_turn * ux;
    m[angle][angle] += dot(d.by_turned, d.turned, BATCH) + f_square;
    m[BLUR][X] += with_width * uy;
    m[BLUR][Y] -= with_width * ux;
    m[BLUR][angle] += dot(d.by_turned, d.wider, BATCH);
    m[BLUR][BLUR] += dot(d.by_wider, d.wider, BATCH);
    m[STEP][X] += with_f * uy;
    m[STEP][Y] -= with_f * ux;
    m[STEP][angle] += dot(d.by_turned, d.f, BATCH);
    m[STEP][BLUR] += dot(d.by_wider, d.f, BATCH);
    m[STEP][STEP] += f_square;
    to->seen[X] += seen * uy;
    to->seen[Y] -= seen * ux;
    to->seen[angle] += dot(d.by_turned, d.along_n, BATCH) - dot(d.by_f, d.along_u, BATCH);
    to->seen[BLUR] += dot(d.by_wider, d.along_n, BATCH);
    to->seen[STEP] += dot(d.by_f, d.along_n, BATCH);
    to->total += total(d.squares);
    to->weight += total(d.weights);
}

/* Returns whether the batch is full. */
static inline int put(const wedge_work *w, int32_t x, int32_t y, float weight, wedge_pixels *p)
{
    const uint16_t *at = w->frame->gray + y * w->frame->stride + x;
    const int32_t i = p->count++;
    p->x[i] = x - w->x;
    p->y[i] = y - w->y;
    p->weight[i] = weight;
    p->seen_x[i] = at[1] - at[-1];
    p->seen_y[i] = at[w->frame->stride] - at[-w->frame->stride];
    return i + 1 == BATCH;
}

static double disc_weight(const asj_wedge_window *in, double dx, double dy)
{
    const double rest = 1 - (dx * dx + dy * dy) / (in->reach * in->reach);
    return rest > 0 ? rest * rest : 0;
}

/* Whole numbers from `from` to `to`, none at the border of an image of `size`, whose pixels have a neighbour on one side only. */
static void pixels_between(double from, double to, int32_t size, int32_t *first, int32_t *last)
{
    *first = (int32_t)ceil(fmin(fmax(from, 1), size));
    *last = (int32_t)floor(fmax(fmin(to, size - 2), 0));
}

static void add_disc(wedge_work *w)
{
    const asj_wedge_window *in = w->in;
    int32_t left, right, top, bottom;
    pixels_between(in->x - in->reach, in->x + in->reach, w->frame->width, &left, &right);
    pixels_between(in->y - in->reach, in->y + in->reach, w->frame->height, &top, &bottom);
    for (int32_t y = top; y <= bottom; y++)
        for (int32_t x = left; x <= right; x++) {
            const double weight = disc_weight(in, x - in->x, y - in->y);
            if (weight > 0 && put(w, x, y, (float)weight, &w->pixels))
                add_pixels(w);
        }
}

static void add_pixel_of_band(wedge_work *w, int edge, int32_t x, int32_t y)
{
    const asj_wedge_window *in = w->in;
    const double ux = in->ux[edge], uy = in->uy[edge], dx = x - in->x, dy = y - in->y;
    const double t = dx * ux + dy * uy, s = (dy * ux - dx * uy) / in->across, rest = 1 - s * s;
    if (!(t > 0 && t < in->last[edge] && rest > 0))
        return;
    const double weight = rest * rest - disc_weight(in, dx, dy);
    if (weight > 0 && put(w, x, y, (float)weight, &w->pixels))
        add_pixels(w);
}

/* A line of pixels across a band, between (x, y) and the end, by one or the other axis. */
static void add_line_of_band(wedge_work *w, int edge, int by_x, int32_t line, int32_t from, int32_t until)
{
    const asj_wedge_window *in = w->in;
    const double across = by_x ? in->uy[edge] : in->ux[edge], along = by_x ? in->ux[edge] : in->uy[edge];
    const double start = (line - (by_x ? in->x : in->y)) * along, middle = by_x ? in->y : in->x;
    const int far = start + fmin((from - middle) * across, (until - middle) * across) > w->plain;
    for (int32_t j = from; j <= until; j++) {
        const int32_t x = by_x ? line : j, y = by_x ? j : line;
        if (!far)
            add_pixel_of_band(w, edge, x, y);
        else if (put(w, x, y, 1, &w->far))
            add_far(w, edge);
    }
}

/* What a band adds to the disc. It is walked by the axis that it is longer on. */
static void add_band(wedge_work *w, int edge)
{
    const asj_wedge_window *in = w->in;
    const double ux = in->ux[edge], uy = in->uy[edge], last = in->last[edge];
    const int by_x = fabs(ux) >= fabs(uy);
    const double along = by_x ? ux : uy, start = by_x ? in->x : in->y, spread = in->across / fabs(along);
    int32_t first, end, from, until;
    if (last <= 0)
        return;
    pixels_between(start + fmin(last * along, 0) - in->across, start + fmax(last * along, 0) + in->across,
                   by_x ? w->frame->width : w->frame->height, &first, &end);
    for (int32_t i = first; i <= end; i++) {
        const double middle = by_x ? in->y + (i - in->x) * uy / ux : in->x + (i - in->y) * ux / uy;
        pixels_between(middle - spread, middle + spread, by_x ? w->frame->height : w->frame->width, &from, &until);
        add_line_of_band(w, edge, by_x, i, from, until);
    }
    if (w->far.count > 0)
        add_far(w, edge);
}

/* From where on the bands are plain. A place of one, t px along it and at most `across` beside it, is at least t sin - across cos
 * beside the other edge, and where that opens by more than a right angle t cos - across sin behind its beginning. */
static void set_plain(wedge_work *w)
{
    const asj_wedge_window *in = w->in;
    const double reach = NOTHING * w->wedge->p[BLUR], cosine = in->ux[0] * in->ux[1] + in->uy[0] * in->uy[1];
    const double sine = fabs(in->ux[0] * in->uy[1] - in->uy[0] * in->ux[1]), size = fabs(cosine);
    const double beside = sine > 0 ? (reach + in->across * size) / sine : HUGE_VAL;
    const double behind = cosine < 0 ? (reach + in->across * sine) / size : HUGE_VAL;
    w->plain = fmax(fmax(reach, in->reach), fmin(beside, behind));
}

static void wedge_add_up(const asj_frame *frame, const asj_wedge *wedge, const asj_wedge_window *window, asj_wedge_sums *sums)
{
    wedge_work w;
    w.frame = frame;
    w.wedge = wedge;
    w.in = window;
    w.x = (int32_t)window->x;
    w.y = (int32_t)window->y;
    w.part_x = (float)(window->x - w.x);
    w.part_y = (float)(window->y - w.y);
    w.to = sums;
    w.pixels.count = w.far.count = 0;
    memset(sums, 0, sizeof *sums);
    set_plain(&w);
    add_disc(&w);
    for (int edge = 0; edge < 2; edge++)
        add_band(&w, edge);
    if (w.pixels.count > 0)
        add_pixels(&w);
}

#endif
