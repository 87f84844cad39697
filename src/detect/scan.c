/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 4 for all branches of an image: the tables that rays share (ray_walk.c has the test itself), and who follows which ray.
 *
 * Rays ask for local junctions at a few pixels here and there. Vector forms compute those of 32 pixels in little more than the time
 * of one, so many rays take their steps together. */
#include "scan.h"
#include "nfa.h"

#include "ray_walk.h"
#include "scan_cache.h"
#include "core/angle.h"
#include "core/threads.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

void asj_scan_set_size(const asj_detect_options *options, int32_t width, int32_t height, asj_scan *scan)
{
    const double log_tests = 0.5 * log((double)width * height);
    const double log_p = fmin(log(options->scan_epsilon) - log_tests, 0);
    const double threshold = asj_nfa_arc_threshold(asj_nfa_tables(), log_p, 2 * options->arc_half_width + 1);
    scan->threshold = (int32_t)fmax(1, ceil(threshold * ASJ_STRENGTH_ONE));
}

void asj_scan_prepare(const asj_detect_options *options, const asj_field *field, const asj_scan_cache *cache, asj_scan *scan)
{
    const double one = (double)(1 << 30);
    scan->field = field;
    scan->cache = cache;
    scan->threshold = 1;
    scan->half_width = options->arc_half_width;
    scan->tolerance = options->scan_tolerance;
    scan->axial = options->scan_axial;
    scan->longest = 0;
    scan->rough = 0;
    for (int i = 0; i <= 256; i++) { /* from a quarter of a turn the others, and from cosines sines */
        const int16_t cosine = (int16_t)lrint(16384 * cos(ASJ_TWO_PI * i / 1024)), opposite = (int16_t)-cosine;
        scan->unit[i][0] = scan->unit[(1024 - i) % 1024][0] = cosine;
        scan->unit[512 - i][0] = scan->unit[512 + i][0] = opposite;
    }
    for (int i = 0; i < 1024; i++)
        scan->unit[i][1] = scan->unit[(i + 768) % 1024][0];
    for (int32_t r = 0; r < ASJ_SCAN_TABLE_RADIUS; r++)
        for (int32_t d = 0; d < ASJ_SCAN_TABLE_WIDTH; d++) {
            scan->arc_cosine[r][d] = r ? (int32_t)lrint(one * cos((double)d / r)) : 0;
            scan->arc_sine[r][d] = r ? (int32_t)lrint(one * sin((double)d / r)) : 0;
        }
}

#define LEAST_RAYS 4 /* for a thread: a ray takes about 5 us */
#define GROUP 64     /* rays: those that are still on their way ask for enough pixels to fill vectors */
#define LEAST_GROUP 8

/* Rays that take their steps together, and what these ask for. */
typedef struct group {
    int32_t count;
    asj_ray_walk walks[GROUP];
    asj_arc arcs[GROUP];
    asj_arc_branches branches[GROUP];
    /* pixels that the cache does not hold, where their branches are wanted, and the branches */
    int32_t missing;
    asj_pixel pixels[GROUP * ASJ_MAX_ARC];
    asj_field_branch *wanted[GROUP * ASJ_MAX_ARC];
    asj_field_branch computed[GROUP * ASJ_MAX_ARC][ASJ_FIELD_BRANCHES];
} group;

/* What a thread follows rays with. */
typedef struct follower {
    const asj_field_ops *ops;
    const asj_arc_ops *arc;
    const asj_scan *scan;
    const asj_frame *frame;
    size_t thread;
    uint16_t *scratch;
    group *rays;
    asj_watch *watch;
} follower;

/* The branches at a sample, now or when those that are missing are computed. */
static void look_up(const follower *f, asj_pixel pixel, asj_field_branch *branches)
{
    group *g = f->rays;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= f->frame->width || pixel.y >= f->frame->height) {
        memset(branches, 0, ASJ_FIELD_BRANCHES * sizeof *branches);
        return;
    }
    if (asj_scan_cache_get(f->scan->cache, f->thread, pixel, branches))
        return;
    g->pixels[g->missing] = pixel;
    g->wanted[g->missing++] = branches;
}

static void compute_missing(const follower *f)
{
    group *g = f->rays;
    f->ops->pixels(f->scan->field, f->frame, g->pixels, g->missing, f->scratch, g->computed);
    for (int32_t i = 0; i < g->missing; i++) {
        memcpy(g->wanted[i], g->computed[i], sizeof g->computed[i]);
        asj_scan_cache_put(f->scan->cache, f->thread, g->pixels[i], g->computed[i]);
    }
    g->missing = 0;
}

