/* SPDX-License-Identifier: BSD-2-Clause */
/* The ray scan (ray_walk.c) follows an edge until noise has it. So an edge that fades, or that goes on as something much weaker,
 * ends where contrast, gain, noise and zoom happen to put that point. What belongs to the scene is where the edge has lost a share
 * f of its own contrast.
 *
 * Across the line the grey levels g(t, s), s = -HALF .. HALF px, less their mean, are the edge's cross-section times its contrast
 * at t. The cross-section m of unit norm is the principal direction of the means of g over blocks of BLOCK px along the branch:
 * steps, thin lines and soft edges all have one, and a change of sign (a crossing of checkerboard tiles) does not matter to it.
 * Two px to either side see enough of a step; farther out lie the other edges of acute corners. Then
 *     a(t) = |<mean of g over t - 2 .. t + 2, m>|
 * is the contrast, and the branch's own contrast c is that of the best quarter of its blocks (the value three quarters of the way
 * up). The end is found in two steps, each the change point between an edge and nothing: the T with the largest
 *     C(T) = sum over t <= T of min(max(a(t) / c - f, -w), w),   w = min(f, 1 - f),
 * which is the place of a step down, and of a slow fade where a(t) = f c, whatever noise does, since many pixels decide. The limits
 * keep single places from deciding: a gap is bridged when more edge than gap follows it.
 *   1. Over the whole branch and BEYOND px more, with the share asked for: how far the edge goes. A small share lets it go on
 *      where what lies beside it changes.
 *   2. Over the last AROUND px of that, with f = 1/2 and c that of the last LAST px: where exactly it breaks off. Of what fades
 *      slowly nothing has broken off there, and the end stays.
 * Chosen on 24 photographs and their copies (zoom, shift, blur, noise, compression, gain): BLOCK to LAST are one plateau, but
 * LAST >= 16 ends branches before last pieces as short as that. */
#include "end_profile.h"
#include "gray_at.h"

#include <stdlib.h>
#include <string.h>

#define HALF 2
#define SAMPLES (2 * HALF + 1)
#define BLOCK 8     /* px */
#define BLOCKS 24   /* of the part that says what the edge looks like, from the junction on */
#define BEYOND 8    /* px */
#define AROUND 16   /* px */
#define LAST 14     /* px */
#define MOST_FADING 100 /* px to either side */
#define SMOOTH 2    /* px to either side */
#define WIDTH (2 * SMOOTH + 1)
#define FIRST 3     /* px: what is nearer to the junction has other edges in it */
#define NOTHING 1.0 /* square of 1/ASJ_GRAY_ONE grey levels */
#define TURNS 12    /* of the power iteration: directions that far apart are told, and no other matters */

/* A branch, and what its edge looks like. */
typedef struct profile {
    const asj_frame *frame;
    double x, y, ux, uy, offset;
    double section[SAMPLES];
    int32_t count; /* blocks */
    double blocks[BLOCKS][SAMPLES];
    int32_t kept; /* samples from FIRST on that have been read */
    double levels[BLOCKS * BLOCK][SAMPLES];
} profile;

/* The grey levels across the branch, less their mean, t px from the junction. 0 outside the image. */
static int read_levels(const profile *p, int32_t t, double levels[SAMPLES])
{
    const double x = p->x + t * p->ux, y = p->y + t * p->uy;
    double mean = 0;
    if (t >= FIRST && t < FIRST + p->kept) {
        memcpy(levels, p->levels[t - FIRST], sizeof p->levels[0]);
        return 1;
    }
    if (!(x >= 0 && y >= 0 && x <= p->frame->width - 1 && y <= p->frame->height - 1))
        return 0;
    for (int32_t i = 0; i < SAMPLES; i++) {
        const double s = p->offset + (i - HALF);
        levels[i] = asj_gray_at(p->frame, x - s * p->uy, y + s * p->ux);
        mean += levels[i] / SAMPLES;
    }
    for (int32_t i = 0; i < SAMPLES; i++)
        levels[i] -= mean;
    return 1;
}

