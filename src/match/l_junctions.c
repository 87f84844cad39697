/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, preparation: from junctions to L-junctions with frames, length hypotheses, locations and neighbours.
 *
 * Length hypotheses. A branch that passes other junctions may end at one of them in the other image: occlusion, weak contrast and
 * crossing lines all cut or prolong the scan. So besides its own length a branch is given, longest first, the distances of other
 * junctions that lie within 3 px of it, at least 10 px from its start and 8 px before its end, and 4 px apart. Every
 * combination of both branches' lengths is one frame.
 *
 * Matches are unique by location, and "another location" in the ratio test means farther than `separation`.
 * Neighbours of a location are the nearest others farther than `separation`, so that a cluster of duplicates is no neighbour of
 * itself. Guests (guests.c) are nobody's neighbours and lengthen no branch, so that others are as they are without them. */
#include "l_junctions.h"
#include "location_grid.h"
#include "core/angle.h"
#include "core/watch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_L_JUNCTIONS 0x1000000 /* frames, up to sixteen for each, are numbered in 32 bits */
#define MOST_OUTSIDE ((float)ASJ_MAX_OUTSIDE) /* px: where branches meet may lie a little outside the image */
#define LEAST_LENGTH 3.0     /* px: a shorter branch has no direction worth a frame */
#define RAY_DISTANCE 3.0     /* px */
#define LEAST_START 10.0     /* px */
#define LEAST_BEFORE_END 8.0 /* px */
#define LEAST_APART 4.0      /* px */
#define LEAST_LOCATIONS 32   /* for a thread */
#define LEAST_SHARE 2        /* of the octave with most L-junctions: one in so many is enough; a soft picture has few fine ones */
#define OPPOSITE (-0.978147601) /* cosine of 180 - 12 degrees: half the least opening of branches, and less */
#define WITHIN 0.2095 /* rad: 12 degrees and a little more */

static asj_status check(asj_context *context, const asj_junction_list *input)
{
    const int which = (int)input->which;
    for (size_t n = 0; n < input->count; n++) {
        const asj_junction *j = &input->list[n];
        if (!(j->x >= -MOST_OUTSIDE && j->y >= -MOST_OUTSIDE && j->x <= (float)(input->width - 1) + MOST_OUTSIDE &&
              j->y <= (float)(input->height - 1) + MOST_OUTSIDE))
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu of image %d at (%g, %g) lies outside its %d x %d pixels",
                            n, which, (double)j->x, (double)j->y, (int)input->width, (int)input->height);
        if (j->branch_count < 0 || j->branch_count > ASJ_MAX_BRANCHES)
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu of image %d has %d branches", n, which,
                            (int)j->branch_count);
        if (j->octave < -1 || j->octave > ASJ_COARSEST)
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu of image %d is of octave %d", n, which, (int)j->octave);
        for (int32_t b = 0; b < j->branch_count; b++) {
            const asj_branch *branch = &j->branches[b];
            if (branch->end < 0 || branch->end > ASJ_BRANCH_END_BORDER)
                return asj_fail(context, ASJ_ERROR_ARGUMENT, "branch %d of junction %zu of image %d has an end of kind %d", (int)b,
                                n, which, (int)branch->end);
            if (!(branch->length >= 0 && branch->length <= 4 * (float)ASJ_MAX_SIDE && fabsf(branch->angle) <= 1e6f))
                return asj_fail(context, ASJ_ERROR_ARGUMENT, "branch %d of junction %zu of image %d has angle %g, length %g",
                                (int)b, n, which, (double)branch->angle, (double)branch->length);
        }
    }
    return ASJ_OK;
}

static asj_status no_memory(asj_context *context)
{
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the L-junctions of an image");
}

/* --- locations -------------------------------------------------------------------------------------------------------------- */

typedef struct position {
    float x, y;
    uint32_t l;
} position;

static int by_position(const void *left, const void *right)
{
    const position *p = left, *q = right;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p->l < q->l ? -1 : p->l > q->l;
}

