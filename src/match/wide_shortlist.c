/* SPDX-License-Identifier: BSD-2-Clause */
/* Who may be whose partner where a geometry decides (two_view.c).
 *
 * Seen from far apart, in another light, corners of doors, shelves and tiles are alike in grey levels: of the places that both
 * images show and find, half are on no list of the best sixteen where the geometry fails. Colours tell many of them apart. Where
 * both images have some, lists LONGER times as long are made by grey levels, which is what is fast to do, and the best of
 * them by both (colour_patch.c, compare.c) are the candidates, whose distance is that of both from then on. */
#include "wide_shortlist.h"
#include "describe.h"
#include "shortlist.h"

#include <math.h>

#define LONGER 2

static int32_t has_colours(const asj_image_features *image)
{
    return image->colours && image->picture.level;
}

/* Colours take the place of patches that are correlated in grey levels; others have been asked for where they are not. */
static int32_t may_use_colours(const asj_match_run *run)
{
    const asj_match_options *o = run->options;
    return o->patches == ASJ_PATCHES_CANONICAL && o->descriptor == ASJ_DESCRIPTOR_RAW && o->normalise &&
           has_colours(run->image[0]) && has_colours(run->image[1]);
}

static asj_status make_patches(asj_match_run *run)
{
    asj_status status = ASJ_OK;
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++) {
        const asj_image_features *image = run->image[side];
        const double scale = image->l_junctions.upsampled ? 4 : 2;
        status = asj_colour_patches_create(run->context, run->options, &image->picture, scale, image->l_junctions.frames,
                                           image->l_junctions.frame_count, &run->colours[side]);
    }
    return status;
}

/* The smallest distances of an L-junction's candidates, rising; `limit` numbers. */
static void offer(float *list, int32_t limit, float distance2)
{
    int32_t k = limit - 1;
    if (distance2 >= list[k])
        return;
    for (; k > 0 && list[k - 1] > distance2; k--)
        list[k] = list[k - 1];
    list[k] = distance2;
}

/* Leaves those that are among the `limit` nearest of either L-junction, and their equals. */
static asj_status keep_best(asj_match_run *run, int32_t limit)
{
    asj_memory *memory = &run->context->memory;
    asj_candidate *list = run->candidates.list;
    float *nearest[2];
    size_t kept = 0;
    for (int32_t side = 0; side < 2; side++)
        nearest[side] = asj_allocate(memory, run->image[side]->l_junctions.count, (size_t)limit * sizeof **nearest);
    const int32_t there = nearest[0] && nearest[1];
    for (int32_t side = 0; side < 2 && there; side++) {
        for (size_t n = 0; n < run->image[side]->l_junctions.count * (size_t)limit; n++)
            nearest[side][n] = HUGE_VALF;
        for (size_t k = 0; k < run->candidates.count; k++)
            offer(nearest[side] + asj_candidate_l(&list[k], side) * (size_t)limit, limit, list[k].distance2);
    }
    for (size_t k = 0; k < run->candidates.count && there; k++)
        if (list[k].distance2 <= nearest[0][(list[k].i + (size_t)1) * (size_t)limit - 1] ||
            list[k].distance2 <= nearest[1][(list[k].j + (size_t)1) * (size_t)limit - 1])
            list[kept++] = list[k];
    run->candidates.count = kept;
    asj_release(memory, nearest[0]);
    asj_release(memory, nearest[1]);
    return there ? ASJ_OK : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the best of %zu candidates", kept);
}

asj_status asj_wide_shortlist(asj_match_run *run)
{
    const asj_match_options *options = run->options;
    asj_match_options longer = *options;
    if (!may_use_colours(run))
        return asj_shortlist(run);
    asj_status status = make_patches(run);
    longer.shortlist *= LONGER;
    run->options = &longer;
    if (status == ASJ_OK)
        status = asj_shortlist(run);
    run->options = options;
    return status == ASJ_OK ? keep_best(run, options->shortlist) : status;
}

void asj_wide_shortlist_free(asj_match_run *run)
{
    for (int32_t side = 0; side < 2; side++)
        asj_colour_patches_free(&run->context->memory, &run->colours[side]);
}
