/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, preparation: where L-junctions stand, and what stands around.
 *
 * Matches are unique by location, and "another location" in the ratio test means farther than `separation`. Neighbours of a
 * location are the nearest others farther than `separation`, so that a cluster of duplicates is no neighbour of itself. */
#include "locations.h"
#include "core/sort.h"
#include "core/watch.h"

#define LEAST_LOCATIONS 32 /* for a thread */

static asj_status no_memory(asj_context *context)
{
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the locations of an image");
}

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

asj_status asj_locations_find(asj_context *context, asj_l_junctions *all)
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
    asj_sort(positions, all->count, sizeof *positions, by_position);
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

/* All that the locations share. */
typedef struct job {
    asj_l_junctions *all;
    const asj_location_grid *grid;
    double separation; /* px */
    asj_watch *watch;
} job;

static void find_some(const void *data, const asj_part *part)
{
    const job *j = data;
    asj_l_junctions *all = j->all;
    for (int64_t p = part->first; p < part->end && !asj_watch_stops(j->watch, part); p++)
        all->neighbour_count[p] = asj_location_grid_nearest(j->grid, all->location_x[p], all->location_y[p],
                                                            j->separation, all->neighbour_limit,
                                                            all->neighbour + (size_t)p * all->neighbour_limit);
}

asj_status asj_neighbours_find(asj_context *context, const asj_match_options *options, const asj_location_grid *grid,
                               asj_l_junctions *all)
{
    all->neighbour_limit = (uint32_t)options->neighbours;
    if (options->neighbours == 0)
        return ASJ_OK;
    all->neighbour = asj_allocate(&context->memory, all->location_count, all->neighbour_limit * sizeof(uint32_t));
    all->neighbour_count = asj_allocate(&context->memory, all->location_count, sizeof(uint32_t));
    if (!all->neighbour || !all->neighbour_count)
        return no_memory(context);
    asj_watch watch;
    const job j = {all, grid, options->separation, &watch};
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    asj_parallel(context, asj_threads_for(context, all->location_count, LEAST_LOCATIONS), all->location_count, 0, find_some, &j);
    return asj_watch_end(&watch);
}