static asj_status find_locations(asj_context *context, asj_l_junctions *all)
{
    asj_memory *memory = &context->memory;
    position *positions = asj_allocate(memory, all->count, sizeof *positions);
    all->location = asj_allocate(memory, all->count, sizeof *all->location);
    all->location_x = asj_allocate(memory, all->count, sizeof *all->location_x);
    all->location_y = asj_allocate(memory, all->count, sizeof *all->location_y);
    all->first_of_location = asj_allocate(memory, (size_t)all->count + 1, sizeof *all->first_of_location);
    all->l_of_location = asj_allocate(memory, all->count, sizeof *all->l_of_location);
    if (!positions || !all->location || !all->location_x || !all->location_y || !all->first_of_location || !all->l_of_location) {
        asj_release(memory, positions);
        return no_memory(context);
    }
    for (uint32_t i = 0; i < all->count; i++)
        positions[i] = (position){all->l[i].x, all->l[i].y, i};
    qsort(positions, all->count, sizeof *positions, by_position);
    uint32_t locations = 0;
    for (uint32_t i = 0; i < all->count; i++) {
        if (i == 0 || positions[i].x != positions[i - 1].x || positions[i].y != positions[i - 1].y) {
            all->location_x[locations] = (double)positions[i].x;
            all->location_y[locations] = (double)positions[i].y;
            all->first_of_location[locations++] = i;
        }
        all->location[positions[i].l] = locations - 1;
        all->l_of_location[i] = positions[i].l;
    }
    all->location_count = locations;
    all->first_of_location[locations] = all->count;
    for (uint32_t p = 0; p < locations; p++)
        all->home_locations += (uint32_t)!asj_is_guest_location(all, p);
    asj_release(memory, positions);
    return ASJ_OK;
}

uint32_t asj_first_location(const asj_l_junctions *all, double x)
{
    uint32_t low = 0, high = all->location_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (all->location_x[middle] < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

typedef struct job {
    const asj_match_options *options;
    const asj_location_grid *grid;
    asj_l_junctions *all;
    asj_watch *watch;
} job;

static void find_some(const void *data, const asj_part *part)
{
    const job *j = data;
    asj_l_junctions *all = j->all;
    for (int64_t p = part->first; p < part->end && !asj_watch_stops(j->watch, part); p++)
        all->neighbour_count[p] = asj_location_grid_nearest(j->grid, all->location_x[p], all->location_y[p],
                                                            j->options->separation, all->neighbour_limit,
                                                            all->neighbour + (size_t)p * all->neighbour_limit);
}

static asj_status find_neighbours(asj_context *context, const asj_match_options *options, const asj_location_grid *grid,
                                  asj_l_junctions *all)
{
    all->neighbour_limit = (uint32_t)options->neighbours;
    if (options->neighbours == 0)
        return ASJ_OK;
    all->neighbour = asj_allocate(&context->memory, (size_t)all->location_count * all->neighbour_limit, sizeof(uint32_t));
    all->neighbour_count = asj_allocate(&context->memory, all->location_count, sizeof(uint32_t));
    if (!all->neighbour || !all->neighbour_count)
        return no_memory(context);
    asj_watch watch;
    const job j = {options, grid, all, &watch};
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    asj_parallel(context, asj_threads_for(context, all->location_count, LEAST_LOCATIONS), all->location_count, 0, find_some, &j);
    return asj_watch_end(&watch);
}

/* --- lengths and frames ----------------------------------------------------------------------------------------------------- */

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

static void prepare_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++)
        prepare(j->all, j->grid, (uint32_t)i, j->options->length_hypotheses);
}

static asj_status make_frames(asj_context *context, const asj_match_options *options, const asj_location_grid *grid,
                              asj_l_junctions *all)
{
    asj_memory *memory = &context->memory;
    all->lengths = asj_allocate(memory, 2 * (size_t)all->count, sizeof *all->lengths);
    all->direction = asj_allocate(memory, 4 * (size_t)all->count, sizeof *all->direction);
    all->first_frame = asj_allocate(memory, (size_t)all->count + 1, sizeof *all->first_frame);
    if (!all->lengths || !all->direction || !all->first_frame)
        return no_memory(context);
    asj_watch watch;
    const job j = {options, grid, all, &watch};
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    asj_parallel(context, asj_threads_for(context, all->count, LEAST_LOCATIONS), all->count, 0, prepare_some, &j);
    if (watch.stopped)
        return asj_watch_end(&watch);
    uint32_t total = 0;
    for (uint32_t i = 0; i < all->count; i++) {
        all->first_frame[i] = total;
        total += (uint32_t)(all->lengths[2 * i].count * all->lengths[2 * i + 1].count);
    }
    all->first_frame[all->count] = all->frame_count = total;
    all->frames = asj_allocate(memory, total, sizeof *all->frames);
    if (!all->frames)
        return no_memory(context);
    fill_frames(all);
    return ASJ_OK;
}

