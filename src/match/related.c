/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, before the short list: do the two images show anything in common?
 *
 * In a collection most pairs have nothing in common, and the steps would find out only at the end. So first the same steps run on a
 * part: each L-junction by the frame of its own lengths alone, its one best partner, and of these candidates the SUREST that look
 * most alike. Where images share a surface some of these are right, and right ones that are neighbours agree; what chance brings
 * agrees with little. The images have something in common when two candidates have support (consensus.c) of related_support.
 *
 * The second largest support of pairs that end with matches is 0.53 and more in 38 wide pairs of rendered rooms, and 0.27 and more
 * in 11 pairs of photographs; it is below 0.14 in 27 of 32 pairs of unrelated photographs, which take a twelfth of the time of
 * pairs that match. Upsampled images whose own matches say where partners lie (expected.c) are not asked. A geometry finds matches
 * in pairs seen from so far apart that nothing agrees (frames of videos have .11 and .13, a magazine .05): with one two_view.c has
 * a first look for it where this is small. */
#include "related.h"
#include "align.h"
#include "consensus.h"
#include "shortlist.h"
#include "subset.h"
#include "support.h"
#include "core/nth_smallest.h"

#include <math.h>
#include <string.h>

#define SUREST 800 /* candidates of which support is asked; with 400 photographs of one place reach half of what they do so */
#define FEW 100    /* L-junctions: fewer take no time, and too little can agree */

/* Keeps the candidates that are as near as the SUREST-th; equals stay together, so that swapping the images changes nothing. */
static asj_status keep_surest(asj_match_run *run)
{
    asj_candidates *all = &run->candidates;
    if (all->count <= SUREST)
        return ASJ_OK;
    float *distances = asj_allocate(&run->context->memory, all->count, sizeof *distances);
    if (!distances)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", all->count);
    for (size_t k = 0; k < all->count; k++)
        distances[k] = all->list[k].distance2;
    const float most = asj_nth_smallest(distances, all->count, SUREST);
    size_t kept = 0;
    for (size_t k = 0; k < all->count; k++)
        if (all->list[k].distance2 <= most)
            all->list[kept++] = all->list[k];
    all->count = kept;
    asj_release(&run->context->memory, distances);
    return ASJ_OK;
}

static asj_status look(asj_match_run *run, double *support)
{
    asj_status status = asj_shortlist(run);
    if (status == ASJ_OK)
        status = keep_surest(run);
    if (status == ASJ_OK && run->options->align_iterations > 0)
        status = asj_align_candidates(run, &run->candidates);
    if (status == ASJ_OK)
        status = asj_support_find(run);
    if (status == ASJ_OK)
        status = asj_consensus(run);
    if (status != ASJ_OK)
        return status;
    double largest = 0;
    *support = 0;
    for (size_t k = 0; k < run->candidates.count; k++) {
        const double one = (double)run->candidates.list[k].support;
        *support = fmax(*support, fmin(largest, one));
        largest = fmax(largest, one);
    }
    return ASJ_OK;
}

/* Those that are no guests (guests.c): the others are not asked about. */
static uint32_t count_home(const asj_l_junctions *l_junctions)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < l_junctions->count; n++)
        count += !asj_is_guest(l_junctions, n);
    return count;
}

/* Is it worth asking? */
static int32_t asked(const asj_match_run *run)
{
    const asj_match_options *options = run->options;
    return !run->expected && options->related_support > 0 && options->patches == ASJ_PATCHES_CANONICAL && options->neighbours > 0 &&
           options->minimum_support > 0 &&
           count_home(&run->image[0]->l_junctions) >= FEW && count_home(&run->image[1]->l_junctions) >= FEW;
}

asj_status asj_related(const asj_match_run *run, double *support)
{
    asj_memory *memory = &run->context->memory;
    asj_subset parts[2];
    asj_match_options options = *run->options;
    asj_match_run some = {.context = run->context, .options = &options, .image = {&parts[0].features, &parts[1].features},
                          .alignments = run->alignments};
    *support = HUGE_VAL;
    if (!asked(run))
        return ASJ_OK;
    options.shortlist = 1;
    memset(parts, 0, sizeof parts);
    asj_status status = asj_subset_create(run, 0, 1, 0, &parts[0]);
    if (status == ASJ_OK)
        status = asj_subset_create(run, 1, 1, 0, &parts[1]);
    if (status == ASJ_OK)
        status = look(&some, support);
    asj_release_much(memory, some.candidates.list);
    asj_support_free(memory, &some.support);
    asj_subset_free(memory, &parts[0]);
    asj_subset_free(memory, &parts[1]);
    return status;
}
