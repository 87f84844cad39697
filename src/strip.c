/* SPDX-License-Identifier: BSD-2-Clause */
/* Validation of a branch.
 *
 * Strip: the pixels q with 0.5 < t <= min(L, strip_length) and |s| <= strip_half_width in the branch's frame, each once.
 *     Omega = sum of gamma(q) = max(|g~.n| - |g~.u|, 0),   NFA = (NM)^(3/2) F(Omega; number of pixels)
 * Tests: NM places for the start and sqrt(NM) for the end; directions are not counted, since the strip's own width makes
 * neighbouring ones the same test.
 *
 * Departure: the paper accepts a branch by the NFA of the scan itself. That one is a good stopping rule and no guarantee: local
 * branches are maxima over orientations and neighbouring arcs share pixels, so in noise a step passes with probability 0.19 instead
 * of 1/256. The strip's NFA bounds the false detections at every epsilon (tests/accuracy/noise.c).
 *
 * The strip also knows which way its gradients point: with g_u and g_n the components along and across the branch, the dominant
 * direction is off the normal by  1/2 atan2(2 sum g_u g_n, sum g_n^2 - sum g_u^2)  (structure tensor). A line of samples that runs
 * askew over a bundle of nearly parallel edges collects junction-ness from all of them, but their gradients give it away.
 *
 * And it knows whether the branch reaches the junction: the strength of its first NEAR pixels. A branch whose edge only starts some
 * pixels away, across a rim or a gap, has less there than noise would have. */
#include "strip.h"
#include "gradient.h"

#include <math.h>

#define NEAR 6 /* px: the part of the strip next to the junction */

typedef struct sums {
    double gamma, uu, un, nn, near_gamma;
    int32_t pixels, near_pixels;
} sums;

/* `all`: not the junction-ness alone. */
static inline void add_pixel(const asj_frame *frame, int32_t x, int32_t y, double ux, double uy, int near, int all, sums *s)
{
    if (x < 0 || y < 0 || x >= frame->width || y >= frame->height)
        return;
    const ptrdiff_t at = y * frame->stride + x;
    const double gx = (double)frame->gradient_x[at] / ASJ_GRADIENT_ONE, gy = (double)frame->gradient_y[at] / ASJ_GRADIENT_ONE;
    const double along = gx * ux + gy * uy, across = gy * ux - gx * uy, gamma = fabs(across) - fabs(along);
    s->gamma += gamma > 0 ? gamma : 0;
    s->pixels++;
    if (!all)
        return;
    s->uu += along * along;
    s->un += along * across;
    s->nn += across * across;
    if (near) {
        s->near_gamma += gamma > 0 ? gamma : 0;
        s->near_pixels++;
    }
}

/* floor() for what is near the image, without a call. */
static inline int32_t whole(double value)
{
    return (int32_t)(value + 131072) - 131072;
}

/* Walks along the axis (x or y) that the strip is longer on, and across it over the few pixels that can be inside. */
static inline sums add_up(const asj_frame *frame, const asj_detect_options *options, double x, double y, double angle,
                          double length, int all)
{
    const double ux = cos(angle), uy = sin(angle), half_width = options->strip_half_width;
    const double reach = fmin(length, options->strip_length);
    const int along_x = fabs(ux) >= fabs(uy);
    const double major = along_x ? x : y, minor = along_x ? y : x;
    const double major_step = along_x ? ux : uy, slope = along_x ? uy / ux : ux / uy;
    const double end = major + reach * major_step;
    const double spread = half_width / fabs(major_step) + 1e-6;
    const int32_t first = (int32_t)floor(fmin(major, end) - half_width), last = (int32_t)ceil(fmax(major, end) + half_width);
    sums s = {0, 0, 0, 0, 0, 0, 0};
    for (int32_t i = first; i <= last; i++) {
        const double middle = minor + (i - major) * slope;
        const int32_t to = whole(middle + spread);
        for (int32_t j = whole(middle - spread) + 1; j <= to; j++) {
            int32_t px = along_x ? i : j, py = along_x ? j : i;
            double t = (px - x) * ux + (py - y) * uy, across = (py - y) * ux - (px - x) * uy;
            if (t > 0.5 && t <= reach && fabs(across) <= half_width)
                add_pixel(frame, px, py, ux, uy, t <= NEAR, all, &s);
        }
    }
    return s;
}

static double log_nfa(const asj_context *context, const asj_frame *frame, const sums *s)
{
    const double log_tests = 1.5 * log((double)frame->width * frame->height);
    return s->pixels ? log_tests + asj_nfa_log_sector_tail(context->nfa, s->gamma, s->pixels) : HUGE_VAL;
}

double asj_strip_log_nfa(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         double x, double y, double angle, double length)
{
    const sums s = add_up(frame, options, x, y, angle, length, 0);
    return log_nfa(context, frame, &s);
}

asj_strip asj_strip_test(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         double x, double y, double angle, double length)
{
    const sums s = add_up(frame, options, x, y, angle, length, 1);
    asj_strip strip = {log_nfa(context, frame, &s), 0, 0};
    if (s.pixels == 0)
        return strip;
    strip.deviation = fabs(0.5 * atan2(2 * s.un, s.nn - s.uu));
    if (s.near_pixels > 0)
        strip.near_strength = (s.near_gamma - s.near_pixels * ASJ_GAMMA_MEAN) / (ASJ_GAMMA_SD * sqrt(s.near_pixels));
    return strip;
}
