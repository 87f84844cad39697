/* SPDX-License-Identifier: BSD-2-Clause */
/* Validation of a branch.
 *
 * Strip: the pixels q with 0.5 < t <= min(L, strip_length) and |s| <= strip_half_width in the branch's frame, each once.
 *     Omega = sum of gamma(q) = max(|g~.n| - |g~.u|, 0),   NFA = (NM)^(3/2) F(Omega; number of pixels)
 * Tests: NM places for the start and sqrt(NM) for the end; directions are not counted, since the strip's own width makes
 * neighbouring ones the same test. Times the number of octaves, which share the false alarms (octaves.c).
 *
 * Departure: the paper accepts a branch by the NFA of the scan itself. That one is a good stopping rule and no guarantee: local
 * branches are maxima over orientations and neighbouring arcs share pixels, so in noise a step passes with probability 0.19 instead
 * of 1/256. The strip's NFA bounds the false detections at every epsilon (tests/accuracy/noise.c). In coarse octaves two branches
 * may be meaningful together (validate.c).
 *
 * The strip also knows whether the branch reaches the junction: the strength of its first NEAR pixels. A branch whose edge only
 * starts some pixels away, across a rim or a gap, has less there than noise would have.
 *
 * Pixels alike. The null model takes pixels for independent. Noise that optics, demosaicing or upsampling have blurred is not:
 * blurred by 2 px its gradients agree over 7 px along what looks like an edge, and a strip of 14 px is two samples, not forty. Two
 * measurements tell: the width w of the edge (edge_width.c), which is 0 in white noise and 1.2 px in that, and how the gradient
 * wavers,
 *     q = sum g_u^2 / sum g_n^2,
 * which noise cannot keep low: 0.21 (0.08 .. 0.37) along what the strip test takes for edges in blurred noise, 0.02 along clean
 * edges, 0.08 along edges of 60 grey levels blurred by 5 px. With
 *     c = 1 + ALIKE max(w - INDEPENDENT_WIDTH, 0) (q / NOISE_WAVER)^2
 * pixels as good as one, sum and number of pixels are both to be divided by c, and that divides the exponent of the tail: ln F / c.
 * Chosen on blurred noise and on soft corners: a tenth of the false junctions in the one, the others stay. Near its ends a clean
 * soft edge wavers, too, and a short one is all ends. Where a blurred corner has been fitted (blurred_corner.c) what that leaves of
 * the gradient's squares tells noise better: NOISE_LEFT stands for NOISE_WAVER then, and the smaller c holds. */
#include "strip.h"
#include "gradient.h"
#include "nfa.h"

#include <math.h>
#include <string.h>

#define ALIKE 0.8
#define INDEPENDENT_WIDTH 0.6 /* px */
#define NOISE_WAVER 0.15
#define NOISE_LEFT 0.05

#define NEAR 6 /* px: the part of the strip next to the junction */

typedef struct lanes {
    double gamma[ASJ_STRIP_LANES], uu[ASJ_STRIP_LANES], un[ASJ_STRIP_LANES], nn[ASJ_STRIP_LANES], near_gamma[ASJ_STRIP_LANES];
    int32_t pixels, near_pixels; /* of all lanes */
} lanes;

static double total(const double v[ASJ_STRIP_LANES])
{
    return (v[0] + v[2]) + (v[1] + v[3]);
}

/* A pixel at (dx, dy) from the strip's start. */
static inline void add_pixel(const asj_strip_walk *walk, double dx, double dy, double gx, double gy, int32_t lane, lanes *to)
{
    const double ux = walk->ux, uy = walk->uy, t = dx * ux + dy * uy, s = dy * ux - dx * uy;
    if (!(t > 0.5 && t <= walk->reach && fabs(s) <= walk->half_width))
        return;
    const double along = gx * ux + gy * uy, across = gy * ux - gx * uy, gamma = fmax(fabs(across) - fabs(along), 0);
    to->gamma[lane] += gamma;
    to->uu[lane] += along * along;
    to->un[lane] += along * across;
    to->nn[lane] += across * across;
    to->pixels++;
    if (t <= walk->near) {
        to->near_gamma[lane] += gamma;
        to->near_pixels++;
    }
}

/* The sums of ASJ_STRIP_LANES neighbours across are kept apart and added at the end: vector forms then give the same bits. */
void asj_strip_sums_of(const asj_frame *frame, const asj_strip_walk *walk, asj_strip_sums *sums)
{
    lanes list;
    memset(&list, 0, sizeof list);
    for (int32_t i = walk->first; i <= walk->last; i++) {
        int32_t first, last;
        asj_strip_step(frame, walk, i, &first, &last);
        for (int32_t j = first; j <= last; j++) {
            const int32_t x = walk->along_x ? i : j, y = walk->along_x ? j : i;
            const ptrdiff_t at = y * frame->stride + x;
            add_pixel(walk, x - walk->x, y - walk->y, frame->gradient_x[at], frame->gradient_y[at], (j - first) % ASJ_STRIP_LANES,
                      &list);
        }
    }
    *sums = (asj_strip_sums){total(list.gamma), total(list.uu), total(list.un), total(list.nn), total(list.near_gamma),
                             list.pixels, list.near_pixels};
}

