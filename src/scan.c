/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 4: branch lengths (paper sections "Differential Junction-ness Model" to "Modified Probabilistic Distribution").
 *
 * At radius r the ray's arc is sampled at  a_d = theta + d / r,  d = -w .. w  (w = arc_half_width, about one pixel apart):
 *     q_d = p + r (cos a_d, sin a_d), rounded to a pixel,
 *     gamma~_d = omega_q^i max(|cos(theta_q^i - a_d)| - |sin(theta_q^i - a_d)|, 0)      (eq. junction-ness-pairwise-modified)
 * where (theta_q^i, omega_q^i) is that branch of the local junction at q whose angle is closest to theta. The derivative of the
 * junction-ness along r is S_r = sum of gamma~_d (the terms in delta'(r) are dropped, as in the paper). The step belongs to the
 * branch when  sqrt(NM) P(S >= S_r) <= scan_epsilon  with P the (2 w + 1)-fold tail of p~ (nfa.c, eq. probability-updated); that is
 * a threshold on S_r, computed once. A step without any local branch never passes (the threshold is positive).
 *
 * Using local junctions instead of gradients is what lets a branch cross other junctions: at a crossing most pixels still have one
 * branch along the ray.
 *
 * Departures (options that restore the paper in brackets):
 *   - the ray survives one failing step (scan_tolerance = 0), which random crossings need;
 *   - it starts at radius 3, not at the isotropic scale (scan_start = 0), so that the length depends on nothing else;
 *   - "closest" is taken twice, modulo 2 pi (forward) and modulo pi (axial), and the length is the mean of both (scan_axial = no).
 *     The forward branch of a pixel dies about 2.6 px before the edge's end, when its sector leaves the edge; the axial one, which
 *     may look back, lives about 4 px longer. Their mean is within a pixel of the truth. While the axial test passes, the forward
 *     one may fail for up to the field's radius and come back: at the crossing of two thin lines no branch looks forward for a few
 *     pixels. A branch that looks back along the ray does not count as forward then, though |cos| would let it;
 *   - not every step is looked at, since most of a long edge is beyond doubt (scan_tolerance = 0). While nothing fails, steps with
 *     a plain edge under them pass: sum of gamma, as in sector.c, over three pixels across, of at least 1.2. So do steps before one
 *     that passes, four farther on. In the sample room and four photographs about one in a hundred of the steps that pass unseen
 *     would have failed, and one in five hundred together with the next, which alone would have ended the ray.
 *
 * Whole numbers throughout, so that every back end takes the same decisions: positions in 1/65536 px, unit vectors in 2^-30 for
 * positions and 2^-14 for angles, angles in 1/65536 of a turn. */
#include "scan.h"

#include "ops.h"
#include "scan_cache.h"
#include "threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#define TWO_PI 6.283185307179586

void asj_scan_set_size(const asj_context *context, const asj_detect_options *options, int32_t width, int32_t height, asj_scan *scan)
{
    const double log_tests = 0.5 * log((double)width * height);
    const double log_p = fmin(log(options->scan_epsilon) - log_tests, 0);
    const double threshold = asj_nfa_arc_threshold(context->nfa, log_p, 2 * options->arc_half_width + 1);
    scan->threshold = (int32_t)fmax(1, ceil(threshold * ASJ_STRENGTH_ONE));
}

void asj_scan_prepare(const asj_context *context, const asj_detect_options *options, const asj_field *field,
                      int32_t width, int32_t height, asj_scan *scan)
{
    const double one = (double)(1 << 30);
    scan->field = field;
    scan->cache = NULL;
    scan->half_width = options->arc_half_width;
    scan->tolerance = options->scan_tolerance;
    scan->axial = options->scan_axial;
    for (int i = 0; i < 1024; i++) {
        scan->unit[i][0] = (int16_t)lrint(16384 * cos(TWO_PI * i / 1024));
        scan->unit[i][1] = (int16_t)lrint(16384 * sin(TWO_PI * i / 1024));
    }
    for (int32_t r = 0; r < ASJ_SCAN_TABLE_RADIUS; r++)
        for (int32_t d = 0; d < ASJ_SCAN_TABLE_WIDTH; d++) {
            scan->arc_cosine[r][d] = r ? (int32_t)lrint(one * cos((double)d / r)) : 0;
            scan->arc_sine[r][d] = r ? (int32_t)lrint(one * sin((double)d / r)) : 0;
        }
    asj_scan_set_size(context, options, width, height, scan);
}

#define MAX_ARC 7 /* 2 arc_half_width + 1 */

typedef struct walker {
    const asj_ops *ops;
    const asj_scan *scan;
    const asj_frame *frame;
    const asj_scan_cache *cache;
    size_t thread;
    uint16_t *scratch;
    /* of each sample of the arc: the run it was in last; neighbouring steps are mostly in the same */
    uint32_t keys[MAX_ARC];
    const asj_field_branch (*runs[MAX_ARC])[ASJ_FIELD_BRANCHES];
} walker;

/* The local junctions of run `block` of row y. */
static const asj_field_branch (*run_at(walker *w, uint32_t key, int32_t block, int32_t y))[ASJ_FIELD_BRANCHES]
{
    const size_t slot = (w->thread << w->cache->bits) + (key * 2654435769u >> (32 - w->cache->bits)); /* Fibonacci hashing */
    if (w->cache->keys[slot] != key) {
        w->ops->field_block(w->scan->field, w->frame, block * ASJ_LANES, y, w->scratch, w->cache->branches[slot]);
        w->cache->keys[slot] = key;
        memset(w->keys, 0, sizeof w->keys); /* one of them may have been there */
    }
    return (const asj_field_branch (*)[ASJ_FIELD_BRANCHES])w->cache->branches[slot];
}

/* The branches of the pixel where sample i of the arc is; all of strength 0 outside the image. */
static const asj_field_branch *branches_at(walker *w, int32_t i, int64_t x, int64_t y)
{
    static const asj_field_branch none[ASJ_FIELD_BRANCHES];
    if (x < 0 || y < 0 || x >= w->frame->width || y >= w->frame->height)
        return none;
    const uint32_t key = (uint32_t)y * (uint32_t)w->frame->blocks + (uint32_t)x / ASJ_LANES + 1;
    if (w->keys[i] != key) {
        w->runs[i] = run_at(w, key, (int32_t)(x / ASJ_LANES), (int32_t)y);
        w->keys[i] = key;
    }
    return w->runs[i][x % ASJ_LANES];
}

/* Direction of a sample of the arc, and where it is. */
typedef struct sample {
    int64_t x, y;
    int32_t cosine, sine; /* of a_d, 1 = 16384 */
} sample;

#define REOPEN 3 /* steps in a row that must look ahead again after a crossing; one or two happen by chance in noise */

/* d / r turned into a rotation: cos and sin in 2^-30. One table of them for all rays, since r is a whole number; beyond the table
 * the arc is straight to within 0.01 px. */
static sample place(const asj_scan *scan, const asj_ray_direction *ray, int32_t r, int32_t d)
{
    const int32_t size = d < 0 ? -d : d;
    const int in_table = r < ASJ_SCAN_TABLE_RADIUS;
    const int64_t c = in_table ? scan->arc_cosine[r][size] : (int64_t)1 << 30;
    int64_t s = in_table ? scan->arc_sine[r][size] : ((int64_t)size << 30) / r;
    if (d < 0)
        s = -s;
    /* (cos a_d, sin a_d) = (c ux - s uy, c uy + s ux) */
    int64_t ex = (c * ray->ux - s * ray->uy) >> 30, ey = (c * ray->uy + s * ray->ux) >> 30;
    sample out;
    out.x = (ray->x + ((r * ex) >> 14) + 32768) >> 16;
    out.y = (ray->y + ((r * ey) >> 14) + 32768) >> 16;
    out.cosine = (int32_t)(ex >> 16);
    out.sine = (int32_t)(ey >> 16);
    return out;
}

/* gamma~ of one local branch seen from the ray, in 1/256 standard deviations; *ahead tells whether it points along the ray. */
static int32_t junctionness(const asj_scan *scan, asj_field_branch branch, const sample *at, int *ahead)
{
    const int16_t *unit = scan->unit[(branch.angle + 32) >> 6 & 1023];
    const int32_t along = unit[0] * at->cosine + unit[1] * at->sine;
    const int32_t across = unit[0] * at->sine - unit[1] * at->cosine;
    const int32_t gamma = ((abs(along) - abs(across)) >> 14) * branch.strength >> 14;
    *ahead = along > 0;
    return gamma > 0 ? gamma : 0;
}

/* Which branches are closest to the ray's direction, modulo 2 pi and modulo pi; of equals the strongest. Branches that are none
 * come last. No jumps: which branch it is cannot be predicted. */
static void closest(const asj_field_branch *list, uint16_t angle, int32_t *forward, int32_t *axial)
{
    int32_t nearest = INT32_MAX, nearest_axis = INT32_MAX; /* 4 x distance + index */
    for (int32_t i = 0; i < ASJ_FIELD_BRANCHES; i++) {
        const int32_t turn = (uint16_t)(list[i].angle - angle), none = list[i].strength ? 0 : 1 << 20;
        const int32_t distance = turn > 32768 ? 65536 - turn : turn, axis = distance > 16384 ? 32768 - distance : distance;
        const int32_t order = (distance | none) * ASJ_FIELD_BRANCHES + i, axis_order = (axis | none) * ASJ_FIELD_BRANCHES + i;
        nearest = order < nearest ? order : nearest;
        nearest_axis = axis_order < nearest_axis ? axis_order : nearest_axis;
    }
    *forward = nearest % ASJ_FIELD_BRANCHES;
    *axial = nearest_axis % ASJ_FIELD_BRANCHES;
}

/* Sums over the arc at one radius. */
typedef struct arc {
    int32_t forward, ahead, axial; /* of the forward branches; of those among them that point ahead; of the axial branches */
} arc;

static arc arc_sums(walker *w, const asj_ray_direction *way, int32_t r)
{
    const asj_scan *scan = w->scan;
    arc sums = {0, 0, 0};
    for (int32_t i = 0; i <= 2 * scan->half_width; i++) {
        const sample at = place(scan, way, r, i - scan->half_width);
        const asj_field_branch *list = branches_at(w, i, at.x, at.y);
        int32_t forward, axial;
        int ahead, ignored;
        closest(list, way->angle, &forward, &axial);
        const int32_t gamma = junctionness(scan, list[forward], &at, &ahead);
        sums.forward += gamma;
        sums.ahead += ahead ? gamma : 0;
        sums.axial += junctionness(scan, list[axial], &at, &ignored);
    }
    sums.axial = scan->axial ? sums.axial : 0;
    return sums;
}

/* What a walk along a ray has come to. */
typedef struct progress {
    int32_t forward_failures, ahead_passes, ahead_failures, axial_failures; /* in a row */
} progress;

/* Takes the step to radius r; 0 when the ray ends. */
static int advance(const asj_scan *scan, const arc *sums, int32_t bridge, int32_t r, progress *p, asj_ray *ray)
{
    p->ahead_passes = sums->ahead >= scan->threshold ? p->ahead_passes + 1 : 0;
    p->ahead_failures = p->ahead_passes ? 0 : p->ahead_failures + 1;
    p->axial_failures = sums->axial >= scan->threshold ? 0 : p->axial_failures + 1;
    if (p->ahead_passes >= REOPEN)
        p->forward_failures = 0; /* back after a crossing */
    else if (sums->forward < scan->threshold || p->forward_failures > scan->tolerance)
        p->forward_failures++;
    else
        p->forward_failures = 0;
    if (p->forward_failures == 0)
        ray->forward = r;
    if (p->axial_failures == 0)
        ray->axial = r;
    return p->forward_failures <= scan->tolerance || (p->ahead_failures <= bridge && p->axial_failures <= scan->tolerance);
}

/* Whether a step passes in every way. */
static int passes(const asj_scan *scan, const arc *sums)
{
    return sums->ahead >= scan->threshold && (!scan->axial || sums->axial >= scan->threshold);
}

asj_ray_direction asj_scan_direction(const asj_ray *ray)
{
    const double one = (double)((int64_t)1 << 30);
    return (asj_ray_direction){llrint(ray->x * 65536), llrint(ray->y * 65536), llrint(cos(ray->angle) * one),
                               llrint(sin(ray->angle) * one), (uint16_t)llrint(ray->angle * (65536 / TWO_PI))};
}

void asj_scan_finish(const asj_scan *scan, asj_ray *ray)
{
    const int32_t bridge = scan->field->sectors.radius;
    if (scan->axial && ray->axial > ray->forward + bridge)
        ray->axial = ray->forward + bridge;
}

#define STRIDE 4 /* steps to the next one that is looked at, while nothing fails */
#define PLAIN 4  /* steps before the end of a plain edge that are looked at all the same: there the branch may end */

/* Whether there is an edge along the ray at radius r: three pixels across, rounded. The border's margin is zero. */
static int has_edge(const asj_frame *frame, const asj_ray_direction *way, int32_t r)
{
    const int64_t x = way->x + ((r * way->ux) >> 14) + 32768, y = way->y + ((r * way->uy) >> 14) + 32768;
    const int64_t across_x = -(way->uy >> 14), across_y = way->ux >> 14;
    const int32_t ux = (int32_t)(way->ux >> 16), uy = (int32_t)(way->uy >> 16);
    int32_t sum = 0;
    if (x >> 16 < 0 || y >> 16 < 0 || x >> 16 >= frame->width || y >> 16 >= frame->height)
        return 0;
    for (int32_t d = -1; d <= 1; d++) {
        const ptrdiff_t at = (ptrdiff_t)((y + d * across_y) >> 16) * frame->stride + (ptrdiff_t)((x + d * across_x) >> 16);
        const int32_t gx = frame->gradient_x[at], gy = frame->gradient_y[at];
        const int32_t gamma = abs(gy * ux - gx * uy) - abs(gx * ux + gy * uy);
        sum += gamma > 0 ? gamma : 0;
    }
    return sum >= ASJ_SCAN_EDGE;
}

/* Passes over the steps from r on that have an edge under them beyond doubt; returns the first one that must be looked at. */
static int32_t pass_over(const walker *w, const asj_ray_direction *way, int32_t r, progress *p, asj_ray *ray)
{
    int32_t end = r;
    while (has_edge(w->frame, way, end))
        end++;
    if (end - r <= PLAIN)
        return r;
    ray->forward = end - PLAIN - 1;
    ray->axial = w->scan->axial ? ray->forward : 0;
    p->ahead_failures = 0;
    return end - PLAIN;
}

/* looked: the last step that is to be looked at by itself, since a stride to it has failed. */
static void walk(walker *w, asj_ray *ray)
{
    const asj_scan *scan = w->scan;
    const asj_ray_direction way = asj_scan_direction(ray);
    const int32_t bridge = scan->axial ? scan->field->sectors.radius : -1;
    progress p = {0, 0, 0, 0};
    arc far = {0, 0, 0};
    int goes_on = 1;
    ray->forward = ray->axial = 0;
    for (int32_t r = ray->start > 0 ? ray->start : 1, looked = 0; goes_on;) {
        arc sums;
        int32_t stride = 1;
        if (r > looked && scan->tolerance > 0 && p.forward_failures == 0 && (!scan->axial || p.axial_failures == 0)) {
            r = pass_over(w, &way, r, &p, ray);
            looked = r + STRIDE - 1;
            far = arc_sums(w, &way, looked);
            stride = passes(scan, &far) ? STRIDE : 0;
            sums = far;
        } else {
            sums = r == looked ? far : arc_sums(w, &way, r);
        }
        if (stride > 0)
            goes_on = advance(scan, &sums, bridge, r + stride - 1, &p, ray);
        r += stride;
    }
    asj_scan_finish(scan, ray);
}

/* The next ray of thread `own`: of its part of the list, then of what others have left. Neighbours in the list need the same local
 * junctions, which each thread computes for itself. next[i]: first ray of part i that nobody has taken. Returns `count` at the
 * end. */
static size_t take_ray(size_t *next, size_t threads, size_t own, size_t count)
{
    for (size_t k = 0; k < threads; k++) {
        const size_t part = (own + k) % threads, end = count * (part + 1) / threads;
        size_t ray;
#ifdef _OPENMP
#pragma omp atomic capture
#endif
        ray = next[part]++;
        if (ray < end)
            return ray;
    }
    return count;
}

static void follow_rays(const asj_context *context, const asj_scan *scan, const asj_frame *frame, const asj_scan_cache *cache,
                        uint16_t *scratch, size_t *next, int32_t threads, asj_ray *rays, size_t count)
{
    for (int32_t i = 0; i < threads; i++)
        next[i] = count * (size_t)i / (size_t)threads;
#ifdef _OPENMP
#pragma omp parallel num_threads(threads)
#endif
    {
        size_t thread = 0;
#ifdef _OPENMP
        thread = (size_t)omp_get_thread_num();
#endif
        walker w = {context->ops, scan, frame, cache, thread, scratch + thread * asj_field_scratch(scan->field), {0}, {NULL}};
        for (size_t i = take_ray(next, (size_t)threads, thread, count); i < count;
             i = take_ray(next, (size_t)threads, thread, count))
            walk(&w, &rays[i]);
    }
}

asj_status asj_scan_rays(asj_context *context, const asj_scan *scan, const asj_frame *frame, asj_ray *rays, size_t count)
{
    const int32_t threads = asj_threads_for(context, (int64_t)count, 2); /* a ray takes about 20 us */
    asj_status status = ASJ_OK;
    asj_scan_cache own = {0};
    const asj_scan_cache *cache = scan->cache;
    if (!cache) {
        status = asj_scan_cache_prepare(context, frame, threads, &own);
        cache = &own;
    }
    uint16_t *scratch = asj_allocate(&context->memory, (size_t)threads * asj_field_scratch(scan->field), sizeof *scratch);
    size_t *next = asj_allocate(&context->memory, (size_t)threads, sizeof *next);
    if (status == ASJ_OK && scratch && next)
        follow_rays(context, scan, frame, cache, scratch, next, threads, rays, count);
    else if (status == ASJ_OK)
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for following rays");
    asj_release(&context->memory, next);
    asj_release(&context->memory, scratch);
    asj_scan_cache_free(&context->memory, &own);
    return status;
}