static double product(const double *a, const double *b)
{
    double sum = 0;
    for (int32_t i = 0; i < SAMPLES; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Reads the blocks' means: the last may be shorter; the only one is. */
static void read_blocks(profile *p, int32_t length)
{
    const int32_t wanted = length > FIRST + 1 ? length - FIRST : 1, size = wanted < BLOCK ? wanted : BLOCK;
    p->count = p->kept = 0;
    for (int32_t end = FIRST + size; end <= FIRST + wanted && p->count < BLOCKS; end += size) {
        double *mean = p->blocks[p->count];
        memset(mean, 0, SAMPLES * sizeof *mean);
        for (int32_t t = end - size; t < end; t++) {
            double *levels = p->levels[p->kept];
            if (!read_levels(p, t, levels))
                return;
            p->kept++;
            for (int32_t i = 0; i < SAMPLES; i++)
                mean[i] += levels[i] / size;
        }
        p->count++;
    }
}

/* The principal direction of the blocks' means, by power iteration from the largest of them. 0 when there is none. */
static int find_section(profile *p)
{
    double largest = NOTHING;
    for (int32_t k = 0; k < p->count; k++) {
        const double norm = product(p->blocks[k], p->blocks[k]);
        if (norm > largest) {
            largest = norm;
            memcpy(p->section, p->blocks[k], sizeof p->section);
        }
    }
    for (int32_t turn = 0; turn < TURNS && largest > NOTHING; turn++) {
        double next[SAMPLES] = {0};
        for (int32_t k = 0; k < p->count; k++) {
            const double part = product(p->blocks[k], p->section);
            for (int32_t i = 0; i < SAMPLES; i++)
                next[i] += part * p->blocks[k][i];
        }
        const double norm = sqrt(product(next, next));
        for (int32_t i = 0; i < SAMPLES; i++)
            p->section[i] = norm > 0 ? next[i] / norm : 0;
    }
    return largest > NOTHING;
}

static int rising(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

static double own_contrast(const profile *p)
{
    double blocks[BLOCKS];
    for (int32_t k = 0; k < p->count; k++)
        blocks[k] = fabs(product(p->blocks[k], p->section));
    qsort(blocks, (size_t)p->count, sizeof *blocks, rising);
    return blocks[(3 * p->count) / 4];
}

/* A place that walks along the branch. */
typedef struct place {
    const profile *p;
    int32_t t, last, inside; /* samples up to `last` have been read, the last that there is when not inside */
    double parts[WIDTH];     /* of the samples around t, by t modulo WIDTH */
} place;

static place start_at(const profile *p, int32_t t)
{
    place at = {p, t, t - SMOOTH - 1 < FIRST ? FIRST - 1 : t - SMOOTH - 1, 1, {0}};
    return at;
}

/* a(t); reads what it needs. Negative: there is no such sample. */
static double contrast_at(place *at)
{
    const int32_t wanted = at->t + SMOOTH;
    while (at->inside && at->last < wanted) {
        double levels[SAMPLES];
        at->inside = read_levels(at->p, at->last + 1, levels);
        if (at->inside)
            at->parts[++at->last % WIDTH] = product(levels, at->p->section);
    }
    if (at->t > at->last)
        return -1;
    const int32_t first = at->t - SMOOTH > FIRST ? at->t - SMOOTH : FIRST, last = wanted < at->last ? wanted : at->last;
    double sum = 0;
    for (int32_t t = first; t <= last; t++)
        sum += at->parts[t % WIDTH];
    return fabs(sum) / (last - first + 1);
}

/* Contrast at one t, away from a walk. */
static double contrast(const profile *p, int32_t t)
{
    place at = start_at(p, t);
    return contrast_at(&at);
}

/* Half of the mean square of the difference of neighbours: noise, and nothing of what changes slowly. */
static double noise_of(const profile *p, int32_t length)
{
    double levels[SAMPLES], before = 0, sum = 0;
    int32_t count = 0;
    for (int32_t t = FIRST; t < length && t < FIRST + BLOCKS * BLOCK && read_levels(p, t, levels); t++, count++) {
        const double next = product(levels, p->section);
        sum += count > 0 ? (next - before) * (next - before) : 0;
        before = next;
    }
    return count > 1 ? sqrt(0.5 * sum / (count - 1)) : 0;
}

/* px around t = end in which the contrast lies between the two levels. */
static double fading_around(const profile *p, int32_t end, double high, double low)
{
    int32_t before = end, after = end;
    while (before > FIRST && before > end - MOST_FADING && contrast(p, before) < high)
        before--;
    while (after < end + MOST_FADING && contrast(p, after) > low)
        after++;
    return after - before;
}

/* The change point between contrast `own` and nothing, where `share` of it is left, from `first` to `last`; -1 = nothing all the
 * way. */
static int32_t change_point(const profile *p, double own, double share, int32_t first, int32_t last)
{
    const double limit = fmin(share, 1 - share);
    double sum = 0, most = 0;
    int32_t end = -1;
    place at = start_at(p, first);
    for (; at.t <= last; at.t++) {
        const double a = contrast_at(&at);
        if (a < 0)
            break;
        sum += fmin(fmax(a / own - share, -limit), limit);
        if (sum > most) {
            most = sum;
            end = at.t;
        }
    }
    return end;
}

/* Where the edge that reaches to t = end breaks off. *own: its contrast there. */
static int32_t break_before(const profile *p, int32_t end, double *own)
{
    double before[LAST + 1];
    int32_t count = 0;
    place at = start_at(p, end - LAST > FIRST ? end - LAST : FIRST);
    for (; at.t <= end; at.t++)
        before[count++] = contrast_at(&at);
    qsort(before, (size_t)count, sizeof *before, rising);
    *own = before[(3 * count) / 4];
    return *own > 0 ? change_point(p, *own, 0.5, end - AROUND > FIRST ? end - AROUND : FIRST, end) : -1;
}

asj_end_profile asj_end_profile_of(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch,
                                   double share)
{
    asj_end_profile result = {0, 0, 0};
    const int32_t length = (int32_t)lrint(branch->length);
    profile p;
    p.frame = frame;
    p.x = hypothesis->x;
    p.y = hypothesis->y;
    p.ux = cos(branch->angle);
    p.uy = sin(branch->angle);
    p.offset = branch->offset;
    read_blocks(&p, length);
    if (p.count < 1 || !find_section(&p))
        return result;
    double own = own_contrast(&p);
    if (!(own > 0)) /* flat but for a block or two: no contrast to take a share of */
        return result;
    const int32_t reach = change_point(&p, own, share, FIRST, length + BEYOND);
    const int32_t end = reach < 0 ? -1 : break_before(&p, reach, &own);
    if (end < 0)
        return result;
    result.end = end + 0.5;
    result.noise = noise_of(&p, length) / own;
    result.fading = fading_around(&p, end, 0.75 * own, 0.25 * own);
    return result;
}
