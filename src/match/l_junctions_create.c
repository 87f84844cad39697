/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, preparation: from junctions to L-junctions with locations and neighbours (locations.c), length hypotheses and frames
 * (frames.c). Guests (guests.c) are nobody's neighbours and lengthen no branch, so that others are as they are without them. */
#include "l_junctions_create.h"
#include "core/number_text.h"
#include "frames.h"
#include "locations.h"
#include "t_junctions.h"

#include <string.h>

#define MOST_L_JUNCTIONS 0x1000000 /* frames, up to sixteen for each, are numbered in 32 bits */
#define MOST_OUTSIDE ((float)ASJ_MAX_OUTSIDE) /* px: where branches meet may lie a little outside the image */
#define LEAST_SHARE 2        /* of the octave with most L-junctions: one in so many is enough; a soft picture has few fine ones */

static asj_status check(asj_context *context, const asj_image_junctions *input)
{
    const int which = (int)input->which;
    char fault[128];
    for (size_t n = 0; n < input->count; n++) {
        const asj_junction *j = &input->list[n];
        if (asj_junction_check(j, fault, sizeof fault) != ASJ_OK)
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu of image %d has %s", n, which, fault);
        if (!(j->x >= -MOST_OUTSIDE && j->y >= -MOST_OUTSIDE && j->x <= (float)(input->width - 1) + MOST_OUTSIDE &&
              j->y <= (float)(input->height - 1) + MOST_OUTSIDE))
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu of image %d at (%s, %s) lies outside its %d x %d pixels",
                            n, which, ASJ_TEXT((double)j->x), ASJ_TEXT((double)j->y), (int)input->width, (int)input->height);
    }
    return ASJ_OK;
}

static asj_status no_memory(asj_context *context)
{
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the L-junctions of an image");
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
    asj_status status = asj_neighbours_find(context, options, &grid, all);
    if (status == ASJ_OK)
        status = asj_frames_make(context, options, &grid, all);
    asj_location_grid_free(&context->memory, &grid);
    return status;
}

static asj_status set_octaves(asj_context *context, const asj_image_junctions *input, asj_l_junctions *all)
{
    uint32_t counts[ASJ_LARGEST_OCTAVE + 1] = {0}, most = 0;
    all->octave = asj_allocate(&context->memory, all->count, sizeof *all->octave);
    if (!all->octave)
        return no_memory(context);
    for (uint32_t i = 0; i < all->count; i++) {
        const int32_t octave = input->list[all->l[i].junction].octave;
        all->octave[i] = (uint8_t)(octave < 0 ? 0 : octave > ASJ_LARGEST_OCTAVE ? ASJ_LARGEST_OCTAVE : octave);
        counts[all->octave[i]]++;
    }
    for (int32_t octave = 0; octave <= ASJ_LARGEST_OCTAVE; octave++)
        most = counts[octave] > most ? counts[octave] : most;
    while (LEAST_SHARE * counts[all->home] < most)
        all->home++;
    return ASJ_OK;
}

/* What junctions say of themselves: how meaningful they are. */
static asj_status set_meaning(asj_context *context, const asj_image_junctions *input, asj_l_junctions *all)
{
    all->log10_nfa = asj_allocate(&context->memory, all->count, sizeof *all->log10_nfa);
    if (!all->log10_nfa)
        return no_memory(context);
    for (uint32_t i = 0; i < all->count; i++)
        all->log10_nfa[i] = input->list[all->l[i].junction].log10_nfa;
    return ASJ_OK;
}

/* What junctions say of branches: what is at their ends, and how well their directions are known. */
static asj_status set_branches(asj_context *context, const asj_image_junctions *input, asj_l_junctions *all)
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

/* To pixels of the image upsampled by two (core/upsample.c). */
static void upsample(asj_l_junctions *all)
{
    for (uint32_t i = 0; i < all->count; i++) {
        asj_l_junction *l = &all->l[i];
        float *const values[] = {&l->x, &l->y, &l->ax, &l->ay, &l->bx, &l->by};
        for (size_t k = 0; k < sizeof values / sizeof *values; k++)
            *values[k] = 2 * *values[k] + 0.5f;
    }
}

asj_status asj_l_junctions_create(asj_context *context, const asj_match_options *options, const asj_image_junctions *input,
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
    all->upsampled = input->upsampled;
    if (all->upsampled)
        upsample(all);
    else
        all->count = asj_l_junctions_of_image(input->list, all->l, all->count);
    status = set_octaves(context, input, all);
    if (status == ASJ_OK)
        status = asj_locations_find(context, all);
    if (status == ASJ_OK)
        status = find_around(context, options, all);
    if (status == ASJ_OK)
        status = set_meaning(context, input, all);
    if (status == ASJ_OK)
        status = set_branches(context, input, all);
    if (status == ASJ_OK)
        status = asj_t_junctions_find(context, all);
    return status;
}
