/* SPDX-License-Identifier: BSD-2-Clause */
/* The ray scan (ray_walk.c) follows an edge until noise has it. So a fading edge ends where contrast, gain, noise and zoom happen
 * to put that point. What belongs to the scene is where the edge has lost a share of its own contrast.
 *
 * Across the line the grey levels g(t, s), s = -HALF .. HALF px, less their mean, are the edge's cross-section times its contrast
 * at t. The cross-section m of unit norm is the principal direction of the means of g over blocks of BLOCK px along the branch:
 * steps, thin lines and soft edges all have one, and a change of sign (a crossing of checkerboard tiles) does not matter to it.
 * Then
 *     a(t) = |<mean of g over t - 2 .. t + 2, m>|
 * is the contrast, and the branch's own contrast c is that of the best quarter of its blocks (the value three quarters of the way
 * up). The end is the T with the largest
 *     C(T) = sum over t <= T of min(max(a(t) / c - f, -w), w),   w = min(f, 1 - f),
 * the change point between an edge of contrast c and nothing: for a step down its place, for a slow fade where a(t) = f c,
 * whatever noise does, since many pixels decide. The limits keep single places from deciding: a gap of n px is bridged when more
 * than n px of edge follow it, up to GAP px. The sum begins WINDOW px before the end of the scan and may go that far beyond. */
#include "end_profile.h"
#include "gray_at.h"

#include <stdlib.h>
#include <string.h>

#define HALF 3
#define SAMPLES (2 * HALF + 1)
#define BLOCK 8     /* px */
#define WINDOW 192  /* px */
#define GAP 8       /* px */
#define SMOOTH 2    /* px to either side */
#define FIRST 3     /* px: what is nearer to the junction has other edges in it */
#define NOTHING 1.0 /* square of 1/ASJ_GRAY_ONE grey levels */
#define TURNS 12    /* of the power iteration: directions that far apart are told, and no other matters */

/* The strip of grey levels along a branch: sample i lies t = first + i px from the junction. Beyond the branch they are read when
 * they are asked for: mostly a few are. */
typedef struct profile {
    const asj_frame *frame;
    double x, y, ux, uy, offset;
    double levels[2 * WINDOW][SAMPLES];
    int32_t first, count, own; /* samples, and how many of them belong to the branch */
    int inside;                /* whether the image goes on behind the last */
    double section[SAMPLES];
} profile;

static int is_inside(const asj_frame *frame, double x, double y)
{
    return x >= 0 && y >= 0 && x <= frame->width - 1 && y <= frame->height - 1;
}

/* Reads samples until there are `wanted`, or the image ends. */
static void read_levels(profile *p, int32_t wanted)
{
    const double ux = p->ux, uy = p->uy;
    for (; p->count < wanted && p->inside; p->count++) {
        const double t = p->first + p->count, x = p->x + t * ux, y = p->y + t * uy;
        double *levels = p->levels[p->count], mean = 0;
        p->inside = is_inside(p->frame, x, y);
        if (!p->inside)
            return;
        for (int32_t i = 0; i < SAMPLES; i++) {
            const double s = p->offset + (i - HALF);
            levels[i] = asj_gray_at(p->frame, x - s * uy, y + s * ux);
            mean += levels[i] / SAMPLES;
        }
        for (int32_t i = 0; i < SAMPLES; i++)
            levels[i] -= mean;
    }
}

/* Whether there is a sample `at`, within the longest profile; reads up to it and those around it that its contrast needs. */
static int has_sample(profile *p, int32_t at)
{
    read_levels(p, at + SMOOTH + 1 < 2 * WINDOW ? at + SMOOTH + 1 : 2 * WINDOW);
    return at < p->count;
}

static double product(const double *a, const double *b)
{
    double sum = 0;
    for (int32_t i = 0; i < SAMPLES; i++)
        sum += a[i] * b[i];
    return sum;
}

/* The mean of `count` samples from number `first` on. */
static void mean_of(const profile *p, int32_t first, int32_t count, double mean[SAMPLES])
{
    memset(mean, 0, SAMPLES * sizeof *mean);
    for (int32_t k = first; k < first + count; k++)
        for (int32_t i = 0; i < SAMPLES; i++)
            mean[i] += p->levels[k][i] / count;
}