/* What asks for locations around; those of guests are none. */
static asj_status find_around(asj_context *context, const asj_match_options *options, asj_l_junctions *all)
{
    asj_location_grid grid;
    asj_location_place *places = asj_allocate(&context->memory, all->home_locations, sizeof *places);
    uint32_t count = 0;
    for (uint32_t p = 0; p < all->location_count && places; p++)
        if (!asj_is_guest_location(all, p))
            places[count++] = (asj_location_place){all->location_x[p], all->location_y[p], p};
    const int made = places && asj_location_grid_make(&context->memory, places, count, &grid) == ASJ_OK;
    asj_release(&context->memory, places);
    if (!made)
        return no_memory(context);
    asj_status status = find_neighbours(context, options, &grid, all);
    if (status == ASJ_OK)
        status = make_frames(context, options, &grid, all);
    asj_location_grid_free(&context->memory, &grid);
    return status;
}

static asj_status set_octaves(asj_context *context, const asj_junction_list *input, asj_l_junctions *all)
{
    uint32_t counts[ASJ_COARSEST + 1] = {0}, most = 0;
    all->octave = asj_allocate(&context->memory, all->count, sizeof *all->octave);
    if (!all->octave)
        return no_memory(context);
    for (uint32_t i = 0; i < all->count; i++) {
        const int32_t octave = input->list[all->l[i].junction].octave;
        all->octave[i] = (uint8_t)(octave < 0 ? 0 : octave > ASJ_COARSEST ? ASJ_COARSEST : octave);
        counts[all->octave[i]]++;
    }
    for (int32_t octave = 0; octave <= ASJ_COARSEST; octave++)
        most = counts[octave] > most ? counts[octave] : most;
    while (LEAST_SHARE * counts[all->home] < most)
        all->home++;
    return ASJ_OK;
}

/* What junctions say of themselves: how meaningful they are. */
static asj_status set_meaning(asj_context *context, const asj_junction_list *input, asj_l_junctions *all)
{
    all->log10_nfa = asj_allocate(&context->memory, all->count, sizeof *all->log10_nfa);
    if (!all->log10_nfa)
        return no_memory(context);
    for (uint32_t i = 0; i < all->count; i++) {
        const float log10_nfa = input->list[all->l[i].junction].log10_nfa;
        all->log10_nfa[i] = isnan(log10_nfa) ? INFINITY : log10_nfa;
    }
    return ASJ_OK;
}

/* What junctions say of branches: what is at their ends, and how well their directions are known. */
static asj_status set_branches(asj_context *context, const asj_junction_list *input, asj_l_junctions *all)
{
    all->direction_sd = asj_allocate(&context->memory, 2 * (size_t)all->count, sizeof *all->direction_sd);
    if (!all->direction_sd)
        return no_memory(context);
    for (uint32_t i = 0; i < all->count; i++) {
        const asj_branch *branches = input->list[all->l[i].junction].branches;
        const asj_branch *both[2] = {&branches[all->l[i].branch_a], &branches[all->l[i].branch_b]};
        for (uint32_t b = 0; b < 2; b++) {
            all->lengths[2 * i + b].end = both[b]->end;
            all->direction_sd[2 * i + b] = both[b]->angle_sd;
        }
    }
    return ASJ_OK;
}

/* A branch of the L-junctions of one location. */
typedef struct spoke {
    double angle; /* rad in [-pi, pi] */
    uint32_t l;
    int32_t branch;
} spoke;

static int by_angle(const void *left, const void *right)
{
    const spoke *p = left, *q = right;
    if (p->angle != q->angle)
        return p->angle < q->angle ? -1 : 1;
    return p->l != q->l ? p->l < q->l ? -1 : 1 : p->branch - q->branch;
}

/* Rising by angle. Thousands of L-junctions may share a location. */
static uint32_t sort_spokes(const asj_l_junctions *all, uint32_t location, spoke *spokes)
{
    uint32_t count = 0;
    for (uint32_t m = all->first_of_location[location]; m < all->first_of_location[location + 1]; m++)
        for (int32_t branch = 0; branch < 2; branch++) {
            const double *v = all->direction + 4 * (size_t)all->l_of_location[m] + 2 * branch;
            spokes[count++] = (spoke){atan2(v[1], v[0]), all->l_of_location[m], branch};
        }
    qsort(spokes, count, sizeof *spokes, by_angle);
    return count;
}

