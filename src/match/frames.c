/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, preparation: length hypotheses, and the frames of L-junctions.
 *
 * A branch that passes other junctions may end at one of them in the other image: occlusion, weak contrast and crossing lines all
 * cut or prolong the scan. So besides its own length a branch is given, longest first, the distances of other junctions that lie
 * within 3 px of it, at least 10 px from its start and 8 px before its end, and 4 px apart. Every combination of both branches'
 * lengths is one frame.
 *
 * In a fine pattern that repeats every branch passes so many that most L-junctions have all the frames they may. Those tell nothing
 * there, where all look alike, and are what takes the time (rank.c compares each with each): then all have their own lengths alone.
 * (Two pictures of a chessboard of 8 px, 18 500 L-junctions with 8.5 of 9 frames each: 118 s for the distances, 9 s so. Sixteen
 * pairs of photographs have up to 5.2 frames for an L-junction.) */
#include "frames.h"
#include "core/watch.h"

#include <math.h>

#define LEAST_LENGTH 3.0     /* px: a shorter branch has no direction worth a frame */
#define RAY_DISTANCE 3.0     /* px */
#define LEAST_START 10.0     /* px */
#define LEAST_BEFORE_END 8.0 /* px */
#define LEAST_APART 4.0      /* px */
#define LEAST_L_JUNCTIONS 32 /* for a thread */
#define MANY_FRAMES 0x10000  /* of an image, */
#define FULL_SHARE 0.85      /* .. and as many of those that its L-junctions may have: a pattern that repeats */

static asj_status no_memory(asj_context *context)
{
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the frames of an image");
}

/* Appends extra lengths, falling, LEAST_APART from each other. */
static void find_lengths(const asj_location_grid *grid, double x, double y, const double u[2], double own, int32_t limit,
                         asj_lengths *lengths)
{
    lengths->count = 1;
    lengths->length[0] = (float)own;
    double before = own - LEAST_BEFORE_END;
    while (lengths->count < limit) { /* the longest one not longer than `before` */
        const double best = asj_location_grid_last(grid, x, y, u, LEAST_START, before, RAY_DISTANCE);
        if (best <= 0)
            return;
        lengths->length[lengths->count++] = (float)best;
        before = best - LEAST_APART;
    }
}

/* Unit vector and length of the branch that ends at (ex, ey). */
static double direct(const asj_l_junction *l, float ex, float ey, double u[2])
{
    double dx = (double)ex - (double)l->x, dy = (double)ey - (double)l->y, length = sqrt(dx * dx + dy * dy);
    u[0] = length > 0 ? dx / length : 1;
    u[1] = length > 0 ? dy / length : 0;
    return length;
}

static void prepare(asj_l_junctions *all, const asj_location_grid *grid, uint32_t i, int32_t limit)
{
    const asj_l_junction *l = &all->l[i];
    double *u = all->direction + 4 * (size_t)i;
    double a = direct(l, l->ax, l->ay, u), b = direct(l, l->bx, l->by, u + 2);
    if (a < LEAST_LENGTH || b < LEAST_LENGTH) {
        all->lengths[2 * i] = (asj_lengths){0, {(float)a}, 0};
        all->lengths[2 * i + 1] = (asj_lengths){0, {(float)b}, 0};
        return;
    }
    find_lengths(grid, (double)l->x, (double)l->y, u, a, limit, &all->lengths[2 * i]);
    find_lengths(grid, (double)l->x, (double)l->y, u + 2, b, limit, &all->lengths[2 * i + 1]);
}

/* Numbers the frames. Returns how many there are. */
static uint32_t number_frames(asj_l_junctions *all)
{
    uint32_t total = 0;
    for (uint32_t i = 0; i < all->count; i++) {
        all->first_frame[i] = total;
        total += (uint32_t)(all->lengths[2 * i].count * all->lengths[2 * i + 1].count);
    }
    all->first_frame[all->count] = all->frame_count = total;
    return total;
}

static void keep_own_lengths(asj_l_junctions *all)
{
    for (uint32_t k = 0; k < 2 * all->count; k++)
        if (all->lengths[k].count > 1)
            all->lengths[k].count = 1;
}

static void fill_frames(asj_l_junctions *all)
{
    for (uint32_t i = 0; i < all->count; i++) {
        const double *u = all->direction + 4 * (size_t)i;
        const asj_lengths *a = &all->lengths[2 * i], *b = &all->lengths[2 * i + 1];
        asj_affine_frame *frame = all->frames + all->first_frame[i];
        for (int32_t m = 0; m < a->count; m++)
            for (int32_t n = 0; n < b->count; n++) {
                double p = (double)a->length[m], q = (double)b->length[n];
                *frame++ = (asj_affine_frame){(double)all->l[i].x, (double)all->l[i].y,
                                              p * u[0], p * u[1], q * u[2], q * u[3]};
            }
    }
}

/* All that the L-junctions share. */
typedef struct job {
    asj_l_junctions *all;
    const asj_location_grid *grid;
    int32_t limit; /* lengths of a branch */
    asj_watch *watch;
} job;

static void prepare_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++)
        prepare(j->all, j->grid, (uint32_t)i, j->limit);
}

asj_status asj_frames_make(asj_context *context, const asj_match_options *options, const asj_location_grid *grid,
                           asj_l_junctions *all)
{
    asj_memory *memory = &context->memory;
    all->lengths = asj_allocate(memory, 2 * (size_t)all->count, sizeof *all->lengths);
    all->direction = asj_allocate(memory, 4 * (size_t)all->count, sizeof *all->direction);
    all->first_frame = asj_allocate(memory, (size_t)all->count + 1, sizeof *all->first_frame);
    if (!all->lengths || !all->direction || !all->first_frame)
        return no_memory(context);
    asj_watch watch;
    const job j = {all, grid, options->length_hypotheses, &watch};
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    asj_parallel(context, asj_threads_for(context, all->count, LEAST_L_JUNCTIONS), all->count, 0, prepare_some, &j);
    if (watch.stopped)
        return asj_watch_end(&watch);
    const double most = (double)j.limit * j.limit * all->count;
    uint32_t total = number_frames(all);
    if (total > MANY_FRAMES && total > FULL_SHARE * most) {
        keep_own_lengths(all);
        total = number_frames(all);
    }
    all->frames = asj_allocate(memory, total, sizeof *all->frames);
    if (!all->frames)
        return no_memory(context);
    fill_frames(all);
    return ASJ_OK;
}