/* The principal direction of the blocks' means, by power iteration from the largest of them. 0 when there is none. */
static int find_section(profile *p)
{
    double blocks[WINDOW / BLOCK][SAMPLES], largest = NOTHING;
    const int32_t size = p->own < BLOCK ? p->own : BLOCK, count = p->own / size;
    for (int32_t k = 0; k < count; k++) {
        mean_of(p, k * size, size, blocks[k]);
        const double norm = product(blocks[k], blocks[k]);
        if (norm > largest) {
            largest = norm;
            memcpy(p->section, blocks[k], sizeof p->section);
        }
    }
    for (int32_t turn = 0; turn < TURNS && largest > NOTHING; turn++) {
        double next[SAMPLES] = {0};
        for (int32_t k = 0; k < count; k++) {
            const double part = product(blocks[k], p->section);
            for (int32_t i = 0; i < SAMPLES; i++)
                next[i] += part * blocks[k][i];
        }
        const double norm = sqrt(product(next, next));
        for (int32_t i = 0; i < SAMPLES; i++)
            p->section[i] = norm > 0 ? next[i] / norm : 0;
    }
    return largest > NOTHING;
}

/* At a sample that there is: has_sample(). */
static double contrast(const profile *p, int32_t at)
{
    double mean[SAMPLES];
    const int32_t first = at > SMOOTH ? at - SMOOTH : 0, end = at + SMOOTH + 1 < p->count ? at + SMOOTH + 1 : p->count;
    mean_of(p, first, end - first, mean);
    return fabs(product(mean, p->section));
}

static int rising(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

static double own_contrast(const profile *p)
{
    double blocks[WINDOW / BLOCK];
    const int32_t size = p->own < BLOCK ? p->own : BLOCK, count = p->own / size;
    for (int32_t k = 0; k < count; k++) {
        double mean[SAMPLES];
        mean_of(p, k * size, size, mean);
        blocks[k] = fabs(product(mean, p->section));
    }
    qsort(blocks, (size_t)count, sizeof *blocks, rising);
    return blocks[(3 * count) / 4 < count ? (3 * count) / 4 : count - 1];
}

/* Half of the mean square of the difference of neighbours: noise, and nothing of what changes slowly. */
static double noise_of(const profile *p)
{
    double before = product(p->levels[0], p->section), sum = 0;
    for (int32_t k = 1; k < p->own; k++) {
        const double next = product(p->levels[k], p->section);
        sum += (next - before) * (next - before);
        before = next;
    }
    return p->own > 1 ? sqrt(0.5 * sum / (p->own - 1)) : 0;
}

/* px around sample `end` in which the contrast lies between the two levels. */
static double fading_around(profile *p, int32_t end, double high, double low)
{
    int32_t before = end, after = end;
    while (before > 0 && contrast(p, before) < high)
        before--;
    while (has_sample(p, after + 1) && contrast(p, after) > low)
        after++;
    return after - before;
}

asj_end_profile asj_end_profile_of(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch,
                                   double share)
{
    asj_end_profile result = {0, 0, 0, 0};
    const int32_t length = (int32_t)lrint(branch->length);
    profile p;
    p.frame = frame;
    p.x = hypothesis->x;
    p.y = hypothesis->y;
    p.ux = cos(branch->angle);
    p.uy = sin(branch->angle);
    p.offset = branch->offset;
    p.first = length - WINDOW > FIRST ? length - WINDOW : FIRST;
    p.count = 0;
    p.inside = 1;
    read_levels(&p, (length > FIRST ? length : FIRST + 1) - p.first);
    p.own = p.count;
    if (p.own < 1 || !find_section(&p))
        return result;
    const double own = own_contrast(&p), limit = fmin(share, 1 - share);
    if (!(own > 0)) /* flat but for a block or two: no contrast to take a share of */
        return result;
    double sum = 0, most = 0;
    int32_t end = -1, at = 0;
    for (; sum > most - GAP * limit && has_sample(&p, at); at++) {
        sum += fmin(fmax(contrast(&p, at) / own - share, -limit), limit);
        if (sum > most) {
            most = sum;
            end = at;
        }
    }
    if (end < 0)
        return result;
    result.at_border = !p.inside && end >= p.count - 1 - SMOOTH;
    result.end = p.first + end + 0.5;
    result.noise = noise_of(&p) / own;
    result.fading = fading_around(&p, end, 0.75 * own, 0.25 * own);
    return result;
}