/* One arc for each ray; those that end leave the group. */
static void advance_group(const follower *f)
{
    const asj_scan *scan = f->scan;
    group *g = f->rays;
    int32_t left = 0;
    for (int32_t i = 0; i < g->count; i++) {
        const asj_arc *arc = &g->arcs[i];
        f->arc->place(scan, &g->walks[i].way, asj_ray_walk_next(scan, f->frame, &g->walks[i]), &g->arcs[i]);
        for (int32_t d = 0; d <= 2 * scan->half_width; d++)
            look_up(f, (asj_pixel){arc->x[d], arc->y[d]}, g->branches[i][d]);
    }
    compute_missing(f);
    for (int32_t i = 0; i < g->count; i++) {
        asj_arc_sums sums;
        f->arc->sum(scan, &g->walks[i].way, &g->arcs[i], g->branches[i], &sums);
        if (asj_ray_walk_take(scan, &sums, &g->walks[i]))
            g->walks[left++] = g->walks[i];
    }
    g->count = left;
}

/* The next ray of thread `own`: of its part of the list, then of what others have left. Neighbours in the list need the same local
 * junctions, which each thread computes for itself. next[i]: first ray of part i that nobody has taken. Returns `count` at the
 * end. */
static size_t take_ray(size_t *next, size_t threads, size_t own, size_t count)
{
    for (size_t k = 0; k < threads; k++) {
        const size_t part = (own + k) % threads, end = count * (part + 1) / threads;
        const size_t ray = __atomic_fetch_add(&next[part], 1, __ATOMIC_RELAXED);
        if (ray < end)
            return ray;
    }
    return count;
}

/* Rays that a thread has on their way at most. Of a few it leaves half to whoever is done first: some are ten times as long as
 * others. */
static int32_t most_at_once(size_t threads, size_t count)
{
    const size_t most = count / (2 * threads);
    return threads == 1 || most >= GROUP ? GROUP : most > LEAST_GROUP ? (int32_t)most : LEAST_GROUP;
}

/* next[i]: see take_ray(). */
static void follow_part(const follower *f, const asj_part *part, size_t *next, size_t threads, asj_ray *rays, size_t count)
{
    const int32_t most = most_at_once(threads, count);
    group *g = f->rays;
    g->count = g->missing = 0;
    memset(g->arcs, 0, sizeof g->arcs); /* places that are not used */
    memset(g->branches, 0, sizeof g->branches);
    for (int more = 1; more || g->count > 0;) {
        while (more && g->count < most) {
            const size_t i = take_ray(next, threads, f->thread, count);
            more = i < count;
            if (more)
                asj_ray_walk_start(&rays[i], &g->walks[g->count++]);
        }
        if (asj_watch_stops(f->watch, part))
            return;
        advance_group(f);
    }
}

/* Memory of all threads. */
typedef struct workplaces {
    const asj_scratch *scratch;
    size_t *next; /* see take_ray() */
    group *groups;
} workplaces;

typedef struct job {
    asj_context *context;
    const asj_scan *scan;
    const asj_frame *frame;
    const workplaces *w;
    asj_watch *watch;
    size_t threads;
    asj_ray *rays;
    size_t count;
} job;

/* As many followers as threads, each done once, by whoever comes; to one that comes late the others have left nothing. */
static void follow_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t i = part->first; i < part->end; i++) {
        const size_t own = (size_t)i;
        const follower f = {j->context->ops->field, j->context->ops->arc, j->scan, j->frame, own,
                            j->w->scratch->memory + own * j->w->scratch->size, &j->w->groups[own], j->watch};
        follow_part(&f, part, j->w->next, j->threads, j->rays, j->count);
    }
}

static asj_status follow_rays(asj_context *context, const asj_scan *scan, const asj_frame *frame, const workplaces *w,
                        int32_t threads, asj_ray *rays, size_t count)
{
    asj_watch watch;
    const job j = {context, scan, frame, w, &watch, (size_t)threads, rays, count};
    asj_watch_start(&watch, context, ASJ_STAGE_SCAN);
    for (int32_t i = 0; i < threads; i++)
        w->next[i] = count * (size_t)i / (size_t)threads;
    asj_parallel(context, threads, threads, 1, follow_some, &j);
    return asj_watch_end(&watch);
}

asj_status asj_scan_rays(asj_context *context, const asj_scan *scan, const asj_frame *frame, const asj_scratch *scratch,
                         asj_ray *rays, size_t count)
{
    const int32_t threads = asj_threads_for(context, (int64_t)count, LEAST_RAYS);
    asj_memory *memory = &context->memory;
    asj_status status = ASJ_OK;
    const workplaces w = {scratch, asj_allocate(memory, (size_t)threads, sizeof *w.next),
                          asj_allocate(memory, (size_t)threads, sizeof *w.groups)};
    if (w.next && w.groups)
        status = follow_rays(context, scan, frame, &w, threads, rays, count);
    else
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for following rays");
    asj_release(memory, w.groups);
    asj_release(memory, w.next);
    return status;
}

const asj_scan_ops asj_scan_reference = {.rays = asj_scan_rays};