asj_strip_walk asj_strip_walk_along(const asj_frame *frame, const asj_strip_line *line, double half_width, double near)
{
    const double x = line->x, y = line->y;
    asj_strip_walk walk = {x, y, cos(line->angle), sin(line->angle), line->length, half_width, near, 0, 0, 0, 0, 0};
    walk.along_x = fabs(walk.ux) >= fabs(walk.uy);
    const double start = walk.along_x ? x : y, step = walk.along_x ? walk.ux : walk.uy, end = start + walk.reach * step;
    const int32_t size = walk.along_x ? frame->width : frame->height;
    walk.slope = walk.along_x ? walk.uy / walk.ux : walk.ux / walk.uy;
    walk.spread = walk.half_width / fabs(step) + 1e-6;
    walk.first = (int32_t)fmax(floor(fmin(start, end) - walk.half_width), 0);
    walk.last = (int32_t)fmin(ceil(fmax(start, end) + walk.half_width), size - 1);
    return walk;
}

asj_strip_sums asj_strip_add_up(const asj_context *context, const asj_frame *frame, const asj_strip_line *line, double half_width,
                                double near)
{
    const asj_strip_walk walk = asj_strip_walk_along(frame, line, half_width, near);
    asj_strip_sums sums;
    context->ops->strip->sums(frame, &walk, &sums);
    sums.gamma /= ASJ_GRADIENT_ONE;
    sums.near_gamma /= ASJ_GRADIENT_ONE;
    return sums;
}

static asj_strip_sums add_up(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                             const asj_strip_line *line, double near)
{
    asj_strip_line start = *line;
    start.length = fmin(line->length, options->strip_length);
    return asj_strip_add_up(context, frame, &start, options->strip_half_width, near);
}

double asj_strip_log_tests(int32_t width, int32_t height, int32_t octaves)
{
    return 1.5 * log((double)width * height) + log(octaves);
}

static double log_number_of_tests(const asj_frame *frame)
{
    return asj_strip_log_tests(frame->width, frame->height, frame->octaves);
}

/* Of a strip without a pixel, beyond the border, nothing speaks: its tail is 1. */
static double log_nfa(const asj_frame *frame, double gamma, int32_t pixels)
{
    return log_number_of_tests(frame) + (pixels ? asj_nfa_log_sector_tail(asj_nfa_tables(), gamma, pixels) : 0);
}

int asj_strip_passes(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                     const asj_strip_line *line, double shorter, double limit)
{
    const asj_strip_sums s = add_up(context, frame, options, line, shorter);
    return log_nfa(frame, s.gamma, s.pixels) <= limit || log_nfa(frame, s.near_gamma, s.near_pixels) <= limit;
}

double asj_strip_near_strength(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                               const asj_strip_line *line)
{
    asj_strip_line start = *line;
    start.length = fmin(line->length, NEAR);
    const asj_strip_sums s = add_up(context, frame, options, &start, 0);
    return asj_gamma_strength(s.gamma, s.pixels);
}

asj_strip asj_strip_test(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         const asj_strip_line *line)
{
    const asj_strip_sums s = add_up(context, frame, options, line, NEAR);
    const double near_strength = asj_gamma_strength(s.near_gamma, s.near_pixels);
    asj_strip strip = {log_nfa(frame, s.gamma, s.pixels), s.nn > 0 ? s.uu / s.nn : 0, near_strength, 1, s};
    if (s.near_pixels > 0 && s.gamma > 0)
        strip.near_share = s.near_gamma / s.near_pixels / (s.gamma / s.pixels);
    return strip;
}

const asj_strip_ops asj_strip_reference = {.sums = asj_strip_sums_of};

double asj_strip_alike(double waver, double width, double explained)
{
    const double relative = fmin(waver / NOISE_WAVER, explained > 0 ? (1 - explained) / NOISE_LEFT : HUGE_VAL);
    return 1 + ALIKE * fmax(width - INDEPENDENT_WIDTH, 0) * relative * relative;
}

double asj_strip_correlated(const asj_frame *frame, const asj_strip *strip, double width, double explained)
{
    const double log_tests = log_number_of_tests(frame), alike = asj_strip_alike(strip->waver, width, explained);
    return alike > 1 && strip->log_nfa < log_tests ? log_tests + (strip->log_nfa - log_tests) / alike : strip->log_nfa;
}