/* Does another L-junction of the location have a branch opposite to u? Looked for from OPPOSITE on, which decides by itself. */
static int continues(const asj_l_junctions *all, const spoke *spokes, uint32_t count, uint32_t l, const double u[2])
{
    const double opposite = atan2(-u[1], -u[0]), least = opposite - WITHIN, from = least < -ASJ_PI ? least + ASJ_TWO_PI : least;
    uint32_t low = 0, high = count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (spokes[middle].angle < from)
            low = middle + 1;
        else
            high = middle;
    }
    for (uint32_t k = 0; k < count; k++) {
        const spoke *s = &spokes[(low + k) % count];
        const double *v = all->direction + 4 * (size_t)s->l + 2 * s->branch;
        const double apart = fabs(s->angle - opposite);
        if (apart > WITHIN && apart < ASJ_TWO_PI - WITHIN)
            return 0;
        if (s->l != l && u[0] * v[0] + u[1] * v[1] < OPPOSITE)
            return 1;
    }
    return 0;
}

static asj_status find_t_junctions(asj_context *context, asj_l_junctions *all)
{
    uint32_t most = 0;
    for (uint32_t p = 0; p < all->location_count; p++) {
        const uint32_t here = all->first_of_location[p + 1] - all->first_of_location[p];
        most = here > most ? here : most;
    }
    spoke *spokes = asj_allocate(&context->memory, 2 * (size_t)most, sizeof *spokes);
    all->t_junction = asj_allocate(&context->memory, all->count, sizeof *all->t_junction);
    if (!all->t_junction || !spokes) {
        asj_release(&context->memory, spokes);
        return no_memory(context);
    }
    for (uint32_t p = 0; p < all->location_count; p++) {
        const uint32_t count = sort_spokes(all, p, spokes);
        for (uint32_t m = all->first_of_location[p]; m < all->first_of_location[p + 1]; m++) {
            const uint32_t l = all->l_of_location[m];
            const double *u = all->direction + 4 * (size_t)l;
            all->t_junction[l] = continues(all, spokes, count, l, u) != continues(all, spokes, count, l, u + 2);
        }
    }
    asj_release(&context->memory, spokes);
    return ASJ_OK;
}

uint32_t asj_l_junctions_of_image(const asj_junction *junctions, asj_l_junction *l, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++)
        if (junctions[l[i].junction].octave >= 0)
            l[kept++] = l[i];
    return kept;
}

/* To pixels of the image enlarged twice (core/enlarge.c). */
static void enlarge(asj_l_junctions *all)
{
    for (uint32_t i = 0; i < all->count; i++) {
        asj_l_junction *l = &all->l[i];
        float *const values[] = {&l->x, &l->y, &l->ax, &l->ay, &l->bx, &l->by};
        for (size_t k = 0; k < sizeof values / sizeof *values; k++)
            *values[k] = 2 * *values[k] + 0.5f;
    }
}

asj_status asj_l_junctions_create(asj_context *context, const asj_match_options *options, const asj_junction_list *input,
                                  asj_l_junctions *all)
{
    memset(all, 0, sizeof *all);
    asj_status status = check(context, input);
    if (status != ASJ_OK)
        return status;
    const size_t total = asj_decompose(input->list, input->count, options->minimum_opening, NULL, 0);
    if (total > MOST_L_JUNCTIONS)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%zu L-junctions in image %d are more than the matcher takes", total,
                        (int)input->which);
    all->l = asj_allocate(&context->memory, total, sizeof *all->l);
    if (!all->l)
        return no_memory(context);
    all->count = (uint32_t)asj_decompose(input->list, input->count, options->minimum_opening, all->l, total);
    all->enlarged = input->enlarged;
    if (all->enlarged)
        enlarge(all);
    else
        all->count = asj_l_junctions_of_image(input->list, all->l, all->count);
    status = set_octaves(context, input, all);
    if (status == ASJ_OK)
        status = find_locations(context, all);
    if (status == ASJ_OK)
        status = find_around(context, options, all);
    if (status == ASJ_OK)
        status = set_meaning(context, input, all);
    if (status == ASJ_OK)
        status = set_branches(context, input, all);
    if (status == ASJ_OK)
        status = find_t_junctions(context, all);
    return status;
}

void asj_l_junctions_free(asj_memory *memory, asj_l_junctions *all)
{
    void *blocks[] = {all->l, all->lengths, all->direction, all->direction_sd, all->first_frame, all->frames, all->location,
                      all->location_x, all->location_y, all->neighbour, all->neighbour_count,
                      all->first_of_location, all->l_of_location, all->octave, all->log10_nfa,
                      all->t_junction};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        asj_release(memory, blocks[i]);
    memset(all, 0, sizeof *all);
}
